/* Bidirectional path tracing as a fourth estimator: its weights, what its generations count, and how much of it a plan
 * has. */
#include "mmlt/test_combination_model.h"

#include "mmlt/plan.h"
#include "mmlt/tuning.h"

#define ROUNDS 20

static double own_variance(const CombinationTile *tile, const double samples[ESTIMATOR_COUNT])
{
    return tile->spread[ESTIMATOR_BIDIRECTIONAL] / samples[ESTIMATOR_BIDIRECTIONAL];
}

/* The least variance of a tile without it. */
static double others_variance(const Combination *combination, const CombinationTile *tile,
                              const double samples[ESTIMATOR_COUNT], double factor)
{
    double w, c;
    bool paths = samples[ESTIMATOR_PATHS] > 0.0;
    const TileTerms terms = {tile, samples, paths ? rare_weight(combination, tile, samples, factor) : 0.0,
                             combination->chains_correlation};
    return paths ? least_variance(&terms, &w, &c) : combined_variance(&terms, 0.0, weight_search(&terms, false, 0.0));
}

/* Its largest weight: that with which the errors of all tiles together, relative to their light, are least. */
static double weight_most(const Combination *combination, const double samples[ESTIMATOR_COUNT], double factor)
{
    double own = 0.0, others = 0.0, dark = dark_square(combination);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        const CombinationTile tile = tile_with(combination, i, factor);
        double square = tile.light * tile.light + dark;
        own += own_variance(&tile, samples) / square;
        others += others_variance(combination, &tile, samples, factor) / square;
    }
    return others / (own + others);
}

/* The picture's error with it: its weight in a tile is that of least variance, if that is no more. direct: of all
 * light. */
static double error_with(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                         const double costs[ESTIMATOR_COUNT], bool direct)
{
    double sum = 0.0, dark = dark_square(combination), factor = chains_vary(combination, samples, costs),
           most = samples[ESTIMATOR_BIDIRECTIONAL] > 0.0 ? weight_most(combination, samples, factor) : 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        const CombinationTile tile = tile_with(combination, i, factor);
        double others = others_variance(combination, &tile, samples, factor),
               own = most > 0.0 ? own_variance(&tile, samples) : 0.0,
               w = most > 0.0 ? fmin(others / (own + others), most) : 0.0;
        sum += (w * w * own + (1.0 - w) * (1.0 - w) * others +
                (direct ? tile.direct / (samples[ESTIMATOR_PATHS] + samples[ESTIMATOR_BIDIRECTIONAL]) : 0.0)) /
               (tile.light * tile.light + dark);
    }
    return sum;
}

static void costs_set(double costs[ESTIMATOR_COUNT])
{
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        costs[s] = estimator_cost((EstimatorKind)s);
}

/* ---- weights ----------------------------------------------------------------------------------------------------- */

/* Shows a picture of ones by bidirectional path tracing, and of nothing by the others. */
static void ones_combine(Known *pupil, Known *teacher, const double samples[ESTIMATOR_COUNT])
{
    Known others[3];
    Film *films[ESTIMATOR_COUNT] = {&pupil->film, &others[0].film, &others[1].film, &others[2].film};
    for (unsigned k = 0; k < 3; ++k)
        known_init(&others[k], 100 + k);
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        films[s]->light_samples = (uint64_t)samples[s];
    for (size_t i = 0; i < 3 * PIXELS; ++i)
        others[2].film.light_sums[i] = llrint(samples[ESTIMATOR_BIDIRECTIONAL] / PIXELS * 0x1p20);
    films_combine(&pupil->combination, &teacher->combination, films);
    for (int k = 0; k < 3; ++k)
        known_destroy(&others[k]);
}

/* Case 0: the weight of least variance in the tile, or in all tiles together if that is less. 1: its variance is not
 * known, so its part of the work. 2: a trial, which is not shown. 3: nothing is known, and its part of the work is
 * relative to what chains, pool and path tracing have then. The others' weights are those without it, scaled. */
