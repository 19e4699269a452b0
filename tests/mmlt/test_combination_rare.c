/* Light above the clamping thresholds, which chains show: the excess of pools, and the rare light of path tracing. */
#include "mmlt/test_combination_estimators.h"

#include "base/sample_statistics.h"
#include "mmlt/combination_variances.h"
#include "mmlt/tuning.h"

/* The excess that chains show goes with chains and pool, not with path tracing. */
START_TEST(test_excess)
{
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < 6; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 0.1);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 0.1);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 3.0, 0.1);
        for (size_t i = 0; i < 3 * PIXELS; ++i)
            estimators.films[ESTIMATOR_CHAINS].sums[i] = llrint(4.0 * 2.0 * 0x1p30);
        ck_assert_double_eq_tol(generation(&estimators), 3.0, 0.02);
    }
    estimators_destroy(&estimators);
}
END_TEST

/* Rare light that chains and path tracing both find: each counts by its variance, the chains' by twice that (_i 0),
 * also where path tracing has not found it, whose variance is then that of finding it once (_i 1). */
START_TEST(test_rare)
{
    Estimators estimators;
    double mean = 0.0;
    estimators_init(&estimators);
    for (int g = 0; g < 60; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 3.0, 3.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 3.0, 3.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, 0.1);
        for (size_t i = 0; i < PIXELS; ++i) {
            double found = 2.0 + noise(&estimators) / sqrt(4.0),
                   own = _i == 1 ? 0.0 : 2.0 + sqrt(2.0) * noise(&estimators) / sqrt(2.0);
            rare_set(&estimators, i, found, own);
        }
        mean = generation(&estimators);
    }
    double rare = estimators.combination.paths_rare;
    printf("rare light: weight of path tracing %.3f, its own part %.3f, mean %.3f\n",
           estimators.combination.weight[ESTIMATOR_PATHS], rare, mean);
    ck_assert_double_eq_tol(mean, 3.0, _i == 1 ? 0.1 : 0.05);
    if (_i == 1)
        ck_assert_double_lt(rare, 0.02);
    else
        ck_assert_double_eq_tol(rare, 0.5 / (0.5 + 1.0), 0.02);
    /* Chains and pool: 1 / (4/9 + 1/9); path tracing: .01 / 2 and rare light of the variance (1 - rare)^2 / 4 + rare^2,
     * of the covariance with the chains' .8 times (1 - rare) / 4. */
    double chains = 1.8, own = 0.005 + (_i == 1 ? 0.25 : 2.0 / 9.0), both = _i == 1 ? 0.2 : 0.2 * 2.0 / 3.0;
    ck_assert_double_eq_tol(estimators.combination.weight[ESTIMATOR_PATHS],
                            (chains - both) / (chains + own - 2.0 * both), 0.01);
    estimators_destroy(&estimators);
}
END_TEST

/* Path tracing's own rare light has many fireflies in a few tiles and none elsewhere, where its stated variance is
 * small: it has no weight there either. */
START_TEST(test_fireflies)
{
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < 20; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 1.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 1.0, 1.0);
        for (size_t i = 0; i < PIXELS; ++i) {
            double found = 0.1 + 0.1 * noise(&estimators), own = 0.1 + 0.01 * noise(&estimators);
            if (i % SIDE < 4 && i / SIDE == 4 * ((size_t)g % 4)) /* each time in another patch */
                own += 100.0;
            rare_set(&estimators, i, found, own);
        }
        generation(&estimators);
    }
    printf("fireflies: weight of path tracing's rare light %.5f\n", estimators.combination.paths_rare);
    ck_assert_double_lt(estimators.combination.paths_rare, 0.01);
    estimators_destroy(&estimators);
}
END_TEST

/* Path tracing finds none of the rare light, which is half of all (_i 0 and 4), all of it (1), all but 4 % (2) or
 * all but 1.5 % (3), and states hardly any variance. No tile tells so: the chains' errors there are large. In the whole
 * image they are small (_i 0, 1 and 3), or alike in all tiles (2), so that the 4 % are not significant; and the 1.5 % of
 * the rare light do not matter, although some tiles seem to have missed light and rely on chains. In the last case they
 * are so large that not even all of it is significant. Where path tracing misses light, or may miss much, its own has
 * no weight, and it is never alone. */
START_TEST(test_rare_missed)
{
    static const struct {
        double found, common, deviation;
        bool trusted;
    } cases[] = {{0.0, 0.0, 0.8, false},
                 {1.0, 0.0, 0.8, true},
                 {0.96, 0.13, 0.8, true},
                 {0.985, 0.0, 0.2, true},
                 {0.0, 2.0, 0.8, false}};
    Estimators estimators;
    estimators_init(&estimators);
    for (int g = 0; g < 20; ++g) {
        double common = g % 2 == 0 ? cases[_i].common : -cases[_i].common;
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 3.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 3.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 0.5, 0.1);
        for (size_t i = 0; i < PIXELS; ++i)
            rare_set(&estimators, i, 0.5 * (1.0 + common) + cases[_i].deviation * noise(&estimators),
                     0.5 * cases[_i].found + 0.01 * noise(&estimators));
        generation(&estimators);
    }
    combination_rates(&estimators.combination);
    double weight = estimators.combination.paths_rare, alone = combination_alone_error(&estimators.combination);
    printf("rare light missed, %d: weight of path tracing's own %.3f, alone %.3g times the error\n", _i, weight, alone);
    if (cases[_i].trusted)
        ck_assert(weight > 0.9 && (weight < 0.995) == (cases[_i].found < 1.0) && alone < 2.0);
    else
        ck_assert(weight == 0.0 && alone > DBL_MAX);
    estimators_destroy(&estimators);
}
END_TEST

