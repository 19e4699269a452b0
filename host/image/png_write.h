/* Writes PNG files for viewing. */
#ifndef TWINLIGHT_IMAGE_PNG_WRITE_H
#define TWINLIGHT_IMAGE_PNG_WRITE_H

#include "base/error.h"

#include <stddef.h>

/* Writes linear RGB (3 floats per pixel, top row first), multiplied by 2^exposure_stops, as 8-bit sRGB clipped to [0,
 * 1]; NaN becomes black. The file is written beside `path` and renamed when complete. Fails, naming the path, if it
 * cannot be written. */
bool png_write(const char *path, const float *rgb, int width, int height, float exposure_stops, Error *error);

/* Writes 8-bit values as they are: grey (channels 1) or RGB (3). */
bool png_write_bytes(const char *path, const unsigned char *bytes, int width, int height, int channels, Error *error);

/* Supplies rows from top to bottom: 3 floats per pixel, valid until the next call. */
typedef struct PngRows {
    const float *(*row)(void *context, int y);
    void *context;
} PngRows;

/* The same for an image that is produced row by row. */
bool png_write_picture(const char *path, PngRows rows, int width, int height, float exposure_stops, Error *error);

/* The same into a new array with the bytes of the file, which the caller frees. */
bool png_memory(const float *rgb, int width, int height, float exposure_stops, unsigned char **bytes, size_t *size,
                Error *error);

#endif
