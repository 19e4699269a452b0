/* The decoders behind image_read. Each gets the file open at its start. */
#ifndef TWINLIGHT_IMAGE_FORMATS_H
#define TWINLIGHT_IMAGE_FORMATS_H

#include "image.h"

#include <stdio.h>

typedef enum StbKind { STB_PNG, STB_JPEG, STB_TGA, STB_HDR } StbKind;

bool image_read_exr(FILE *file, const char *path, Image *image, Error *error);
/* The channels LAYER.R, .G and .B; without them *found is false, `image` empty, and that is no failure. */
bool image_read_exr_layer(FILE *file, const char *path, const char *layer, Image *image, bool *found, Error *error);
/* Fills the allocated float image from a DWA-compressed file whose size and channels (R G B [A], or Y) are known. */
bool image_read_exr_dwa(const char *path, Image *image, Error *error);
bool image_read_pfm(FILE *file, const char *path, Image *image, Error *error);
bool image_read_stb(FILE *file, const char *path, StbKind kind, bool sixteen_bits, Image *image, Error *error);

/* "cannot read PATH: WHY" */
bool image_error(Error *error, const char *path, const char *why);

/* A picture's size as its file says it. `density`: pixels that a byte of such a file can hold at most, so that a short
 * one that announces much is refused before memory is taken. */
typedef struct ImageSize {
    long long width, height, density;
} ImageSize;

/* Fails when a picture of this size is empty, beyond IMAGE_PIXELS_MAX or more than the file can hold. */
bool image_size_check(FILE *file, const char *path, ImageSize size, Error *error);

/* Sets the members and allocates zeroed float data after image_size_check. */
bool image_allocate_float(FILE *file, const char *path, ImageSize size, int channels, Image *image, Error *error);

#endif
