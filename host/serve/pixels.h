/* Layers as bytes for a client. */
#ifndef TWINLIGHT_SERVE_PIXELS_H
#define TWINLIGHT_SERVE_PIXELS_H

#include <stdbool.h>
#include <stddef.h>

/* Most often that a client may have the size halved. */
#define PIXELS_LEVEL_MAX 8

typedef struct Pixels {
    int width, height; /* of the level */
    size_t size;
    unsigned char *bytes; /* 3 values per pixel, row by row, the uppermost first, little-endian; to be freed */
} Pixels;

/* rgb[3 * width * height] as it is (level 0), or the means of blocks of 2^level x 2^level pixels, of which those at the
 * right and lower edge may be incomplete; minus `other`, unless that is NULL. As 16-bit floats, with finite values kept
 * finite, or 32-bit floats. False if there is no memory. */
bool pixels_make(Pixels *pixels, const float *rgb, const float *other, int width, int height, int level, bool half);

#endif
