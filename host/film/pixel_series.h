/* Mean and variance of every pixel of a sequence of pictures of the same thing, each with a weight: the variance of a
 * pixel of picture g is sigma^2 / weight_g (West, "Updating Mean and Variance Estimates", 1979). */
#ifndef TWINLIGHT_FILM_PIXEL_SERIES_H
#define TWINLIGHT_FILM_PIXEL_SERIES_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct PixelSeries {
    size_t pixels;
    int channels; /* values of a pixel, interleaved */
    float *mean; /* pixels x channels */
    float *spread; /* sum of weight x squared distance from the mean, pixels x channels */
    float *weight; /* sum, a pixel */
    unsigned short *pictures; /* in which the pixel had a weight; stays at 65535 */
} PixelSeries;

bool pixel_series_init(PixelSeries *series, size_t pixels, int channels, Error *error);
void pixel_series_destroy(PixelSeries *series);

/* Adds a picture. weights: of every pixel, 0 where it was not seen; NULL: 1. Each times `weight`, > 0. */
void pixel_series_add(PixelSeries *series, const float *picture, const uint32_t *weights, double weight);

/* sigma^2 of a value of weight 1; 0 before a second picture. value: pixel x channels + channel. */
double pixel_series_spread(const PixelSeries *series, size_t value);

/* The estimated variance of a value's weighted mean. */
double pixel_series_variance(const PixelSeries *series, size_t value);

#endif
