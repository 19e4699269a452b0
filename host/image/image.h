/* An image in memory, and helpers for decoders. */
#ifndef TWINLIGHT_IMAGE_IMAGE_H
#define TWINLIGHT_IMAGE_IMAGE_H

#include "base/error.h"

#include <stddef.h>
#include <stdio.h>

/* Files with more pixels or a longer side are refused. Fuzzers are built with a lower limit, to be fast. */
#ifndef IMAGE_PIXELS_MAX
#define IMAGE_PIXELS_MAX (1u << 28)
#endif
#define IMAGE_SIDE_MAX 65536

/* width x height pixels of 1 (grey), 3 (RGB) or 4 (RGBA) interleaved channels, row by row, top row first. */
typedef struct Image {
    int width, height, channels;
    bool is_float; /* `data` holds float, else unsigned char (0 ... 255) */
    bool srgb_encoded; /* true for PNG, JPEG and TGA; a 16-bit PNG is float in [0, 1] and still encoded */
    void *data;
} Image;

void image_destroy(Image *image);

/* Element i of the data (pixel * channels + channel), without decoding: byte / 255, or the float. */
float image_value(const Image *image, size_t i);

/* Converts all pixels to linear RGB floats, 3 per pixel, in a new array that the caller frees: grey is repeated, alpha
 * dropped, sRGB decoded. Fails when out of memory. */
bool image_linear_rgb(const Image *image, float **rgb, Error *error);

/* ---- for decoders ------------------------------------------------------------------------------------------------ */

/* Sets "cannot read the image PATH: WHY" and a fix. Returns false. */
bool image_error(Error *error, const char *path, const char *why);

/* Image size as claimed by a file. `density`: upper bound of pixels per byte of such a file, so that a short file that
 * claims a large image is refused before memory is allocated. */
typedef struct ImageSize {
    long long width, height, density;
} ImageSize;

/* Fails if an image of this size is empty, exceeds the limits above, or is more than the file can hold. */
bool image_size_check(FILE *file, const char *path, ImageSize size, Error *error);

/* Checks the size, sets the members and allocates zeroed float data. */
bool image_allocate_float(FILE *file, const char *path, ImageSize size, int channels, Image *image, Error *error);

#endif
