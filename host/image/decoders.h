/* The decoders behind image_read. Each gets the file open at its start. */
#ifndef TWINLIGHT_IMAGE_DECODERS_H
#define TWINLIGHT_IMAGE_DECODERS_H

#include "image/image.h"

#include <stdio.h>

typedef enum StbKind { STB_PNG, STB_JPEG, STB_TGA, STB_HDR } StbKind;

bool image_read_exr(FILE *file, const char *path, Image *image, Error *error);
/* The channels LAYER.R, .G and .B; without them *found is false, `image` empty, and that is no failure. */
bool image_read_exr_layer(FILE *file, const char *path, const char *layer, Image *image, bool *found, Error *error);
/* Fills the allocated float image from a DWA-compressed file whose size and channels (R G B [A], or Y) are known. */
bool image_read_exr_dwa(const char *path, Image *image, Error *error);
bool image_read_pfm(FILE *file, const char *path, Image *image, Error *error);
bool image_read_stb(FILE *file, const char *path, StbKind kind, bool sixteen_bits, Image *image, Error *error);

#endif
