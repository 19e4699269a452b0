#include "film/pixel_series.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

bool pixel_series_init(PixelSeries *series, size_t pixels, int channels, Error *error)
{
    size_t values = pixels * (size_t)channels;
    *series = (PixelSeries){.pixels = pixels, .channels = channels};
    series->mean = calloc(values, sizeof *series->mean);
    series->spread = calloc(values, sizeof *series->spread);
    series->weight = calloc(pixels, sizeof *series->weight);
    series->pictures = calloc(pixels, sizeof *series->pictures);
    if (series->mean && series->spread && series->weight && series->pictures)
        return true;
    pixel_series_destroy(series);
    return error_memory(error, values * 2 * sizeof(float) + pixels * (sizeof(float) + sizeof(short)), "variances");
}

void pixel_series_destroy(PixelSeries *series)
{
    free(series->mean);
    free(series->spread);
    free(series->weight);
    free(series->pictures);
    *series = (PixelSeries){0};
}

void pixel_series_add(PixelSeries *series, const float *picture, const uint32_t *weights, double weight)
{
    pixel_series_add_part(series, picture, weights, weight, 0, series->pixels);
}

void pixel_series_add_part(PixelSeries *series, const float *picture, const uint32_t *weights, double weight,
                           size_t first, size_t end)
{
    size_t channels = (size_t)series->channels;
    for (size_t i = first; i < end; ++i) {
        double own = weights ? weight * (double)weights[i] : weight;
        if (!(own > 0.0))
            continue;
        double sum = (double)series->weight[i] + own, part = own / sum;
        series->weight[i] = (float)sum;
        if (series->pictures[i] < USHRT_MAX)
            ++series->pictures[i];
        for (size_t value = i * channels; value < (i + 1) * channels; ++value) {
            double distance = (double)picture[value] - (double)series->mean[value];
            double mean = (double)series->mean[value] + part * distance;
            series->spread[value] += (float)(own * distance * ((double)picture[value] - mean));
            series->mean[value] = (float)mean;
        }
    }
}

double pixel_series_spread(const PixelSeries *series, size_t value)
{
    unsigned pictures = series->pictures[value / (size_t)series->channels];
    return pictures > 1 ? (double)series->spread[value] / (pictures - 1) : 0.0;
}

double pixel_series_variance(const PixelSeries *series, size_t value)
{
    double weight = (double)series->weight[value / (size_t)series->channels];
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
        if (a->pictures[pixel] < 2 || b->pictures[pixel] < 2 || !(square > 0.0))
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
