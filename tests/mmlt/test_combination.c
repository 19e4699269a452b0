/* Weights of chains, pool and path tracing, from generations of synthetic noise. */
#include "mmlt/combination.h"
#include "mmlt/importance.h"

#include "mmlt/test_combination_estimators.h"

/* Path tracing whose samples cancel each other's errors over the generations of a replica (_i 1): the replicas' means
 * differ less than their generations say, and so path tracing gets most of the weight. The same if they do so over
 * those of both, which are one sequence (_i 2): its mean changes less. If all samples are independent (_i 0, and 3 for
 * one sequence), nothing changes: test_weights. */
START_TEST(test_stratified)
{
    Estimators replicas[2];
    static double errors[2][PIXELS];
    for (int r = 0; r < 2; ++r) {
        estimators_init(&replicas[r]);
        replicas[r].draws = (uint)r << 30;
        replicas[r].combination.one_sequence = _i >= 2;
    }
    for (int g = 0; g < 80; ++g) {
        Estimators *own = &replicas[g % 2];
        estimator_set(own, ESTIMATOR_CHAINS, 4.0, 1.0, 1.0);
        estimator_set(own, ESTIMATOR_POOL, 1.0, 1.0, 0.5);
        estimator_set(own, ESTIMATOR_PATHS, 2.0, 1.0, 2.0);
        for (size_t i = 0; i < PIXELS && (_i == 1 || _i == 2); ++i) {
            double *last = _i == 1 ? &errors[g % 2][i] : &errors[0][i];
            double now = g / (_i == 1 ? 2 : 1) % 2 == 0 ? 2.0 * noise(own) / sqrt(2.0) : -*last;
            *last = now;
            for (size_t c = 0; c < 3; ++c)
                own->films[ESTIMATOR_PATHS].light_sums[3 * i + c] = llrint((1.0 + now) * 2.0 * 0x1p30);
        }
        Film *const films[ESTIMATOR_COUNT] = {&own->films[0], &own->films[1], &own->films[2]};
        films_combine(&own->combination, &replicas[1 - g % 2].combination, films);
    }
    double weight = replicas[0].combination.weight[ESTIMATOR_PATHS];
    printf("stratified %d: weight of path tracing %.3f, exponents %.3f and %.3f\n", _i, weight,
           replicas[0].combination.exponents[0], replicas[1].combination.exponents[0]);
    /* After an odd number of generations of 2 samples the last one's error is left: variance 8 / samples^2 in units of
     * a sample's, which is 4 / samples^1.83 at 60 of them; after an even number there is none. */
    const double *exponent = replicas[0].combination.exponents;
    if (_i == 2) {
        ck_assert_double_eq_tol(exponent[0], 1.8, 0.2);
        ck_assert_double_gt(replicas[1].combination.exponents[0], 2.9);
    } else {
        ck_assert_double_lt(exponent[0], 1.15);
    }
    /* 4 / 1 and 1 / 0.25, against 2 / 4; chains' errors in neighbouring pixels are independent but for chance. */
    double correlation = replicas[0].combination.chains_correlation, chains = correlation / 8.0;
    ck_assert_double_lt(correlation, 1.15);
    if (_i == 1 || _i == 2)
        ck_assert_double_gt(weight, _i == 1 ? 0.7 : 0.5);
    else
        ck_assert_double_eq_tol(weight, chains / (chains + 2.0), 0.02);
    for (int r = 0; r < 2; ++r)
        estimators_destroy(&replicas[r]);
}
END_TEST

/* Chains whose error is the same in all pixels of a tile: the variance of the sum over a patch, by which chains are
 * weighted against the pool, is 16 times that of independent pixels. Against path tracing that of the tile counts,
 * which is four times the sum of its patches'. */
