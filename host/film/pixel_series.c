#include "film/pixel_series.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

bool pixel_series_init(PixelSeries *series, size_t pixels, int channels, bool uniform, Error *error)
{
    size_t values = pixels * (size_t)channels, weights = uniform ? 1 : pixels;
    *series = (PixelSeries){.pixels = pixels, .channels = channels, .uniform = uniform};
    series->mean = calloc(values, sizeof *series->mean);
    series->spread = calloc(values, sizeof *series->spread);
    series->weight = calloc(weights, sizeof *series->weight);
    series->pictures = calloc(weights, sizeof *series->pictures);
    if (series->mean && series->spread && series->weight && series->pictures)
        return true;
    pixel_series_destroy(series);
    return error_memory(error, values * 2 * sizeof(float) + weights * (sizeof(float) + sizeof(short)), "variances");
}

void pixel_series_destroy(PixelSeries *series)
{
    free(series->mean);
    free(series->spread);
    free(series->weight);
    free(series->pictures);
    *series = (PixelSeries){0};
}

void pixel_series_archive(Archive *archive, PixelSeries *series)
{
    size_t values = series->pixels * (size_t)series->channels, weights = series->uniform ? 1 : series->pixels;
    archive_same(archive, values, "the number of values in a series of images");
    archive_same(archive, weights, "the number of weights in a series of images");
    archive_floats(archive, series->mean, values, RANGE_FLOATS, "the means of a series of images");
    /* Squares of very bright light are infinite. */
    archive_floats(archive, series->spread, values, (NumberRange){-(double)FLT_MAX, (double)INFINITY},
                   "the spreads of a series of images");
    archive_floats(archive, series->weight, weights, RANGE_FLOATS_POSITIVE, "the weights of a series of images");
    archive_bytes(archive, series->pictures, weights * sizeof *series->pictures);
}

/* Adds to the sum of a pixel's weights, and counts the image. */
static double weight_add(PixelSeries *series, size_t pixel, double weight)
{
    double sum = (double)series->weight[pixel] + weight;
    series->weight[pixel] = (float)sum;
    if (series->pictures[pixel] < USHRT_MAX)
        ++series->pictures[pixel];
    return sum;
}

/* part: `own`, the weight of the pixel in this image, over the sum of its weights. */
static void pixel_add(PixelSeries *series, const float *picture, size_t pixel, double own, double part)
{
    size_t channels = (size_t)series->channels;
    for (size_t value = pixel * channels; value < (pixel + 1) * channels; ++value) {
        double distance = (double)picture[value] - (double)series->mean[value];
        double mean = (double)series->mean[value] + part * distance;
        series->spread[value] += (float)(own * distance * ((double)picture[value] - mean));
        series->mean[value] = (float)mean;
    }
}

void pixel_series_begin(PixelSeries *series, double weight)
{
    series->latest = weight;
    weight_add(series, 0, weight);
}

void pixel_series_add_part(PixelSeries *series, const float *picture, size_t first, size_t end)
{
    double part = series->latest / (double)series->weight[0];
    for (size_t i = first; i < end; ++i)
        pixel_add(series, picture, i, series->latest, part);
}

/* Pixels have the weights weight * (weights[i] + more); those of zero are left out. */
static void pixels_add(PixelSeries *series, const float *picture, const uint32_t *weights, uint32_t more, double weight)
{
    for (size_t i = 0; i < series->pixels; ++i) {
        double own = weight * ((weights ? (double)weights[i] : 0.0) + more);
        if (own > 0.0)
            pixel_add(series, picture, i, own, own / weight_add(series, i, own));
    }
}

void pixel_series_add(PixelSeries *series, const float *picture, const uint32_t *weights, double weight)
{
    if (series->uniform) {
        pixel_series_begin(series, weight);
        pixel_series_add_part(series, picture, 0, series->pixels);
    } else {
        pixels_add(series, picture, weights, weights ? 0 : 1, weight);
    }
}

void pixel_series_add_counted(PixelSeries *series, const float *picture, const uint32_t *weights, uint32_t more)
{
    pixels_add(series, picture, weights, more, 1.0);
}

/* ---- two series -------------------------------------------------------------------------------------------------- */

/* Of a value's images; `spread` is here the sum of squared deviations. */
static PixelStatistics sums_of(const PixelSeries *series, size_t value)
{
    size_t pixel = value / (size_t)series->channels;
    return (PixelStatistics){(double)series->mean[value], (double)series->spread[value],
                             pixel_series_weight(series, pixel), pixel_series_pictures(series, pixel)};
}

