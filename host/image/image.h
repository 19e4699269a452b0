/* A picture in memory, and what decoders of files make it with. */
#ifndef TWINLIGHT_IMAGE_IMAGE_H
#define TWINLIGHT_IMAGE_IMAGE_H

#include "base/error.h"

#include <stddef.h>
#include <stdio.h>

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

void image_destroy(Image *image);

/* Element i of the data (pixel * channels + channel) as stored: byte / 255, or the float. */
float image_value(const Image *image, size_t i);

/* All pixels as linear RGB floats, 3 a pixel, in a new array that the caller frees: grey is repeated, alpha left out,
 * sRGB decoded. */
bool image_linear_rgb(const Image *image, float **rgb, Error *error);

/* ---- for decoders ------------------------------------------------------------------------------------------------- */

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
