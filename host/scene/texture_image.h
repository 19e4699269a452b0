/* Converts image files to TextureImages of a scene: texels, and tables that decode bytes. */
#ifndef TWINLIGHT_SCENE_TEXTURE_IMAGE_H
#define TWINLIGHT_SCENE_TEXTURE_IMAGE_H

#include "image/read.h"
#include "scene/scene.h"

/* Maximum number of images of a scene: each is compared with all earlier ones. */
#define SCENE_IMAGES_MAX 65536

/* Encoding of 8- or 16-bit values in a file. Float files (EXR, HDR, PFM) are linear. */
typedef enum TextureEncoding { ENCODING_SRGB, ENCODING_LINEAR, ENCODING_GAMMA } TextureEncoding;

typedef struct TextureImageOptions {
    TextureEncoding encoding;
    float gamma; /* for ENCODING_GAMMA: linear = encoded^gamma */
    uint wrap; /* WRAP_* */
    uint filter; /* FILTER_* */
} TextureImageOptions;

/* Images loaded so far, so that a file with the same encoding is stored once. One per scene being read. */
typedef struct TextureCache {
    Array entries;
    bool (*read)(void *owner, const char *path, Image *image, Error *error); /* NULL: image_read */
    void *owner; /* for `read` */
} TextureCache;

void texture_cache_init(TextureCache *cache);
void texture_cache_destroy(TextureCache *cache);

/* Loads `path` into scene->texels and scene->images and returns its index in *index. The same path with the same
 * options gives the same index; with another wrap or filter, a TextureImage that shares the texels; with another
 * encoding, one that shares the bytes but has its own table. An alpha channel that is 1 everywhere is dropped, as in
 * pbrt. Values that are not finite become 0, with a warning. Fails like image_read, and if the texels of all images
 * exceed 32-bit indices. */
bool texture_image_load(Scene *scene, TextureCache *cache, const char *path, const TextureImageOptions *options,
                        uint *index, Error *error);

/* The same for an image in memory, which is not changed; never shared. */
bool texture_image_add(Scene *scene, const Image *image, const TextureImageOptions *options, uint *index, Error *error);

/* Parses "sRGB", "linear" or "gamma N" with a finite N > 0, as in pbrt, to options->encoding and gamma. False for
 * anything else. */
bool texture_encoding_parse(const char *text, TextureImageOptions *options);

/* Checks a texture program of `count` ops that ends with TEXTURE_END. Returns its largest stack depth, or 0 if an op
 * lacks operands, a code or mapping is unknown, or not exactly one value is left. The kernels can run the program if
 * the result is 1 ... TEXTURE_STACK. */
unsigned texture_program_depth(const TextureOp *ops, size_t count);

#endif