START_TEST(test_weights_bidirectional)
{
    const double samples[ESTIMATOR_COUNT] = {4.0 * PIXELS, 1.0 * PIXELS, 2.0 * PIXELS, 1.0 * PIXELS},
                 others[ESTIMATOR_COUNT] = {4.0 * PIXELS, 1.0 * PIXELS, 2.0 * PIXELS};
    double costs[ESTIMATOR_COUNT], capped = 0.0;
    Known teacher, pupil;
    known_init(&teacher, 1);
    known_init(&pupil, 2);
    costs_set(costs);
    Combination *all = &teacher.combination;
    all->ready[ESTIMATOR_BIDIRECTIONAL] = _i == 0 || _i == 2;
    all->bidirectional_trial = _i == 2;
    all->ready[ESTIMATOR_CHAINS] = _i != 3;
    combination_weights_set(all, others);
    CombinationTile *before = malloc(combination_tile_count(all) * sizeof *before);
    ck_assert_ptr_nonnull(before);
    memcpy(before, all->known, combination_tile_count(all) * sizeof *before);
    const double work = costs[ESTIMATOR_BIDIRECTIONAL] * samples[ESTIMATOR_BIDIRECTIONAL],
                 pool = costs[ESTIMATOR_POOL] * samples[ESTIMATOR_POOL],
                 first = 2.0 * pool + FIRST_PATHS * costs[ESTIMATOR_PATHS] * samples[ESTIMATOR_PATHS],
                 most = weight_most(all, samples, 1.0);
    ones_combine(&pupil, &teacher, samples);
    for (size_t i = 0; i < PIXELS; ++i) {
        size_t at = combination_tile_of(all, i);
        const CombinationTile *tile = &all->known[at];
        double other = others_variance(all, tile, samples, 1.0), least = other / (own_variance(tile, samples) + other);
        const double expected[] = {fmin(least, most), work / estimators_work(samples), 0.0, work / (first + work)};
        TEST_NEAR(tile->weight[ESTIMATOR_BIDIRECTIONAL], expected[_i], 1e-6);
        for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s)
            TEST_NEAR(tile->weight[s], (1.0 - expected[_i]) * before[at].weight[s], 1e-6);
        TEST_NEAR((double)pupil.film.light_sums[3 * i] / (double)pupil.film.light_samples * PIXELS / 0x1p20,
                  expected[_i], 1e-5);
        capped += least > most;
    }
    TEST_NEAR(pixel_series_weight(&pupil.combination.direct, 0),
              samples[ESTIMATOR_PATHS] + (_i == 2 ? 0.0 : samples[ESTIMATOR_BIDIRECTIONAL]), 0.0);
    TEST_TRUE(capped > 0.1 * PIXELS && capped < 0.9 * PIXELS);
    free(before);
    known_destroy(&teacher);
    known_destroy(&pupil);
}
END_TEST

/* ---- what a generation counts ------------------------------------------------------------------------------------ */

/* A generation counts by its work times the error of the best division without bidirectional path tracing over its own,
 * whether it has any or not, so that those before and with it compare; with it no more than 4 times. Until its variance
 * is known it counts by its work. */
