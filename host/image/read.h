/* Reads image files: PNG (8 and 16 bit), JPEG, TGA and Radiance HDR by stb_image, OpenEXR by OpenEXRCore, PFM by own
 * code. */
#ifndef TWINLIGHT_IMAGE_READ_H
#define TWINLIGHT_IMAGE_READ_H

#include "image/image.h"

/* Reads `path`. The format is recognised by content, TGA (which has no signature) also by its file name. Of an EXR, the
 * first part's data window and the channels R G B [A] or Y (or the only channel) are read. As in pbrt, the alpha of TGA
 * and of grey images is dropped. Fails, naming the path, if the file cannot be opened, is damaged, truncated, too large
 * or of another format. */
bool image_read(const char *path, Image *image, Error *error);

/* The same from memory, for PNG and JPEG. `name` is for messages. */
bool image_read_memory(const void *bytes, size_t size, const char *name, Image *image, Error *error);

/* Reads the channels LAYER.R, LAYER.G and LAYER.B of an EXR, named as `twinlight render` writes layers
 * (render/layers.h). Without them, or for another format, *found is false, `image` is empty and the result is true. */
bool image_read_layer(const char *path, const char *layer, Image *image, bool *found, Error *error);

/* image_read, then image_linear_rgb: *width x *height x 3 floats of linear RGB in a new array that the caller frees. On
 * failure *rgb is NULL. */
bool image_read_rgb(const char *path, float **rgb, int *width, int *height, Error *error);

#endif