/* Path tracing that is trusted with rare light, as where it draws by photons at all receivers, shows all of it, alone,
 * until chains have had CHAINS_KNOWN generations, and then by its variance in each tile, also where light may be hidden
 * or chains have found more, and where fireflies in one tile make its variance in the whole image large. */
START_TEST(test_trusted)
{
    Estimators estimators;
    estimators_init(&estimators);
    estimators.combination.hidden = estimators.combination.paths_trusted = true;
    for (uint g = 0; g < 20; ++g) {
        estimator_set(&estimators, ESTIMATOR_CHAINS, 4.0, 1.0, 3.0);
        estimator_set(&estimators, ESTIMATOR_POOL, 1.0, 1.0, 3.0);
        estimator_set(&estimators, ESTIMATOR_PATHS, 2.0, 0.5, 0.1);
        for (size_t i = 0; i < PIXELS; ++i) {
            bool firefly = g % 4 == 0 && i == 0;
            rare_set(&estimators, i, 0.5 + 0.8 * noise(&estimators),
                     0.5 + 0.01 * noise(&estimators) + (firefly ? 1000.0 : 0.0));
        }
        generation(&estimators);
        const Combination *known = &estimators.combination;
        ck_assert(g >= CHAINS_KNOWN || (known->weight[ESTIMATOR_PATHS] == 1.0 && known->paths_rare == 1.0));
    }
    combination_rates(&estimators.combination);
    double rare = estimators.combination.paths_rare;
    printf("trusted: weight of rare light, without that of one of 16 tiles and those around it, %.3f\n", rare);
    ck_assert(rare > 0.7 && rare < 0.8);
    ck_assert_double_lt(combination_alone_error(&estimators.combination), DBL_MAX);
    estimators_destroy(&estimators);
}
END_TEST

/* Every generation of a replica has the same errors, those of the other replica are independent: of the variance that
 * either states, so many times are found between both, up to PERSISTENCE_MOST (_i 1). */
START_TEST(test_persistence)
{
    enum { GENERATIONS = 12 };
    const double deviation = 0.5, lasting = _i == 0 ? 0.1 : 1.0;
    const double found = 1.0 + lasting * lasting * 4.0 * GENERATIONS / (deviation * deviation);
    Estimators replicas[2];
    double ratios[(SIDE / TILE_SIDE) * (SIDE / TILE_SIDE)];
    for (uint r = 0; r < 2; ++r) {
        estimators_init(&replicas[r]);
        replicas[r].draws = r << 24;
    }
    for (uint g = 0; g < 2 * GENERATIONS; ++g) {
        Estimators *own = &replicas[g % 2];
        for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s)
            estimator_set(own, s, 4.0, 10.0, s == ESTIMATOR_CHAINS ? deviation : 100.0);
        const uint draws = own->draws;
        own->draws = (g % 2 << 24) + 0x800000u;
        for (size_t i = 0; i < PIXELS; ++i) {
            double error = 4.0 * lasting * noise(own);
            for (size_t c = 0; c < 3; ++c)
                own->films[ESTIMATOR_CHAINS].light_sums[3 * i + c] += llrint(error * 0x1p30);
        }
        own->draws = draws;
        Film *films[ESTIMATOR_COUNT] = {&own->films[0], &own->films[1], &own->films[2]};
        films_combine(&own->combination, &replicas[1 - g % 2].combination, films);
    }
    const CombinationTile *tiles = replicas[0].combination.known;
    const size_t count = combination_tile_count(&replicas[0].combination);
    combination_variances_update(&replicas[0].combination, &replicas[1].combination);
    for (size_t i = 0; i < count; ++i)
        ratios[i] = tiles[i].spread[ESTIMATOR_CHAINS];
    combination_variances_update(&replicas[0].combination, &replicas[0].combination);
    for (size_t i = 0; i < count; ++i)
        ratios[i] /= tiles[i].spread[ESTIMATOR_CHAINS];
    double factor = sample_quantile(ratios, count, 0.5); /* pools may seem to have more light in a tile */
    printf("persistence %.2f, expected %.2f, at most %.0f\n", factor, found, PERSISTENCE_MOST);
    ck_assert_double_eq_tol(factor, fmin(found, PERSISTENCE_MOST), _i == 0 ? 1.0 : 0.01 * PERSISTENCE_MOST);
    estimators_destroy(&replicas[0]);
    estimators_destroy(&replicas[1]);
}
END_TEST

TCase *combination_rare_tests(void)
{
    TCase *tcase = tcase_create("rare");
    tcase_add_test(tcase, test_excess);
    tcase_add_loop_test(tcase, test_rare, 0, 2);
    tcase_add_test(tcase, test_fireflies);
    tcase_add_loop_test(tcase, test_rare_missed, 0, 5);
    tcase_add_test(tcase, test_trusted);
    tcase_add_loop_test(tcase, test_persistence, 0, 2);
    return tcase;
}
