/* Pictures read from files: PNG (8 and 16 bit), JPEG, TGA and Radiance HDR by stb_image, OpenEXR by OpenEXRCore, PFM by
 * hand. */
#ifndef TWINLIGHT_IMAGE_H
#define TWINLIGHT_IMAGE_H

#include "error.h"

#include <stddef.h>

/* No file with more pixels than this, or a side longer than this, is read. Fuzzers are built with fewer, to be fast. */
#ifndef IMAGE_PIXELS_MAX
#define IMAGE_PIXELS_MAX (1u << 28)
#endif
#define IMAGE_SIDE_MAX 65536

/* width x height pixels of 1 (grey), 3 (RGB) or 4 (RGBA) interleaved channels, row by row, row 0 on top. */
typedef struct Image {
    int width, height, channels;
    bool is_float; /* data: float, else unsigned char (0 ... 255) */
    bool srgb_encoded; /* PNG, JPEG and TGA; a 16-bit PNG is float in 0 ... 1 and still encoded */
    void *data;
} Image;

/* Reads `path`; the kind of file is told by its content, TGA (which has no signature) by its ending. Of an EXR the
 * first part's data window and the channels R G B [A] or Y (or the only channel) are read. As in pbrt, the alpha of
 * TGA and of grey pictures is dropped. Fails, naming the path, for what cannot be opened, is damaged, truncated, too large
 * or of another kind. */
bool image_read(const char *path, Image *image, Error *error);
void image_destroy(Image *image);

/* Reads the channels LAYER.R, LAYER.G and LAYER.B of an EXR, layers as `twinlight render` writes them (render_layers.h).
 * *found: whether it has them; false, with an empty image, for every other kind of file. */
bool image_read_layer(const char *path, const char *layer, Image *image, bool *found, Error *error);

/* Element i of the data (pixel * channels + channel) as stored: byte / 255, or the float. */
float image_value(const Image *image, size_t i);

/* All pixels as linear RGB floats, 3 a pixel, in a new array that the caller frees: grey is repeated, alpha left out,
 * sRGB decoded. */
bool image_linear_rgb(const Image *image, float **rgb, Error *error);

/* Both at once: the file's pixels as linear RGB, *width x *height x 3, in a new array that the caller frees. On failure
 * *rgb is NULL. */
bool image_read_rgb(const char *path, float **rgb, int *width, int *height, Error *error);

#endif
