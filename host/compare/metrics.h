/* Error metrics of an image against a reference, computed in double precision.
 *
 * I and R are linear RGB values of image and reference; means are over all values (pixels x 3), except for blocks.
 *   MSE     mean (I - R)^2
 *   relMSE  mean (I - R)^2 / (R^2 + 0.01)
 *   relMSE trimmed: the same without the floor(0.1 %) of pixels with the largest value (mean of the three channels)
 *   relMSE 8 x 8: relMSE of the means of tiles of 8 x 8 pixels, those at the right and lower edge smaller
 *   MAPE    mean |I - R| / (|R| + 0.01)
 *   SMAPE   mean |I - R| / ((|I| + |R|) / 2 + 0.01)
 *   blocks  N x N cells with edges round(i * size / N) (halves to even); with a and r the means of a cell over its
 *           pixels and channels and r0 the mean of all r: |a - r| / (|r| + 0.01 |r0|), maximum and mean over the cells
 * Values that are not finite count as 0, and pixels that have them are counted. */
#ifndef TWINLIGHT_COMPARE_METRICS_H
#define TWINLIGHT_COMPARE_METRICS_H

#include "base/error.h"

#include <stddef.h>

/* Pixels a side of a tile, about what an eye or a denoiser averages over. */
#define METRICS_TILE 8

/* One in this many pixels is left out of relMSE trimmed. */
#define METRICS_TRIMMED_SHARE 1000

typedef struct Metrics {
    double mse;
    double rel_mse;
    double rel_mse_trimmed;
    double rel_mse_8x8;
    double mape;
    double smape;
    double mean, mean_reference; /* of all values */
    double mean_rgb[3], mean_reference_rgb[3];
    int blocks; /* N used: at most the shorter side */
    double block_max, block_mean;
    size_t not_finite, not_finite_reference; /* pixels with a NaN or infinite channel */
} Metrics;

/* image, reference: width x height x 3 linear RGB. blocks >= 1. Fails when out of memory. */
bool metrics_compute(const float *image, const float *reference, int width, int height, int blocks, Metrics *metrics,
                     Error *error);

/* square / (reference^2 + 0.01), the term of relMSE. */
double metrics_relative_square(double square, double reference);

/* First pixel of block i of n along a side of `size` pixels: round(i size / n), halves to even. */
int metrics_block_edge(int i, int n, int size);

/* means[j * n + i] = mean over pixels and channels of block (i, j) of n x n, for an image of width x height x 3. n must
 * not exceed the shorter side. */
void metrics_block_means(const float *rgb, int width, int height, int n, double *means);

#endif