/* Sums of squared deviations of two samples add up with that of their means (Chan, Golub and LeVeque 1979). */
static PixelStatistics sums_join(PixelStatistics a, PixelStatistics b)
{
    if (b.pictures == 0)
        return a;
    double part = b.weight / (a.weight + b.weight), distance = b.mean - a.mean;
    return (PixelStatistics){a.mean + part * distance, a.spread + b.spread + a.weight * part * distance * distance,
                             a.weight + b.weight, a.pictures + b.pictures};
}

PixelStatistics pixel_series_statistics(const PixelSeries *series, const PixelSeries *also, size_t value)
{
    PixelStatistics all = sums_of(series, value);
    if (also)
        all = sums_join(all, sums_of(also, value));
    all.spread = all.pictures > 1 ? all.spread / (all.pictures - 1) : 0.0;
    return all;
}

void pixel_series_merge(PixelSeries *series, const PixelSeries *from)
{
    for (size_t value = 0; value < series->pixels * (size_t)series->channels; ++value) {
        PixelStatistics all = sums_join(sums_of(series, value), sums_of(from, value));
        series->mean[value] = (float)all.mean;
        series->spread[value] = (float)all.spread;
    }
    for (size_t i = 0; i < (series->uniform ? 1 : series->pixels); ++i) {
        unsigned pictures = (unsigned)series->pictures[i] + from->pictures[i];
        series->weight[i] = (float)((double)series->weight[i] + (double)from->weight[i]);
        series->pictures[i] = (unsigned short)(pictures < USHRT_MAX ? pictures : USHRT_MAX);
    }
}

/* ---- variances --------------------------------------------------------------------------------------------------- */

double pixel_series_spread(const PixelSeries *series, size_t value)
{
    return pixel_series_statistics(series, NULL, value).spread;
}

double pixel_series_variance(const PixelSeries *series, size_t value)
{
    double weight = pixel_series_weight(series, value / (size_t)series->channels);
    return weight > 0.0 ? pixel_series_spread(series, value) / weight : 0.0;
}

static double middle_of(const PixelSeries *a, const PixelSeries *b, size_t value)
{
    return 0.5 * ((double)a->mean[value] + (double)b->mean[value]);
}

double pixel_series_sum(const PixelSeries *a, const PixelSeries *b, PixelWindow window)
{
    size_t channels = (size_t)a->channels, row = (window.x1 - window.x0) * channels;
    double sum = 0.0;
    for (size_t y = window.y0; y < window.y1; ++y) {
        size_t first = (y * window.width + window.x0) * channels;
        for (size_t i = first; i < first + row; ++i)
            sum += middle_of(a, b, i);
    }
    return sum;
}

static void row_compare(const PixelSeries *a, const PixelSeries *b, size_t first, size_t end, double dark,
                        PixelVariances *sums)
{
    for (size_t i = first; i < end; ++i) {
        size_t pixel = i / (size_t)a->channels;
        double distance = (double)a->mean[i] - (double)b->mean[i], middle = middle_of(a, b, i);
        double square = middle * middle + dark;
        if (pixel_series_pictures(a, pixel) < 2 || pixel_series_pictures(b, pixel) < 2 || !(square > 0.0))
            continue;
        sums->found += distance * distance / square;
        sums->stated += (pixel_series_variance(a, i) + pixel_series_variance(b, i)) / square;
    }
}

PixelVariances pixel_series_compare(const PixelSeries *a, const PixelSeries *b, PixelWindow window, double dark)
{
    size_t channels = (size_t)a->channels, row = (window.x1 - window.x0) * channels;
    PixelVariances sums = {0.0, 0.0};
    for (size_t y = window.y0; y < window.y1; ++y) {
        size_t first = (y * window.width + window.x0) * channels;
        row_compare(a, b, first, first + row, dark, &sums);
    }
    return sums;
}

double pixel_variances_left(PixelVariances sums)
{
    return sums.stated > 0.0 ? fmin(sums.found / sums.stated, 1.0) : 1.0;
}

double pixel_series_stratified(const PixelSeries *a, const PixelSeries *b, PixelWindow window, double dark)
{
    double values = (double)((window.y1 - window.y0) * (window.x1 - window.x0) * (size_t)a->channels);
    if (a == b)
        return 1.0;
    double mean = pixel_series_sum(a, b, window) / values;
    return pixel_variances_left(pixel_series_compare(a, b, window, dark * mean * mean));
}