START_TEST(test_worth_bidirectional)
{
    Known known;
    double costs[ESTIMATOR_COUNT];
    int most = 0;
    known_init(&known, 41);
    costs_set(costs);
    Combination *all = &known.combination;
    for (int round = 0; round < ROUNDS; ++round) {
        double samples[ESTIMATOR_COUNT] = {4.0 * PIXELS, 2.0 * PIXELS, 3.0 * PIXELS, round % 2 ? 0.0 : 2.0 * PIXELS};
        double work = estimators_work(samples), best[ESTIMATOR_COUNT], other = 0.0, own = 0.0;
        known_tell(&known, 3.0);
        if (round % 4 == 0)
            for (size_t i = 0; i < combination_tile_count(all); ++i)
                all->known[i].spread[ESTIMATOR_BIDIRECTIONAL] *= round % 8 == 0 ? 1e-3 : 1e3;
        all->ready[ESTIMATOR_BIDIRECTIONAL] = false;
        StepRates rates = combination_rates(all);
        best[ESTIMATOR_CHAINS] = 1.0;
        best[ESTIMATOR_POOL] = rates.pool;
        best[ESTIMATOR_PATHS] = rates.paths;
        best[ESTIMATOR_BIDIRECTIONAL] = 0.0;
        double scale = work / estimators_work(best), part = costs[3] * samples[3];
        for (int s = 0; s < ESTIMATOR_COUNT; ++s)
            best[s] *= scale;
        double unknown = samples[3] > 0.0 ? FIRST_WORTH * (work - part) + part : 0.0;
        if (samples[3] > 0.0)
            TEST_NEAR((double)combination_weights_set(all, samples), unknown, 1.0);
        all->ready[ESTIMATOR_BIDIRECTIONAL] = true;
        combination_rates(all);
        other = error_with(all, best, costs, false);
        own = error_with(all, samples, costs, false);
        double limit = samples[3] > 0.0 ? 4.0 : 2.0, expected = work * fmin(other / own, limit);
        most += other / own > limit;
        TEST_NEAR((double)combination_weights_set(all, samples) / expected, 1.0, 1e-4);
    }
    TEST_TRUE(most > 0);
    known_destroy(&known);
}
END_TEST

/* ---- plans ------------------------------------------------------------------------------------------------------- */

/* Parts of the work by the best plan with bidirectional path tracing: twentieths, of which chains and pool divide what
 * is left as without. */
static double plan_search(const Combination *combination, const double costs[ESTIMATOR_COUNT],
                          const double without[ESTIMATOR_COUNT], double best[ESTIMATOR_COUNT])
{
    double least = HUGE_VAL, chains = costs[0] * without[0], part = chains / (chains + costs[1] * without[1]);
    for (int own = 1; own < 19; ++own)
        for (int paths = 1; own + paths < 20; ++paths) {
            double rest = 20.0 - own - paths;
            const double samples[ESTIMATOR_COUNT] = {part * rest / costs[0], (1.0 - part) * rest / costs[1],
                                                     paths / costs[2], own / costs[3]};
            double error = error_with(combination, samples, costs, true);
            if (error < least) {
                least = error;
                memcpy(best, samples, ESTIMATOR_COUNT * sizeof *best);
            }
        }
    return least;
}

/* A plan has it if that makes the error at least a quarter smaller, or a twentieth if light comes through openings. */
START_TEST(test_plan_bidirectional)
{
    Known known;
    double costs[ESTIMATOR_COUNT];
    int with = 0;
    known_init(&known, 51);
    known.combination.tiles[0] = 2; /* only two tiles, so that plans are searched quickly */
    known.combination.tiles[1] = 1;
    costs_set(costs);
    Combination *all = &known.combination;
    all->opened = _i == 1;
    for (int round = 0; round < ROUNDS; ++round) {
        double best[ESTIMATOR_COUNT] = {0.0}, without[ESTIMATOR_COUNT];
        known_tell(&known, 2.0);
        for (size_t i = 0; i < combination_tile_count(all); ++i)
            all->known[i].spread[ESTIMATOR_BIDIRECTIONAL] *= round % 2 == 0 ? 0.125 : 16.0;
        all->ready[ESTIMATOR_BIDIRECTIONAL] = false;
        all->bidirectional_better = true;
        StepRates rates = combination_rates(all);
        TEST_TRUE(rates.bidirectional == 0.0 && !all->bidirectional_better);
        memcpy(without, all->best, sizeof without);
        all->ready[ESTIMATOR_BIDIRECTIONAL] = true;
        rates = combination_rates(all);
        double least = plan_search(all, costs, without, best), error = picture_error(all, without, costs);
        const double part = _i == 0 ? 0.75 : 0.95;
        TEST_TRUE(all->bidirectional_better == (least < part * error));
        if (least < part * error) {
            TEST_NEAR(rates.bidirectional, best[3] / best[0], 1e-9);
            TEST_NEAR(rates.paths, best[2] / best[0], 1e-9);
            TEST_NEAR(rates.pool, best[1] / best[0], 1e-9);
            ++with;
        } else {
            TEST_TRUE(rates.bidirectional == 0.0);
            TEST_NEAR(rates.paths, without[2] / without[0], 1e-9);
        }
    }
    printf("a plan has bidirectional path tracing %d times of %d\n", with, ROUNDS);
    TEST_TRUE(with >= ROUNDS / 4 && with <= 3 * ROUNDS / 4);
    known_destroy(&known);
}
END_TEST

