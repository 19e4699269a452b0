/* Statistics of small samples. */
#ifndef TWINLIGHT_BASE_SAMPLE_STATISTICS_H
#define TWINLIGHT_BASE_SAMPLE_STATISTICS_H

#include <stddef.h>

/* Sorts ascending, NaN last. */
void sample_sort(double *values, size_t count);

/* The quantile q in [0, 1], interpolated linearly (type 7 of Hyndman and Fan). Sorts `values`. NaN if count is 0. */
double sample_quantile(double *values, size_t count, double q);

/* Running mean and variance (Welford's algorithm). */
typedef struct SampleMoments {
    double count, mean;
    double squares; /* sum of the squared differences from the mean */
} SampleMoments;
void sample_moments_add(SampleMoments *moments, double value);

/* Potential scale reduction (R-hat), sqrt(((n - 1) / n W + B / n) / W), of several groups of n draws: W is the mean of
 * their variances, B / n the variance of their means (Gelman and Rubin, "Inference from Iterative Simulation Using
 * Multiple Sequences", 1992, without its correction for degrees of freedom, as in Vehtari et al., "Rank-Normalization,
 * Folding, and Localization: An Improved R-hat", 2021, equations 1 to 4). Near 1 if all groups sample the same
 * distribution. Groups of fewer than two draws are ignored; n is the mean count of the others. NaN for fewer than two
 * groups or if all draws are equal; infinite if draws differ only between groups. */
double sample_r_hat(const SampleMoments *groups, size_t count);

/* Least-squares line intercept + slope x, and the standard error of its slope (NaN for fewer than three points). All
 * NaN for fewer than two points or if all x are equal. */
typedef struct SampleLine {
    double slope, slope_error, intercept;
} SampleLine;
SampleLine sample_line(const double *x, const double *y, size_t count);

#endif
