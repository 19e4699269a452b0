/* Statistics of a few numbers. */
#ifndef TWINLIGHT_BASE_SAMPLE_STATISTICS_H
#define TWINLIGHT_BASE_SAMPLE_STATISTICS_H

#include <stddef.h>

/* Ascending. */
void sample_sort(double *values, size_t count);

/* The quantile q, 0 ... 1, linear between neighbours (Hyndman and Fan's type 7). Sorts `values`. NaN when count is
 * 0. */
double sample_quantile(double *values, size_t count, double q);

/* Of numbers that come one at a time. */
typedef struct SampleMoments {
    double count, mean;
    double squares; /* sum of the squared differences from the mean */
} SampleMoments;
void sample_moments_add(SampleMoments *moments, double value);

/* The potential scale reduction sqrt(((n - 1) / n W + B / n) / W) of several groups of n draws: W is the mean of their
 * variances, B / n the variance of their means (Gelman and Rubin, "Inference from Iterative Simulation Using Multiple
 * Sequences", 1992, without its correction for degrees of freedom, as in Vehtari et al., "Rank-Normalization, Folding,
 * and Localization: An Improved R-hat", 2021, equations 1 to 4). Near 1 when the groups could be parts of one sample.
 * Groups of fewer than two draws do not count; n is the mean of the others'. NaN for fewer than two groups, or when all
 * draws are the same; infinite when they differ between groups alone. */
double sample_r_hat(const SampleMoments *groups, size_t count);

/* The line intercept + slope x of least squares, and the standard error of its slope (NaN for fewer than three points).
 * All NaN when there are fewer than two points, or all x are equal. */
typedef struct SampleLine {
    double slope, slope_error, intercept;
} SampleLine;
SampleLine sample_line(const double *x, const double *y, size_t count);

#endif
