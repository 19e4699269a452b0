/* Image files become TextureImages of a scene: texels, and tables that decode a byte. */
#ifndef TWINLIGHT_SCENE_TEXTURE_IMAGE_H
#define TWINLIGHT_SCENE_TEXTURE_IMAGE_H

#include "image/read.h"
#include "scene/scene.h"

/* How the numbers of an 8- or 16-bit file become linear. Float files (EXR, HDR, PFM) are linear. */
/* Of a scene: each is compared with all that came before it. */
#define SCENE_IMAGES_MAX 65536

typedef enum TextureEncoding { ENCODING_SRGB, ENCODING_LINEAR, ENCODING_GAMMA } TextureEncoding;

typedef struct TextureImageOptions {
    TextureEncoding encoding;
    float gamma; /* of ENCODING_GAMMA: linear = encoded^gamma */
    uint wrap; /* WRAP_* */
    uint filter; /* FILTER_* */
} TextureImageOptions;

/* What has been loaded already, so that the same file with the same encoding is kept once; one per scene being read. */
typedef struct TextureCache {
    Array entries;
} TextureCache;

void texture_cache_init(TextureCache *cache);
void texture_cache_destroy(TextureCache *cache);

/* Loads `path` into scene->texels and scene->images and returns its index in *index. The same path with the same
 * options gives the same index; with another wrap or filter, a TextureImage that shares the texels; with another
 * encoding, one that shares the bytes and differs in its table. An alpha channel that is 1 everywhere is dropped, as in
 * pbrt. Values that are not finite become 0, with a warning. Fails as image_read does, and when the texels of all
 * images exceed what 32 bits can number. */
bool texture_image_load(Scene *scene, TextureCache *cache, const char *path, const TextureImageOptions *options,
                        uint *index, Error *error);

/* The same for pixels in memory (`image` is left as it is); never shared. */
bool texture_image_add(Scene *scene, const Image *image, const TextureImageOptions *options, uint *index, Error *error);

/* "sRGB", "linear" or "gamma N" with a finite N > 0, as in pbrt, to options->encoding and gamma. False for others. */
bool texture_encoding_parse(const char *text, TextureImageOptions *options);

/* Checks a texture program of `count` ops that ends with TEXTURE_END: returns the deepest that its stack becomes, or 0
 * when an op lacks operands, a code or mapping is unknown, or other than one value is left. The kernels can run a
 * program when the result is 1 ... TEXTURE_STACK. */
unsigned texture_program_depth(const TextureOp *ops, size_t count);

#endif