START_TEST(test_correlated)
{
    Estimators estimators;
    double errors[PIXELS / 64] = {0.0}; /* cancel in pairs of generations, so that no light seems to be missing */
    estimators_init(&estimators);
    for (int g = 0; g < 200; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 0.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 0.5);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, 2.0);
        for (size_t tile = 0; tile < PIXELS / 64; ++tile)
            errors[tile] = g % 2 == 0 ? noise(&estimators) / sqrt(4.0) : -errors[tile];
        for (size_t i = 0; i < 3 * PIXELS; ++i) {
            size_t x = i / 3 % SIDE, y = i / 3 / SIDE;
            estimators.films[ESTIMATOR_CHAINS].light_sums[i] =
                llrint((1.0 + errors[y / 8 * (SIDE / 8) + x / 8]) * 4.0 * 0x1p30);
        }
        generation(&estimators);
    }
    /* 4 / 16 and 1 / 0.25, against 2 / 4 */
    const double *weight = estimators.combination.weight, chains = 4.0 / 16.0, pool = 1.0 / 0.25,
                 others = 4.0 / (chains + pool), paths = others / (others + 2.0);
    printf("correlated: %.3f, weights %.3f %.3f %.3f\n", estimators.combination.chains_correlation, weight[0],
           weight[1], weight[2]);
    ck_assert_double_eq_tol(estimators.combination.chains_correlation, 4.0, 0.01);
    ck_assert_double_eq_tol(weight[ESTIMATOR_CHAINS], (1.0 - paths) * chains / (chains + pool), 0.01);
    ck_assert_double_eq_tol(weight[ESTIMATOR_POOL], (1.0 - paths) * pool / (chains + pool), 0.02);
    estimators_destroy(&estimators);
}
END_TEST

/* Weights are proportional to samples over variance. */
START_TEST(test_weights)
{
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < 60; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 0.5);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, 2.0);
        double mean = generation(&estimators);
        ck_assert_double_eq_tol(mean, 1.0, 0.08);
    }
    /* 4 / 1, 1 / 0.25, 2 / 4 */
    const double *weight = estimators.combination.weight;
    printf("weights %.3f %.3f %.3f\n", weight[0], weight[1], weight[2]);
    ck_assert_double_eq_tol(weight[ESTIMATOR_CHAINS], 4.0 / 8.5, 0.02);
    ck_assert_double_eq_tol(weight[ESTIMATOR_POOL], 4.0 / 8.5, 0.02);
    ck_assert_double_eq_tol(weight[ESTIMATOR_PATHS], 0.5 / 8.5, 0.02);
    estimators_destroy(&estimators);
}
END_TEST

/* An estimator that never finds the light has no variance, but must not get a substantial weight. */
START_TEST(test_blind)
{
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < 30; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, _i == ESTIMATOR_POOL ? 0.0 : 1.0,
                      _i == ESTIMATOR_POOL ? 0.0 : 1.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, _i == ESTIMATOR_PATHS ? 0.0 : 1.0,
                      _i == ESTIMATOR_PATHS ? 0.0 : 1.0);
        if (_i == ESTIMATOR_BIDIRECTIONAL)
            estimator_set(&estimators, ESTIMATOR_BIDIRECTIONAL, 1.0, 0.0, 0.0);
        generation(&estimators);
    }
    printf("a blind estimator's weight: %.5f\n", estimators.combination.weight[_i]);
    ck_assert_double_lt(estimators.combination.weight[_i], 0.01);
    estimators_destroy(&estimators);
}
END_TEST

/* An estimator without samples in a generation has weight zero, and the others share its weight. Before variances are
 * known, path tracing's weight is proportional to a fraction of its work, and that of chains and of the pool to the
 * pool's work: in difficult light path tracing is far worse than the others, and in large images it makes up most of
 * the early work. */
START_TEST(test_absent)
{
    Estimators estimators;
    const double pool[ESTIMATOR_COUNT] = {[ESTIMATOR_POOL] = 1.0}, paths[ESTIMATOR_COUNT] = {[ESTIMATOR_PATHS] = 2.0};
    const double part = 0.25 * estimators_work(paths);
    estimators_init(&estimators);
    for (int g = 0; g < 6; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, 1.0);
        if (g == _i) {
            film_clear(&estimators.films[ESTIMATOR_PATHS]);
            estimators.films[ESTIMATOR_PATHS].light_samples = 0;
        }
        ck_assert_double_eq_tol(generation(&estimators), 1.0, 0.08);
        const double *weight = estimators.combination.weight;
        ck_assert_double_eq_tol(weight[0] + weight[1] + weight[2], 1.0, 1e-12);
        if (g == _i)
            ck_assert_double_eq(weight[ESTIMATOR_PATHS], 0.0);
        else if (g < 2)
            ck_assert_double_eq_tol(weight[ESTIMATOR_PATHS], part / (2.0 * estimators_work(pool) + part), 1e-12);
        else if (g > 2)
            ck_assert_double_gt(weight[ESTIMATOR_PATHS], 0.0);
    }
    estimators_destroy(&estimators);
}
END_TEST

