/* Shared by all Check programs: the main function, cheap assertions, file locations, and statistics for tests of
 * sampling. */
#ifndef TWINLIGHT_TESTS_SUPPORT_TEST_UTIL_H
#define TWINLIGHT_TESTS_SUPPORT_TEST_UTIL_H

#include <check.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Check's macros print floats as doubles. */
#pragma GCC diagnostic ignored "-Wdouble-promotion"

/* Runs the suite; returns the program's exit status. */
static inline int test_run(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* For loops: Check's own assertions write every success to a file, which takes a microsecond each. */
#define TEST_NEAR(got, expected, tolerance)                                                                            \
    do {                                                                                                               \
        double test_got = (double)(got), test_expected = (double)(expected);                                           \
        if (!(fabs(test_got - test_expected) <= (tolerance)))                                                          \
            ck_abort_msg("%s is %.9g, not %.9g", #got, test_got, test_expected);                                       \
    } while (0)
#define TEST_TRUE(condition)                                                                                           \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            ck_abort_msg("%s is false", #condition);                                                                   \
    } while (0)

/* The top folder of the sources: make check sets srcdir; run by hand, tests are in the build folder below it. */
static inline const char *test_source_folder(void)
{
    const char *folder = getenv("srcdir");
    return folder ? folder : "..";
}

/* $TWINLIGHT_TEST_EFFORT, or 1: factor for the effort of long tests (make check-long). */
static inline unsigned test_effort(void)
{
    const char *text = getenv("TWINLIGHT_TEST_EFFORT");
    int effort = text ? atoi(text) : 1;
    return effort > 0 ? (unsigned)effort : 1;
}

/* path = NAME in the folder of the public scenes, $SCENES or else shared/scenes beside the sources. Returns false, with
 * a line on standard error, if it does not exist. */
static inline bool test_public_scene(const char *name, char *path, size_t size)
{
    const char *folder = getenv("SCENES");
    if (folder)
        snprintf(path, size, "%s/%s", folder, name);
    else
        snprintf(path, size, "%s/../shared/scenes/%s", test_source_folder(), name);
    if (access(path, R_OK) == 0)
        return true;
    fprintf(stderr, "skipped: there is no public scene %s (set SCENES to their folder)\n", path);
    return false;
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
 * each pool expects at least 5. The totals must agree. */
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