/* Where light comes through openings it has three quarters of the work at least, until it is compared; then what is
 * best, or nothing. A plan of so many samples ends with about that much work, and its last generation has no more whole
 * samples than there is time for. */
START_TEST(test_plan_first)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, PIXELS * 64);
    TEST_TRUE(plan.rates.bidirectional == 0.0);
    plan_bidirectional_set(&plan, true, false);
    const double step[ESTIMATOR_COUNT] = {1.0, plan.rates.pool, plan.rates.paths, plan.rates.bidirectional};
    TEST_NEAR(estimator_cost(ESTIMATOR_BIDIRECTIONAL) * step[3] / estimators_work(step), 0.75, 1e-9);
    plan.rates.bidirectional *= 2.0;
    const double rate = plan.rates.bidirectional;
    plan_bidirectional_set(&plan, true, true);
    TEST_TRUE(plan.rates.bidirectional == rate);
    plan_bidirectional_set(&plan, false, true);
    TEST_TRUE(plan.rates.bidirectional == rate);
    plan_bidirectional_set(&plan, false, false);
    TEST_TRUE(plan.rates.bidirectional == 0.0);
}
END_TEST

/* Half a second is left for a generation of which a whole sample takes three quarters; then two. */
START_TEST(test_plan_time)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    const double sample = estimator_cost(ESTIMATOR_BIDIRECTIONAL) * PIXELS;
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    plan.rates = (StepRates){.paths = 0.1, .pool = 0.1, .bidirectional = 1.0};
    plan.chains = (uint)(PIXELS / STEPS_DEFAULT);
    plan.last = (uint64_t)sample; /* which took 0.75 s */
    plan.done = 100 * plan.last;
    for (int k = 0; k < 2; ++k) {
        Plan next = plan;
        next.owed_bidirectional = k == 0 ? 0.3 : 1.3;
        double expected = k == 0 ? 0.0 : 2.0, left = k == 0 ? 0.5 : 1.6;
        TEST_TRUE(plan_fit(&next, 0.75, 0.0, left, 100.0));
        TEST_TRUE(next.bidirectional_most == expected);
        double due = rint(next.owed_bidirectional + plan_bidirectional_samples(&next, next.chains));
        TEST_TRUE(due <= expected);
        double steps = (double)next.chains * STEPS_DEFAULT,
               work = estimators_work((const double[ESTIMATOR_COUNT]){steps, 0.1 * steps, 0.1 * steps}) + due * sample;
        TEST_TRUE(work * 0.75 / sample <= left && next.chains >= 1);
        plan_next(&next, 6, 0.75, 100.0);
        TEST_TRUE(next.bidirectional_most > DBL_MAX);
    }
}
END_TEST

TCase *combination_bidirectional_tests(void)
{
    TCase *tcase = tcase_create("bidirectional");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_weights_bidirectional, 0, 4);
    tcase_add_test(tcase, test_worth_bidirectional);
    tcase_add_loop_test(tcase, test_plan_bidirectional, 0, 2);
    tcase_add_test(tcase, test_plan_first);
    tcase_add_test(tcase, test_plan_time);
    return tcase;
}