/* If one estimator alone is shown, its weight is one, or zero in a generation in which it has no samples. */
START_TEST(test_alone)
{
    Estimators estimators;
    estimators_init(&estimators);
    estimators.combination.shown = 1 + ESTIMATOR_PATHS;
    for (int g = 0; g < 6; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, 1.0);
        if (g % 2 == 1)
            estimators.films[ESTIMATOR_PATHS].light_samples = 0;
        ck_assert_double_eq_tol(generation(&estimators), 1.0, 0.08);
        ck_assert_double_eq(estimators.combination.weight[ESTIMATOR_PATHS], g % 2 == 1 ? 0.0 : 1.0);
    }
    estimators_destroy(&estimators);
}
END_TEST

/* The difference of what path tracing finds alone, rare light included, from the image, over the generations in which
 * it is kept. */
START_TEST(test_paths_kept)
{
    Estimators estimators;
    CombinedImage image;
    PathsChange kept = {NULL, 0};
    Error error = {0};
    static double change[3 * PIXELS];
    int64_t more = 0;
    memset(change, 0, sizeof change);
    estimators_init(&estimators);
    Film *films = estimators.films;
    ck_assert(combined_image_init(&image, &films[ESTIMATOR_PATHS], &error));
    ck_assert(paths_change_init(&kept, 3 * PIXELS, &error));
    for (int g = 0; g < 4; ++g) {
        const double samples[ESTIMATOR_COUNT] = {4.0 * PIXELS, 1.0 * PIXELS, 2.0 * PIXELS};
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 2.0, 0.5);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 3.0, 1.0);
        rare_set(&estimators, (size_t)g, 5.0, 7.0);
        image.change = g != 2 ? &kept : NULL;
        for (size_t i = 0; i < 3 * PIXELS && g != 2; ++i)
            change[i] += (double)films[ESTIMATOR_PATHS].light_sums[i];
        combined_image_begin(&image, &estimators.combination, &estimators.combination, samples);
        for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s)
            combined_image_take(&image, (EstimatorKind)s, &films[s]);
        combined_image_finish(&image, &films[ESTIMATOR_PATHS]);
        for (size_t i = 0; i < 3 * PIXELS && g != 2; ++i)
            change[i] -= (double)films[ESTIMATOR_PATHS].light_sums[i];
        more += g != 2 ? (int64_t)samples[ESTIMATOR_PATHS] - (int64_t)image.worth : 0;
    }
    ck_assert_int_eq(kept.samples, more);
    for (size_t i = 0; i < 3 * PIXELS; ++i)
        TEST_NEAR((double)kept.values[i], change[i], 1e-6 * 0x1p34);
    paths_change_forget(&kept);
    ck_assert(kept.values == NULL && kept.samples == 0);
    combined_image_destroy(&image);
    estimators_destroy(&estimators);
}
END_TEST

/* Bright dots in one tile are expected in adjacent tiles as well, but not elsewhere. */
START_TEST(test_beside)
{
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < 20; ++g) {
        for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s)
            estimator_set(&estimators, s, 1.0, 1.0, 1.0);
        if (g % 4 == 0)
            estimators.films[ESTIMATOR_POOL].light_sums[0] += llrint(1000.0 * 0x1p30);
        generation(&estimators);
    }
    const CombinationTile *known = estimators.combination.known;
    double own = known[0].spread[ESTIMATOR_POOL], beside = known[5].spread[ESTIMATOR_POOL],
           elsewhere = known[15].spread[ESTIMATOR_POOL];
    printf("variance with dots %.3g, beside them %.3g, elsewhere %.3g\n", own, beside, elsewhere);
    ck_assert_double_gt(own, 1.5 * elsewhere);
    ck_assert_double_gt(beside, 1.5 * elsewhere);
    estimators_destroy(&estimators);
}
END_TEST

