/* Statistics of a few numbers. */
#ifndef TWINLIGHT_SAMPLE_STATISTICS_H
#define TWINLIGHT_SAMPLE_STATISTICS_H

#include <stddef.h>

/* Ascending. */
void sample_sort(double *values, size_t count);

/* The quantile q, 0 ... 1, linear between neighbours (Hyndman and Fan's type 7). Sorts `values`. NaN when count is 0. */
double sample_quantile(double *values, size_t count, double q);

/* The line intercept + slope x of least squares, and the standard error of its slope (NaN for fewer than three points).
 * All NaN when there are fewer than two points, or all x are equal. */
typedef struct SampleLine {
    double slope, slope_error, intercept;
} SampleLine;
SampleLine sample_line(const double *x, const double *y, size_t count);

#endif
