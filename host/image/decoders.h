/* The decoders used by image_read. Each gets the file opened and positioned at its start. */
#ifndef TWINLIGHT_IMAGE_DECODERS_H
#define TWINLIGHT_IMAGE_DECODERS_H

#include "image/image.h"

#include <stdio.h>

typedef enum StbKind { STB_PNG, STB_JPEG, STB_TGA, STB_HDR } StbKind;

bool image_read_exr(FILE *file, const char *path, Image *image, Error *error);
/* Reads the channels LAYER.R, LAYER.G and LAYER.B. If they are missing, *found is false, `image` stays empty and the
 * result is true. */
bool image_read_exr_layer(FILE *file, const char *path, const char *layer, Image *image, bool *found, Error *error);
/* Fills the allocated float image from a DWA-compressed file of known size and channels (R G B [A], or Y). */
bool image_read_exr_dwa(const char *path, Image *image, Error *error);
bool image_read_pfm(FILE *file, const char *path, Image *image, Error *error);
bool image_read_stb(FILE *file, const char *path, StbKind kind, bool sixteen_bits, Image *image, Error *error);

#endif