/* A single bright dot of the chains does not make its own variance small, which counts relative to the light there. */
START_TEST(test_dot)
{
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < 20; ++g) {
        for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s)
            estimator_set(&estimators, s, 1.0, 1.0, 1.0);
        for (size_t c = 0; g == 10 && c < 3; ++c)
            estimators.films[ESTIMATOR_CHAINS].light_sums[c] += llrint(1000.0 * 0x1p30);
        generation(&estimators);
    }
    const CombinationTile *known = estimators.combination.known;
    double own = known[0].spread[ESTIMATOR_CHAINS], elsewhere = known[15].spread[ESTIMATOR_CHAINS];
    printf("variance with a dot %.3g, elsewhere %.3g\n", own, elsewhere);
    ck_assert_double_gt(own, 20.0 * elsewhere);
    estimators_destroy(&estimators);
}
END_TEST

/* The plan gives time to the estimator with low variance: only path tracing, or only chains. The error of chains also
 * falls with the size of pools, so these get 0.45 of the time of both; path tracing gets its minimum, one twentieth. */
START_TEST(test_plan)
{
    Estimators estimators;
    estimators_init(&estimators);
    ck_assert_double_eq(combination_rates(&estimators.combination).paths, 0.0);
    for (int g = 0; g < 20; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, _i == 0 ? 10.0 : 1.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 10.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, _i == 0 ? 1.0 : 10.0);
        generation(&estimators);
    }
    StepRates rates = combination_rates(&estimators.combination);
    printf("plan: %.3f paths, %.3f samples of a pool for a step\n", rates.paths, rates.pool);
    ck_assert_int_eq(rates.paths > 10.0, _i == 0);
    if (_i == 1) {
        double steps = estimators_work((double[ESTIMATOR_COUNT]){[ESTIMATOR_CHAINS] = 1.0});
        double pool = estimators_work((double[ESTIMATOR_COUNT]){[ESTIMATOR_POOL] = rates.pool});
        double paths = estimators_work((double[ESTIMATOR_COUNT]){[ESTIMATOR_PATHS] = rates.paths});
        ck_assert_double_eq_tol(paths / (steps + pool + paths), 0.05, 1e-6);
        ck_assert_double_eq_tol(pool / (steps + pool), 0.45, 0.05);
    }
    estimators_destroy(&estimators);
}
END_TEST

/* An image whose right half is a hundred times darker than its left half: far from the border, the ratio of importance
 * is the square root of that, apart from a minimum of light that each place is assumed to have, and the mean
 * contribution weight of paths stays the same. Without light, importance is uniform. */
START_TEST(test_importance)
{
    Estimators estimators;
    float importance[IMPORTANCE_CELLS];
    double sum = 0.0, weighted = 0.0, least = 0.05 * 0.505;
    estimators_init(&estimators);
    for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s) {
        estimator_set(&estimators, s, 1.0, 0.0, 0.0);
        for (size_t i = 0; i < 3 * PIXELS; ++i)
            estimators.films[s].light_sums[i] = (i / 3 % SIDE < SIDE / 2 ? 100 : 1) * (1ll << 22);
    }
    importance_learn(&estimators.combination, importance);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        ck_assert_float_eq(importance[i], 1.0f);
    generation(&estimators);
    generation(&estimators);
    importance_learn(&estimators.combination, importance);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        uint column = i % IMPORTANCE_SIDE;
        ck_assert_float_eq(importance[i], importance[column]); /* all rows are equal */
        ck_assert(column == 0 || importance[i] >= importance[i - 1]);
    }
    ck_assert_double_eq_tol((double)importance[IMPORTANCE_SIDE - 1] / (double)importance[0],
                            sqrt((1.0 + least) / (0.01 + least)), 0.01);
    for (size_t i = 0; i < IMPORTANCE_CELLS; ++i) {
        double light = i % IMPORTANCE_SIDE < IMPORTANCE_SIDE / 2 ? 1.0 : 0.01;
        sum += light;
        weighted += light * (double)importance[i];
    }
    ck_assert_double_eq_tol(weighted / sum, 1.0, 0.1);
    estimators_destroy(&estimators);
}
END_TEST

