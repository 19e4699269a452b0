/* Pictures read from files: PNG (8 and 16 bit), JPEG, TGA and Radiance HDR by stb_image, OpenEXR by OpenEXRCore, PFM by
 * hand. */
#ifndef TWINLIGHT_IMAGE_READ_H
#define TWINLIGHT_IMAGE_READ_H

#include "image/image.h"

/* Reads `path`; the kind of file is told by its content, TGA (which has no signature) by its ending. Of an EXR the
 * first part's data window and the channels R G B [A] or Y (or the only channel) are read. As in pbrt, the alpha of TGA
 * and of grey pictures is dropped. Fails, naming the path, for what cannot be opened, is damaged, truncated, too large
 * or of another kind. */
bool image_read(const char *path, Image *image, Error *error);

/* Reads the channels LAYER.R, LAYER.G and LAYER.B of an EXR, layers as `twinlight render` writes them
 * (render/layers.h). *found: whether it has them; false, with an empty image, for every other kind of file. */
bool image_read_layer(const char *path, const char *layer, Image *image, bool *found, Error *error);

/* image_read and image_linear_rgb: the file's pixels as linear RGB, *width x *height x 3, in a new array that the
 * caller frees. On failure *rgb is NULL. */
bool image_read_rgb(const char *path, float **rgb, int *width, int *height, Error *error);

#endif
