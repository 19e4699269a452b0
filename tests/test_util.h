/* What every Check program needs: its main function and statistics for tests of sampling. */
#ifndef TWINLIGHT_TEST_UTIL_H
#define TWINLIGHT_TEST_UTIL_H

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Runs the suite; the program's exit status is the result. */
static inline int test_run(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* Regularised upper incomplete gamma function Q(a, x) by series or continued fraction (Abramowitz and Stegun 6.5.29,
 * 6.5.31), to about 1e-12. */
static inline double test_gamma_q(double a, double x)
{
    if (x <= 0.0)
        return 1.0;
    double front = exp(a * log(x) - x - lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < 100000 && fabs(term) > 1e-15 * fabs(sum); ++n) {
            term *= x / (a + n);
            sum += term;
        }
        return 1.0 - front * sum;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
    for (int n = 1; n < 100000; ++n) {
        double an = -n * (n - a);
        b += 2.0;
        d = an * d + b;
        c = b + an / c;
        if (fabs(d) < 1e-300)
            d = 1e-300;
        if (fabs(c) < 1e-300)
            c = 1e-300;
        d = 1.0 / d;
        h *= d * c;
        if (fabs(d * c - 1.0) < 1e-15)
            break;
    }
    return front * h;
}

/* p-value of Pearson's chi-square test of `observed` counts against `expected` ones. Cells are pooled in order until
 * each pool expects at least 5. Total counts must agree. */
static inline double test_chi_square(const double *observed, const double *expected, int cells)
{
    double statistic = 0.0, pooled_observed = 0.0, pooled_expected = 0.0;
    int pools = 0;
    for (int i = 0; i < cells; ++i) {
        pooled_observed += observed[i];
        pooled_expected += expected[i];
        if (pooled_expected >= 5.0) {
            double difference = pooled_observed - pooled_expected;
            statistic += difference * difference / pooled_expected;
            pooled_observed = pooled_expected = 0.0;
            ++pools;
        }
    }
    if (pooled_expected > 0.0) {
        double difference = pooled_observed - pooled_expected;
        statistic += difference * difference / fmax(pooled_expected, 1e-3);
        ++pools;
    }
    return pools > 1 ? test_gamma_q(0.5 * (pools - 1), 0.5 * statistic) : 1.0;
}

#endif
