/* Pixel filters: samples against the filter's definition. */
#include "camera/pixel_filter.h"
#include "light/test_light.h"
#include "support/filter_cases.h"

/* Two chi-square tests per case. */
#define P_MIN (1e-3 / (2.0 * FILTER_CASE_COUNT))

/* Integrals over [-radius, radius] of |f|, f, x^2 f and, per cell of `cells`, of |f|, by a fine midpoint rule. */
static void integrate(const FilterSettings *s, double radius, double *absolute, double *moments, double *cells, int n)
{
    enum { SUB = 512 };
    *absolute = moments[0] = moments[1] = 0.0;
    for (int i = 0; i < n * SUB; ++i) {
        double h = 2.0 * radius / (n * SUB), x = -radius + h * (i + 0.5), value = filter_evaluate(s, radius, x) * h;
        cells[i / SUB] = (i % SUB == 0 ? 0.0 : cells[i / SUB]) + fabs(value);
        *absolute += fabs(value);
        moments[0] += value;
        moments[1] += value * x * x;
    }
}

START_TEST(test_density)
{
    enum { CELLS = 40, SAMPLES = 100000 };
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    LightFixture f;
    fixture_init_filter(&f, s);
    double cells[2][CELLS], observed[2][CELLS] = {{0.0}}, absolute[2], moments[2][2];
    const double radius[2] = {(double)s->radius_x, (double)s->radius_y};
    for (int axis = 0; axis < 2; ++axis)
        integrate(s, radius[axis], &absolute[axis], moments[axis], cells[axis], CELLS);
    for (uint i = 0; i < SAMPLES; ++i) {
        float weight;
        Vec2 offset = pixel_filter_sample(&f.view, fixture_random(1, i), &weight);
        const double x[2] = {(double)offset.x, (double)offset.y};
        double sign = filter_evaluate(s, radius[0], x[0]) * filter_evaluate(s, radius[1], x[1]);
        ck_assert(fabs(x[0]) <= radius[0] && fabs(x[1]) <= radius[1]);
        ck_assert_msg(sign * (double)weight >= 0.0, "%s at %g %g", FILTER_CASES[_i].name, x[0], x[1]);
        for (int axis = 0; axis < 2; ++axis)
            observed[axis][(int)fmin((x[axis] / radius[axis] + 1.0) * 0.5 * CELLS, CELLS - 1)] += 1.0;
    }
    for (int axis = 0; axis < 2; ++axis) {
        for (int i = 0; i < CELLS; ++i)
            cells[axis][i] *= SAMPLES / absolute[axis];
        double p = test_chi_square(observed[axis], cells[axis], CELLS);
        ck_assert_msg(p > P_MIN, "%s, axis %d: p = %g", FILTER_CASES[_i].name, axis, p);
    }
    fixture_destroy(&f);
}
END_TEST

/* Evenly spaced points along one axis have practically no noise (the other coordinate stays in the middle, where every
 * filter is positive): the weighted sums give the filter's integral, mean and variance to 1e-3. */
START_TEST(test_moments)
{
    enum { N = 65536 };
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    LightFixture f;
    fixture_init_filter(&f, s);
    double weight_of_all = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
        double sum = 0.0, first = 0.0, second = 0.0, absolute, moments[2], cells[64];
        integrate(s, axis == 0 ? (double)s->radius_x : (double)s->radius_y, &absolute, moments, cells, 64);
        weight_of_all *= absolute / moments[0];
        for (int i = 0; i < N; ++i) {
            float weight, u = ((float)i + 0.5f) / N;
            Vec2 offset = pixel_filter_sample(&f.view, axis == 0 ? vec2(u, 0.5f) : vec2(0.5f, u), &weight);
            double at = axis == 0 ? (double)offset.x : (double)offset.y;
            double w = (double)weight / (double)f.scene.frame.film.filter.weight / N * (absolute / moments[0]);
            sum += w;
            first += w * at;
            second += w * at * at;
        }
        ck_assert_msg(fabs(sum - 1.0) < 1e-3, "%s: mean weight %g", FILTER_CASES[_i].name, sum);
        ck_assert_msg(fabs(first) < 1e-3, "%s: mean %g", FILTER_CASES[_i].name, first);
        ck_assert_msg(fabs(second - moments[1] / moments[0]) < 1e-3, "%s: variance %g, not %g", FILTER_CASES[_i].name,
                      second, moments[1] / moments[0]);
    }
    ck_assert_double_eq_tol((double)f.scene.frame.film.filter.weight, weight_of_all, 1e-4);
    fixture_destroy(&f);
}
END_TEST