/* Pools visit where the error is: the image has four columns of tiles, the last with ten times the standard deviation
 * of the others. Visits are proportional to the root of the square error, four on average but at least one each. The
 * adjacent column is assumed to have a third of that square error (mmlt/combination_learn.c). If pools already visited
 * a column more often, the same error means a larger variance per visit. Without data, visits are uniform. */
START_TEST(test_visits)
{
    Estimators estimators;
    Error error = {0};
    double samples[ESTIMATOR_COUNT] = {1.0, 1.0, 1.0}, visited[IMPORTANCE_CELLS];
    uint visits[IMPORTANCE_CELLS + 1];
    estimators_init(&estimators);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        visited[i] = _i == 0 || i % IMPORTANCE_SIDE < 24 ? 1.0 : 4.0;
    ck_assert(importance_visits(&estimators.combination, samples, visited, visits, &error));
    ck_assert_uint_eq(visits[IMPORTANCE_CELLS], 0);
    for (int g = 0; g < 20; ++g) {
        for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s) {
            estimator_set(&estimators, s, 1.0, 1.0, 0.1);
            for (size_t i = 0; i < 3 * PIXELS; ++i)
                if (i / 3 % SIDE >= 24)
                    estimators.films[s].light_sums[i] = llrint((1.0 + noise(&estimators)) * 0x1p30);
        }
        generation(&estimators);
    }
    ck_assert(importance_visits(&estimators.combination, samples, visited, visits, &error));
    double columns[4] = {0.0}, all = (double)visits[IMPORTANCE_CELLS] / (double)PIXELS, mean = 0.0, sum = 0.0;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) { /* a cell is a pixel */
        double each = visits[i + 1] - visits[i];
        ck_assert(each >= 1.0 && each <= VISITS_MOST);
        ck_assert_double_eq_tol(importance_density_ratio(&estimators.combination, visits, i) * each, all, 1e-9);
        columns[i % IMPORTANCE_SIDE / 8] += each / (all * (double)PIXELS / 4.0);
    }
    /* The prior's two generations beside 19 degrees of freedom have the variance of the median tile, 34. */
    const double far = sqrt((19.0 + 2.0 * 34.0) / 21.0), near = sqrt((1900.0 + 2.0 * 34.0) / 21.0);
    const double deviations[4] = {far, far, sqrt(34.0), _i == 0 ? near : 2.0 * near};
    for (int i = 0; i < 4; ++i)
        mean += deviations[i] / 4.0;
    for (int i = 0; i < 4; ++i)
        sum += fmax(4.0 * deviations[i] / mean, 1.0) / 4.0;
    for (int i = 0; i < 4; ++i) {
        printf("visits of column %d: %.3f times the mean\n", i, columns[i]);
        ck_assert_double_eq_tol(columns[i], fmax(4.0 * deviations[i] / mean, 1.0) / sum, 0.15);
    }
    estimators_destroy(&estimators);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("combination");
    TCase *tcase = tcase_create("combination");
    tcase_add_test(tcase, test_weights);
    tcase_add_loop_test(tcase, test_stratified, 0, 4);
    tcase_add_test(tcase, test_correlated);
    tcase_add_loop_test(tcase, test_blind, ESTIMATOR_POOL, ESTIMATOR_COUNT);
    tcase_add_loop_test(tcase, test_absent, 0, 6);
    tcase_add_test(tcase, test_alone);
    tcase_add_test(tcase, test_paths_kept);
    tcase_add_test(tcase, test_beside);
    tcase_add_test(tcase, test_dot);
    tcase_add_loop_test(tcase, test_plan, 0, 2);
    tcase_add_test(tcase, test_importance);
    tcase_add_loop_test(tcase, test_visits, 0, 2);
    suite_add_tcase(suite, tcase);
    suite_add_tcase(suite, combination_few_tests());
    suite_add_tcase(suite, combination_rare_tests());
    suite_add_tcase(suite, combination_known_tests());
    suite_add_tcase(suite, combination_bidirectional_tests());
    return test_run(suite);
}
