/* Weighted mean and variance of every pixel over a sequence of images of the same scene: a pixel of image g has
 * variance sigma^2 / weight_g (West, "Updating Mean and Variance Estimates", 1979). */
#ifndef TWINLIGHT_FILM_PIXEL_SERIES_H
#define TWINLIGHT_FILM_PIXEL_SERIES_H

#include "base/archive.h"

#include <stddef.h>
#include <stdint.h>

typedef struct PixelSeries {
    size_t pixels;
    int channels; /* values per pixel, interleaved */
    bool uniform; /* all pixels of an image have the same weight */
    float *mean; /* pixels x channels */
    float *spread; /* sum of weight x squared deviation from the mean, pixels x channels */
    float *weight; /* sum of weights, per pixel; one if uniform */
    unsigned short *pictures; /* number of images in which the pixel had a weight; saturates at 65535; one if uniform */
    double latest; /* weight of the latest image, if uniform */
} PixelSeries;

/* An empty series; fails when out of memory. */
bool pixel_series_init(PixelSeries *series, size_t pixels, int channels, bool uniform, Error *error);
void pixel_series_destroy(PixelSeries *series);

/* Saves the images so far, or restores them into a series of the same size. */
void pixel_series_archive(Archive *archive, PixelSeries *series);

/* Adds an image. `weights`: per pixel, 0 where it was not sampled; NULL: all 1, and only that if uniform. They are
 * multiplied by `weight` > 0. */
void pixel_series_add(PixelSeries *series, const float *picture, const uint32_t *weights, double weight);

/* Adds an image in which pixels have the weights weights[i] + more, 0 where they were not sampled; to a series that is
 * not uniform. */
void pixel_series_add_counted(PixelSeries *series, const float *picture, const uint32_t *weights, uint32_t more);

/* pixel_series_add in parts, for a uniform series: the weight of the image, then the pixels first ... end - 1 of each
 * part. */
void pixel_series_begin(PixelSeries *series, double weight);
void pixel_series_add_part(PixelSeries *series, const float *picture, size_t first, size_t end);

/* Adds the images of another series of the same size. */
void pixel_series_merge(PixelSeries *series, const PixelSeries *from);

/* Sum of the weights of a pixel, and number of its images. */
static inline double pixel_series_weight(const PixelSeries *series, size_t pixel)
{
    return (double)series->weight[series->uniform ? 0 : pixel];
}

static inline unsigned pixel_series_pictures(const PixelSeries *series, size_t pixel)
{
    return series->pictures[series->uniform ? 0 : pixel];
}

/* What the images of a series, or of two of the same values together, say of one. */
typedef struct PixelStatistics {
    double mean;
    double spread; /* estimate of sigma^2; 0 before the second image */
    double weight; /* sum of the weights */
    unsigned pictures;
} PixelStatistics;

/* also: another series or NULL. value: pixel x channels + channel. */
PixelStatistics pixel_series_statistics(const PixelSeries *series, const PixelSeries *also, size_t value);

/* Estimate of sigma^2, the variance of a value of weight 1; 0 before the second image. value: pixel x channels +
 * channel. */
double pixel_series_spread(const PixelSeries *series, size_t value);

/* Estimated variance of a value's weighted mean. */
double pixel_series_variance(const PixelSeries *series, size_t value);

/* Part of an image: pixels x0 <= x < x1, y0 <= y < y1 of rows of `width`. */
typedef struct PixelWindow {
    size_t width, x0, y0, x1, y1;
} PixelWindow;

/* The values of a window summed, means of two series. */
double pixel_series_sum(const PixelSeries *a, const PixelSeries *b, PixelWindow window);

/* How much of the variance of two series, relative to the square of each value plus `dark`, is found from their
 * difference, and how much they state. */
typedef struct PixelVariances {
    double found, stated;
} PixelVariances;

PixelVariances pixel_series_compare(const PixelSeries *a, const PixelSeries *b, PixelWindow window, double dark);

/* The part of the stated variance that is found; at most 1. */
double pixel_variances_left(PixelVariances sums);

/* What is left of these variances if the samples of a series are stratified across its images: a and b are two such
 * series of the same values, independent of each other, so that the difference of their means shows their real
 * variance. One factor for all values in the window, each relative to its square plus `dark` times that of their mean;
 * at most 1. 1 if a is b, or before the second image of either. */
double pixel_series_stratified(const PixelSeries *a, const PixelSeries *b, PixelWindow window, double dark);

#endif
