/* What few samples, or few generations, tell of a tile. */
#include "mmlt/test_combination_estimators.h"

#include "mmlt/tuning.h"

/* A series, and the samples per pixel of its estimator in each of GENERATIONS: few or many. */
typedef struct FewCase {
    const char *name;
    int series;
    EstimatorKind estimator;
    double few, many;
} FewCase;

static const FewCase FEW_CASES[] = {
    {"excess", SERIES_EXCESS, ESTIMATOR_CHAINS, 0.01, 1000.0},
    {"light of chains", ESTIMATOR_CHAINS, ESTIMATOR_CHAINS, 0.01, 1000.0},
    {"light of pools", ESTIMATOR_POOL, ESTIMATOR_POOL, 0.0025, 250.0},
};

#define GENERATIONS 20

/* Few samples come to a tile in all generations, and one of them has found bright light: tiles that have met none have
 * no less variance (even _i). With many samples the tile is an exception. */
START_TEST(test_samples_few)
{
    const FewCase *test = &FEW_CASES[_i / 2];
    const bool few = _i % 2 == 0;
    const double samples = few ? test->few : test->many;
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < GENERATIONS; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, test->estimator == ESTIMATOR_CHAINS ? samples : 1.0, 1.0, 0.0);
        estimator_set(&estimators, ESTIMATOR_POOL, test->estimator == ESTIMATOR_POOL ? samples : 1.0, 1.0, 0.01);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, 0.01);
        Film *film = &estimators.films[test->estimator];
        int64_t *sums = test->series == SERIES_EXCESS ? film->sums : film->light_sums;
        for (size_t c = 0; g == 10 && c < 3; ++c)
            sums[c] += llrint(100.0 * samples * 0x1p30);
        generation(&estimators);
    }
    const CombinationTile *known = estimators.combination.known;
    double own = known[0].spread[test->series], elsewhere = known[15].spread[test->series];
    printf("%s, %g samples per pixel: variance where it was found %.3g, elsewhere %.3g\n", test->name, samples, own,
           elsewhere);
    if (few)
        ck_assert_double_gt(elsewhere, own / 64.0);
    else
        ck_assert_double_lt(elsewhere, own / 64.0);
    estimators_destroy(&estimators);
}
END_TEST

/* In one tile a pool has more light than chains, by a number of the standard errors that its generations state. Of two
 * generations six are no evidence (_i 0), of many they are (_i 1): then chains miss that light, and have more variance
 * there than elsewhere. */
START_TEST(test_missing_few)
{
    Estimators estimators;
    const int generations = _i == 0 ? 2 : GENERATIONS;
    const double excess = 0.6, error = excess / 6.0, deviation = error * sqrt((double)generations - 1.0);
    estimators_init(&estimators);
    for (int g = 0; g < generations; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 1000.0, 1.0, 0.01);
        estimator_set(&estimators, ESTIMATOR_POOL, 1000.0, 1.0, 0.01);
        estimator_set(&estimators, ESTIMATOR_PATHS, 1000.0, 1.0, 0.01);
        const double light = 1.0 + excess + (g % 2 == 0 ? deviation : -deviation);
        for (size_t y = 0; y < 8; ++y)
            for (size_t x = 0; x < 3 * 8; ++x)
                estimators.films[ESTIMATOR_POOL].light_sums[3 * y * SIDE + x] = llrint(light * 1000.0 * 0x1p30);
        generation(&estimators);
    }
    const CombinationTile *known = estimators.combination.known;
    double own = known[0].spread[ESTIMATOR_CHAINS], elsewhere = known[15].spread[ESTIMATOR_CHAINS];
    printf("%d generations: variance of chains where pools have more light %.3g, elsewhere %.3g\n", generations, own,
           elsewhere);
    if (_i == 0)
        ck_assert_double_lt(own, 100.0 * elsewhere);
    else
        ck_assert_double_gt(own, 100.0 * elsewhere);
    estimators_destroy(&estimators);
}
END_TEST

TCase *combination_few_tests(void)
{
    TCase *tcase = tcase_create("few");
    tcase_add_loop_test(tcase, test_samples_few, 0, 2 * (int)(sizeof FEW_CASES / sizeof FEW_CASES[0]));
    tcase_add_loop_test(tcase, test_missing_few, 0, 2);
    return tcase;
}