/* The purpose of weights of both signs: the filtered value of an image x -> 1 + a step, by random points. */
START_TEST(test_filtered_edge)
{
    enum { SAMPLES = 400000 };
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    const double edge = 0.4 * (double)s->radius_x;
    LightFixture f;
    fixture_init_filter(&f, s);
    double above = 0.0, all = 0.0, sum = 0.0, squares = 0.0;
    for (int i = 0; i < 100000; ++i) {
        double x = (double)s->radius_x * (2.0 * (i + 0.5) / 100000 - 1.0);
        double value = filter_evaluate(s, (double)s->radius_x, x);
        all += value;
        above += x > edge ? value : 0.0;
    }
    for (uint i = 0; i < SAMPLES; ++i) {
        float weight;
        Vec2 offset = pixel_filter_sample(&f.view, fixture_random(5, i), &weight);
        double value = (double)weight * ((double)offset.x > edge ? 3.0 : 1.0);
        sum += value;
        squares += value * value;
    }
    double mean = sum / SAMPLES, error = sqrt((squares / SAMPLES - mean * mean) / SAMPLES);
    double expected = 1.0 + 2.0 * above / all;
    ck_assert_msg(fabs(mean - expected) < 4.0 * error, "%s: %g, not %g +- %g", FILTER_CASES[_i].name, mean, expected,
                  error);
    fixture_destroy(&f);
}
END_TEST

/* pbrt-v4's values. */
START_TEST(test_definitions)
{
    const FilterSettings *g = &FILTER_CASES[FILTER_GAUSSIAN].settings, *m = &FILTER_CASES[FILTER_MITCHELL].settings,
                         *s = &FILTER_CASES[FILTER_SINC].settings;
    ck_assert_double_eq_tol(filter_evaluate(g, 1.5, 0.5) / filter_evaluate(g, 1.5, 0.0),
                            (exp(-0.5) - exp(-4.5)) / (1.0 - exp(-4.5)), 1e-12);
    ck_assert_double_eq_tol(filter_evaluate(m, 2.0, 0.0), 16.0 / 18.0, 1e-7);
    ck_assert_double_eq_tol(filter_evaluate(m, 2.0, 1.0), 1.0 / 18.0, 1e-7);
    ck_assert_double_eq_tol(filter_evaluate(s, 4.0, 0.5), sin(M_PI / 2) / (M_PI / 2) * sin(M_PI / 6) / (M_PI / 6),
                            1e-12);
    ck_assert_double_eq(filter_evaluate(s, 4.0, 4.1), 0.0);
}
END_TEST

START_TEST(test_bad_settings)
{
    static const FilterSettings bad[] = {
        {.kind = PIXEL_FILTER_BOX, .radius_x = 0.0f, .radius_y = 1.0f},
        {.kind = PIXEL_FILTER_BOX, .radius_x = 1.0f, .radius_y = NAN},
        {.kind = PIXEL_FILTER_GAUSSIAN, .radius_x = 1.0f, .radius_y = 1.0f, .sigma = 0.0f},
        {.kind = PIXEL_FILTER_SINC, .radius_x = 1.0f, .radius_y = 1.0f, .tau = -1.0f},
        {.kind = PIXEL_FILTER_MITCHELL, .radius_x = 2.0f, .radius_y = 2.0f, .b = INFINITY, .c = 1.0f}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        LightFixture f;
        Error error = {0};
        fixture_init(&f);
        ck_assert(!filter_setup(&bad[i], &f.scene.lookup, &f.scene.frame.film.filter, &error));
        ck_assert(error.message[0] != '\0' && error.fix[0] != '\0');
        fixture_destroy(&f);
    }
}
END_TEST

TCase *pixel_filter_case(void)
{
    TCase *tcase = tcase_create("pixel filter");
    tcase_add_loop_test(tcase, test_density, 0, FILTER_CASE_COUNT);
    tcase_add_loop_test(tcase, test_moments, 0, FILTER_CASE_COUNT);
    tcase_add_loop_test(tcase, test_filtered_edge, 0, FILTER_CASE_COUNT);
    tcase_add_test(tcase, test_definitions);
    tcase_add_test(tcase, test_bad_settings);
    return tcase;
}
