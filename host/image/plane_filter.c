#include "image/plane_filter.h"

#include <math.h>
#include <stddef.h>

void filter_gaussian(FilterTaps *filter, int radius, double exponent)
{
    filter->radius = radius;
    for (int i = -radius; i <= radius; ++i)
        filter->taps[radius + i] = exp(-exponent * i * i);
}

void filter_scale(FilterTaps *filter, double factor)
{
    for (int i = 0; i <= 2 * filter->radius; ++i)
        filter->taps[i] *= factor;
}

double filter_sum(const FilterTaps *filter)
{
    double sum = 0.0;
    for (int i = 0; i <= 2 * filter->radius; ++i)
        sum += filter->taps[i];
    return sum;
}

static int index_clamp(int i, int size)
{
    return i < 0 ? 0 : i >= size ? size - 1 : i;
}

static void rows_filter(const double *in, int width, int height, const FilterTaps *filter, double *out)
{
    for (int y = 0; y < height; ++y) {
        const double *row = in + (size_t)y * (size_t)width;
        for (int x = 0; x < width; ++x) {
            double sum = 0.0;
            for (int i = -filter->radius; i <= filter->radius; ++i)
                sum += filter->taps[filter->radius + i] * row[index_clamp(x + i, width)];
            out[(size_t)y * (size_t)width + (size_t)x] = sum;
        }
    }
}

static void columns_filter(const double *in, int width, int height, const FilterTaps *filter, double *out)
{
    for (int y = 0; y < height; ++y) {
        double *to = out + (size_t)y * (size_t)width;
        for (int x = 0; x < width; ++x)
            to[x] = 0.0;
        for (int j = -filter->radius; j <= filter->radius; ++j) {
            const double *from = in + (size_t)index_clamp(y + j, height) * (size_t)width;
            double tap = filter->taps[filter->radius + j];
            for (int x = 0; x < width; ++x)
                to[x] += tap * from[x];
        }
    }
}

void plane_filter(const double *in, int width, int height, const FilterTaps *along_x, const FilterTaps *along_y,
                  double *scratch, double *out)
{
    rows_filter(in, width, height, along_x, scratch);
    columns_filter(scratch, width, height, along_y, out);
}
