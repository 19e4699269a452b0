/* Tone-mapped pictures for the eye. */
#ifndef TWINLIGHT_PNG_WRITE_H
#define TWINLIGHT_PNG_WRITE_H

#include "error.h"

/* Writes linear RGB floats (3 a pixel, row 0 on top) times 2^exposure_stops as 8-bit sRGB, clipped to 0 ... 1; NaN is
 * black. Written beside `path` and renamed. Fails, naming the path, when it cannot be written. */
bool png_write(const char *path, const float *rgb, int width, int height, float exposure_stops, Error *error);

#endif
