/* Tone-mapped pictures for the eye. */
#ifndef TWINLIGHT_IMAGE_PNG_WRITE_H
#define TWINLIGHT_IMAGE_PNG_WRITE_H

#include "base/error.h"

#include <stddef.h>

/* Writes linear RGB floats (3 a pixel, row 0 on top) times 2^exposure_stops as 8-bit sRGB, clipped to 0 ... 1; NaN is
 * black. Written beside `path` and renamed. Fails, naming the path, when it cannot be written. */
bool png_write(const char *path, const float *rgb, int width, int height, float exposure_stops, Error *error);

/* Rows of a picture from the top on: 3 floats a pixel, until the next call. */
typedef struct PngRows {
    const float *(*row)(void *context, int y);
    void *context;
} PngRows;

/* The same from a picture that is made row by row. */
bool png_write_picture(const char *path, PngRows rows, int width, int height, float exposure_stops, Error *error);

/* The same as the bytes of the file, which the caller frees. Fails when memory is out. */
bool png_memory(const float *rgb, int width, int height, float exposure_stops, unsigned char **bytes, size_t *size,
                Error *error);

#endif
