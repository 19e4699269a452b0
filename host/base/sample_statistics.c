#include "base/sample_statistics.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    if (isnan(x) || isnan(y)) /* qsort needs an order of all values */
        return (isnan(x) ? 1 : 0) - (isnan(y) ? 1 : 0);
    return (x > y) - (x < y);
}

void sample_sort(double *values, size_t count)
{
    qsort(values, count, sizeof *values, ascending);
}

double sample_quantile(double *values, size_t count, double q)
{
    if (count == 0)
        return (double)NAN;
    sample_sort(values, count);
    double place = q * (double)(count - 1);
    size_t below = (size_t)place;
    double part = place - (double)below;
    return part > 0.0 ? values[below] + part * (values[below + 1] - values[below]) : values[below];
}

/* Welford, "Note on a Method for Calculating Corrected Sums of Squares and Products", 1962. */
void sample_moments_add(SampleMoments *moments, double value)
{
    double difference = value - moments->mean;
    moments->count += 1.0;
    moments->mean += difference / moments->count;
    moments->squares += difference * (value - moments->mean);
}

double sample_r_hat(const SampleMoments *groups, size_t count)
{
    SampleMoments means = {0};
    double draws = 0.0, within = 0.0;
    for (size_t i = 0; i < count; ++i) {
        if (groups[i].count < 2.0)
            continue;
        sample_moments_add(&means, groups[i].mean);
        draws += groups[i].count;
        within += groups[i].squares / (groups[i].count - 1.0);
    }
    if (means.count < 2.0)
        return (double)NAN;
    double n = draws / means.count, w = within / means.count, between = means.squares / (means.count - 1.0);
    if (!(w > 0.0))
        return between > 0.0 ? (double)INFINITY : (double)NAN;
    return sqrt((n - 1.0) / n + between / w);
}

SampleLine sample_line(const double *x, const double *y, size_t count)
{
    double n = (double)count, mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0, residual = 0.0;
    for (size_t i = 0; i < count; ++i) {
        mean_x += x[i] / n;
        mean_y += y[i] / n;
    }
    for (size_t i = 0; i < count; ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (count < 2 || !(xx > 0.0))
        return (SampleLine){(double)NAN, (double)NAN, (double)NAN};
    SampleLine line = {.slope = xy / xx, .slope_error = (double)NAN};
    line.intercept = mean_y - line.slope * mean_x;
    for (size_t i = 0; i < count; ++i) {
        double r = y[i] - line.intercept - line.slope * x[i];
        residual += r * r;
    }
    if (count > 2)
        line.slope_error = sqrt(residual / (n - 2.0) / xx);
    return line;
}
