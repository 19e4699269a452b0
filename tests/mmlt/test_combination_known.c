/* Weights, errors, plans, importance and visits that a combination derives from given variances, against a search for
 * the optimum. */
#include "mmlt/test_combination_model.h"

#include "camera/film_sum.h"
#include "mmlt/combination_learn.h"
#include "mmlt/importance.h"
#include "mmlt/plan.h"
#include "mmlt/tuning.h"

#define ROUNDS 40

/* ---- weights ----------------------------------------------------------------------------------------------------- */

/* The estimator's value in a channel of pixel i, in units of the film: different for all estimators, channels and
 * adjacent pixels. */
static double estimator_value(int s, size_t i, size_t channel)
{
    return ldexp(1.0 + s * 3.0 + (double)(i % 7) + 20.0 * (double)channel, 20);
}

/* A generation is combined with the teacher's weights of least variance rather than the pupil's, in every pixel and
 * channel. An estimator without samples has weight zero, and its variances need not be known. Pixels with a full sum in
 * an estimator count as saturated. */
START_TEST(test_weights_known)
{
    Known teacher, pupil, others[2];
    double samples[ESTIMATOR_COUNT] = {4.0 * PIXELS, 1.0 * PIXELS, _i == 1 ? 0.0 : 2.0 * PIXELS};
    known_init(&teacher, 1);
    known_init(&pupil, 2);
    known_init(&others[0], 3);
    known_init(&others[1], 4);
    teacher.combination.hidden = _i == 3;
    if (_i == 1)
        teacher.combination.ready[ESTIMATOR_PATHS] = false;
    Film *const films[ESTIMATOR_COUNT] = {&pupil.film, &others[0].film, &others[1].film};
    for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s) {
        films[s]->light_samples = (uint64_t)samples[s];
        for (size_t i = 0; i < 3 * PIXELS; ++i)
            films[s]->light_sums[i] = llrint(samples[s] / PIXELS * estimator_value(s, i / 3, i % 3));
    }
    for (size_t i = 0; i < 3 * PIXELS; ++i) {
        pupil.film.sums[i] = llrint(4.0 * estimator_value(SERIES_EXCESS, i / 3, i % 3));
        pupil.film.rare_sums[i] = llrint(4.0 * estimator_value(SERIES_RARE, i / 3, i % 3));
        others[1].film.rare_sums[i] =
            llrint(samples[ESTIMATOR_PATHS] / PIXELS * estimator_value(SERIES_PATHS_RARE, i / 3, i % 3));
        others[1].film.light_sums[i] += others[1].film.rare_sums[i];
    }
    if (_i == 2)
        others[0].film.light_sums[3 * (PIXELS - 1)] = (int64_t)SUM_FULL;
    films_combine(&pupil.combination, &teacher.combination, films);
    double work = (double)pupil.film.light_samples / PIXELS;
    TEST_NEAR(work * PIXELS, FIRST_WORTH * estimators_work(samples), 1.0);
    for (size_t i = 0; i < (_i == 2 ? PIXELS - 1 : PIXELS); ++i) {
        const CombinationTile *tile = &teacher.combination.known[combination_tile_of(&teacher.combination, i)];
        double w = 0.0, v = _i == 1 ? 0.0 : rare_weight(&teacher.combination, tile, samples, 1.0);
        const TileTerms terms = {tile, samples, v, teacher.combination.chains_correlation};
        double c = weight_search(&terms, false, 0.0);
        if (_i != 1)
            least_variance(&terms, &w, &c);
        for (size_t k = 0; k < 3; ++k) {
            double expected =
                (1.0 - w) * (c * estimator_value(ESTIMATOR_CHAINS, i, k) +
                             (1.0 - c) * estimator_value(ESTIMATOR_POOL, i, k) + estimator_value(SERIES_EXCESS, i, k)) +
                w * (estimator_value(ESTIMATOR_PATHS, i, k) + v * estimator_value(SERIES_PATHS_RARE, i, k) +
                     (1.0 - v) * estimator_value(SERIES_RARE, i, k));
            TEST_NEAR((double)pupil.film.light_sums[3 * i + k] / work / expected, 1.0, 1e-6);
        }
    }
    ck_assert_uint_eq(pupil.film.saturated, _i == 2);
    known_destroy(&teacher);
    known_destroy(&pupil);
    known_destroy(&others[0]);
    known_destroy(&others[1]);
}
END_TEST

/* ---- errors and plans -------------------------------------------------------------------------------------------- */

/* The error of a tile is the least variance over the square of its light plus DARK_PART of the mean's square. */
START_TEST(test_errors_known)
{
    Known known;
    known_init(&known, 7);
    double errors[WIDTH * HEIGHT], samples[ESTIMATOR_COUNT] = {4000.0, 1000.0, 2000.0}, w, c;
    size_t tiles = combination_tile_count(&known.combination);
    known.combination.known[3].light = 0.0;
    combination_errors(&known.combination, samples, errors);
    for (size_t i = 0; i < tiles; ++i) {
        const CombinationTile *tile = &known.combination.known[i];
        const TileTerms terms = {tile, samples, rare_weight(&known.combination, tile, samples, 1.0),
                                 known.combination.chains_correlation};
        double expected =
            least_variance(&terms, &w, &c) / (tile->light * tile->light + dark_square(&known.combination));
        TEST_NEAR(errors[i] / expected, 1.0, 1e-6);
    }
    known_destroy(&known);
}
END_TEST

/* Among all divisions of the time into twentieths, and one that leaves chains and pool half of one each, the plan has
 * the least error. */
START_TEST(test_plan_known)
{
    Known known;
    double costs[ESTIMATOR_COUNT];
    known_init(&known, 11);
    known.combination.tiles[0] = 2; /* only two tiles, so that 172 plans are searched quickly */
    known.combination.tiles[1] = 1;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s) {
        double one[ESTIMATOR_COUNT] = {0.0};
        one[s] = 1.0;
        costs[s] = estimators_work(one);
    }
    for (int round = 0; round < ROUNDS; ++round) {
        double least = HUGE_VAL;
        StepRates best = {0};
        known_tell(&known, 4.0);
        for (int paths = 1; paths < 20; ++paths)
            for (int whole = 1; whole == 1 || paths + whole < 20; ++whole) {
                const double pool = paths < 19 ? whole : 0.5;
                double samples[ESTIMATOR_COUNT] = {(20.0 - paths - pool) / costs[ESTIMATOR_CHAINS],
                                                   pool / costs[ESTIMATOR_POOL], paths / costs[ESTIMATOR_PATHS]};
                double error = picture_error(&known.combination, samples, costs);
                if (error < least) {
                    least = error;
                    best = (StepRates){.paths = samples[ESTIMATOR_PATHS] / samples[ESTIMATOR_CHAINS],
                                       .pool = samples[ESTIMATOR_POOL] / samples[ESTIMATOR_CHAINS]};
                }
            }
        StepRates rates = combination_rates(&known.combination);
        TEST_NEAR(rates.paths, best.paths, 1e-9);
        TEST_NEAR(rates.pool, best.pool, 1e-9);
    }
    known_destroy(&known);
}
END_TEST

/* Path tracing alone shows its own rare light and has its own variance, direct light included, which is compared
 * with that of the best division of the same work. */
START_TEST(test_alone_known)
{
    Known known;
    double alone[ESTIMATOR_COUNT] = {0.0}, costs[ESTIMATOR_COUNT];
    known_init(&known, 31);
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        costs[s] = estimator_cost((EstimatorKind)s);
    for (int round = 0; round < ROUNDS; ++round) {
        double expected = 0.0, errors[WIDTH * HEIGHT];
        known_tell(&known, 3.0);
        Combination *combination = &known.combination;
        combination->best[ESTIMATOR_PATHS] = 0.0;
        TEST_TRUE(combination_alone_error(combination) > DBL_MAX);
        combination_rates(combination);
        combination->best[ESTIMATOR_CHAINS] *= 3.0; /* any division of work will do */
        alone[ESTIMATOR_PATHS] = estimators_work(combination->best) / costs[ESTIMATOR_PATHS];
        combination_errors(combination, alone, errors);
        for (size_t i = 0; i < combination_tile_count(combination); ++i) {
            const CombinationTile *tile = &combination->known[i];
            double square = tile->light * tile->light + dark_square(combination),
                   own = (tile->spread[ESTIMATOR_PATHS] + tile->spread[SERIES_PATHS_RARE]) / alone[ESTIMATOR_PATHS];
            TEST_NEAR(errors[i] * square / own, 1.0, 1e-6);
            expected += (own + tile->direct / alone[ESTIMATOR_PATHS]) / square;
        }
        double best = picture_error(combination, combination->best, costs);
        TEST_NEAR(combination_alone_error(combination) / (expected / best), 1.0, 1e-6);
        combination->hidden = true;
        TEST_TRUE(combination_alone_error(combination) > DBL_MAX);
        combination->hidden = false;
        TEST_TRUE(combination_weights_set(combination, alone) >= 1);
        for (size_t i = 0; i < combination_tile_count(combination); ++i)
            TEST_TRUE(combination->known[i].weight[ESTIMATOR_PATHS] == 1.0 && combination->known[i].paths_rare == 1.0);
    }
    known_destroy(&known);
}
END_TEST

/* Once a plan is known, a generation counts by its work times the error of the plan's division over that of its own,
 * direct light left out: also one without path tracing, which may count twice at most. */
START_TEST(test_worth_known)
{
    Known teacher, pupil, others[2];
    double costs[ESTIMATOR_COUNT], w, c;
    known_init(&teacher, 21);
    known_init(&pupil, 22);
    known_init(&others[0], 23);
    known_init(&others[1], 24);
    for (int s = 0; s < ESTIMATOR_COUNT; ++s) {
        double one[ESTIMATOR_COUNT] = {0.0};
        one[s] = 1.0;
        costs[s] = estimators_work(one);
    }
    for (int round = 0; round < ROUNDS; ++round) {
        known_tell(&teacher, 4.0);
        StepRates rates = combination_rates(&teacher.combination);
        double samples[ESTIMATOR_COUNT] = {4.0 * PIXELS, floor(octaves(&teacher, 2.0) * PIXELS),
                                           round % 2 == 0 ? 0.0 : floor(octaves(&teacher, 2.0) * PIXELS)};
        double best[ESTIMATOR_COUNT] = {1.0, rates.pool, rates.paths}, errors[2] = {0.0};
        double scale = estimators_work(samples) / estimators_work(best), dark = dark_square(&teacher.combination);
        for (int s = 0; s < ESTIMATOR_COUNT; ++s)
            best[s] *= scale;
        for (size_t i = 0; i < combination_tile_count(&teacher.combination); ++i)
            for (int k = 0; k < 2; ++k) {
                const double *of = k == 0 ? best : samples;
                double factor = chains_vary(&teacher.combination, of, costs);
                const CombinationTile tile = tile_with(&teacher.combination, i, factor);
                bool paths = of[ESTIMATOR_PATHS] > 0.0;
                const TileTerms terms = {&tile, of, paths ? rare_weight(&teacher.combination, &tile, of, factor) : 0.0,
                                         teacher.combination.chains_correlation};
                double least = paths ? least_variance(&terms, &w, &c)
                                     : combined_variance(&terms, 0.0, weight_search(&terms, false, 0.0));
                errors[k] += least / (tile.light * tile.light + dark);
            }
        Film *const films[ESTIMATOR_COUNT] = {&pupil.film, &others[0].film, &others[1].film};
        for (int s = 0; s < ESTIMATOR_BIDIRECTIONAL; ++s)
            films[s]->light_samples = (uint64_t)samples[s];
        films_combine(&pupil.combination, &teacher.combination, films);
        double expected = estimators_work(samples) * fmin(errors[0] / errors[1], 2.0);
        TEST_NEAR((double)pupil.film.light_samples, expected, 0.5 + 1e-6 * expected); /* a whole number */
    }
    known_destroy(&teacher);
    known_destroy(&pupil);
    known_destroy(&others[0]);
    known_destroy(&others[1]);
}
END_TEST

/* The rates of the least error become the plan's after the second generation of a pair, so that both have the same. */
START_TEST(test_rates_adopted)
{
    Known known;
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    Plan plan;
    known_init(&known, 29);
    StepRates best = combination_rates(&known.combination);
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, PIXELS * 16);
    const StepRates first = plan.rates;
    plan_learn(&plan, 2, &known.combination);
    TEST_TRUE(plan.rates.paths == first.paths && plan.rates.pool == first.pool && first.paths != best.paths);
    plan_learn(&plan, 3, &known.combination);
    TEST_TRUE(plan.rates.paths == best.paths && plan.rates.pool == fmax(best.pool, POOL_PER_STEP));
    known_destroy(&known);
}
END_TEST

/* ---- importance and visits --------------------------------------------------------------------------------------- */

static uint cell_of(size_t x, size_t y)
{
    return (uint)(y * IMPORTANCE_SIDE / HEIGHT * IMPORTANCE_SIDE + x * IMPORTANCE_SIDE / WIDTH);
}

/* Whether tile and cell overlap along an axis of `size` pixels. */
static bool tile_meets(int tile, int cell, int size)
{
    double begin = (double)cell * size / IMPORTANCE_SIDE, end = (double)(cell + 1) * size / IMPORTANCE_SIDE;
    return tile * TILE_SIDE < end && (tile + 1) * TILE_SIDE > begin;
}

static bool tile_near(int tile, int cell, int size)
{
    return tile_meets(tile - 1, cell, size) || tile_meets(tile, cell, size) || tile_meets(tile + 1, cell, size);
}

/* Importance is (L + 0.05 mean)^(-1/2), where L is the light per pixel of the tiles that the cell overlaps and their
 * neighbours, scaled so that the sum of L times importance equals the sum of L. */
START_TEST(test_importance_known)
{
    Known known;
    float importance[IMPORTANCE_CELLS];
    double light[IMPORTANCE_CELLS], sum = 0.0, weighted = 0.0;
    known_init(&known, 13);
    importance_learn(&known.combination, importance);
    for (int cell = 0; cell < (int)IMPORTANCE_CELLS; ++cell) {
        double all = 0.0, pixels = 0.0;
        for (int y = 0; y < known.combination.tiles[1]; ++y)
            for (int x = 0; x < known.combination.tiles[0]; ++x)
                if (tile_near(x, cell % (int)IMPORTANCE_SIDE, WIDTH) &&
                    tile_near(y, cell / (int)IMPORTANCE_SIDE, HEIGHT)) {
                    all += known.combination.known[y * known.combination.tiles[0] + x].light;
                    pixels += TILE_SIDE * (y * TILE_SIDE + TILE_SIDE <= HEIGHT ? TILE_SIDE : HEIGHT % TILE_SIDE);
                }
        sum += light[cell] = all / pixels;
    }
    for (uint cell = 0; cell < IMPORTANCE_CELLS; ++cell)
        weighted += light[cell] / sqrt(light[cell] + 0.05 * sum / IMPORTANCE_CELLS);
    for (uint cell = 0; cell < IMPORTANCE_CELLS; ++cell)
        TEST_NEAR(importance[cell], sum / weighted / sqrt(light[cell] + 0.05 * sum / IMPORTANCE_CELLS), 1e-5);
    known_destroy(&known);
}
END_TEST

/* A cell's pixels have round(4 v / mean v) visits each, at least one and at most VISITS_MOST, where v is the root of
 * `visited` times the mean error of the tiles that contain its pixels. The density ratio is the mean number of visits
 * over the cell's; that of a tile is the mean over its pixels. */
START_TEST(test_visits_known)
{
    Known known;
    Error error = {0};
    double errors[WIDTH * HEIGHT], samples[ESTIMATOR_COUNT] = {4000.0, 1000.0, 2000.0}, visited[IMPORTANCE_CELLS];
    double deviation[IMPORTANCE_CELLS], sum = 0.0;
    uint visits[IMPORTANCE_CELLS + 1], pixels[IMPORTANCE_CELLS] = {0};
    known_init(&known, 17);
    known.combination.ready[ESTIMATOR_BIDIRECTIONAL] = true;
    for (int s = 0; _i == 1 && s < SERIES_COUNT; ++s)
        known.combination.known[5].spread[s] = 1e6; /* one tile has nearly all of the error */
    combination_errors(&known.combination, samples, errors);
    for (uint cell = 0; cell < IMPORTANCE_CELLS; ++cell) {
        double mean = 0.0;
        int tiles = 0;
        bool seen[WIDTH * HEIGHT] = {false};
        visited[cell] = octaves(&known, 2.0);
        for (size_t i = 0; i < PIXELS; ++i) {
            size_t tile = combination_tile_of(&known.combination, i);
            if (cell_of(i % WIDTH, i / WIDTH) != cell)
                continue;
            ++pixels[cell];
            mean += seen[tile] ? 0.0 : errors[tile];
            tiles += !seen[tile];
            seen[tile] = true;
        }
        deviation[cell] = sqrt(mean / tiles * visited[cell]);
        sum += pixels[cell] * deviation[cell] / PIXELS;
    }
    ck_assert(importance_visits(&known.combination, samples, visited, visits, &error));
    uint all = visits[IMPORTANCE_CELLS], next = 0, most = 0;
    for (uint cell = 0; cell < IMPORTANCE_CELLS; ++cell) {
        double each = fmin(fmax(rint(4.0 * deviation[cell] / sum), 1.0), VISITS_MOST);
        most = each > most ? (uint)each : most;
        TEST_TRUE(visits[cell] == next);
        next += pixels[cell] * (uint)each;
        TEST_NEAR(importance_density_ratio(&known.combination, visits, cell), all / (each * PIXELS), 1e-9);
    }
    ck_assert_uint_eq(all, next);
    ck_assert((most == VISITS_MOST) == (_i == 1));
    known_destroy(&known);
}
END_TEST

/* Variances of very bright light are infinite, and what follows from them may be NaN; weights are weights all the same,
 * and importances are numbers. */
START_TEST(test_wild_numbers)
{
    static const double WILD[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1e300, -1e300, 0.0};
    const double samples[ESTIMATOR_COUNT] = {64.0, 6.0, 48.0, 32.0};
    const size_t count = sizeof WILD / sizeof WILD[0];
    float importance[IMPORTANCE_CELLS];
    Known known;
    known_init(&known, 17);
    known.combination.ready[ESTIMATOR_BIDIRECTIONAL] = true;
    for (size_t kind = 0; kind < count * count; ++kind) {
        CombinationTile *tile = &known.combination.known[kind % combination_tile_count(&known.combination)];
        const CombinationTile kept = *tile;
        for (int s = 0; s < SERIES_COUNT; ++s)
            tile->spread[s] = WILD[s % 2 ? kind % count : kind / count];
        known.combination.rare_chains = WILD[kind % count];
        tile->light = WILD[kind % count];
        TEST_TRUE(combination_weights_set(&known.combination, samples) >= 1);
        double sum = 0.0;
        for (int s = 0; s < ESTIMATOR_COUNT; ++s) {
            TEST_TRUE(tile->weight[s] >= 0.0 && tile->weight[s] <= 1.0);
            sum += tile->weight[s];
        }
        TEST_NEAR(sum, 1.0, 1e-9);
        TEST_TRUE(tile->paths_rare >= 0.0 && tile->paths_rare <= 1.0);
        importance_learn(&known.combination, importance);
        for (uint cell = 0; cell < IMPORTANCE_CELLS; ++cell)
            TEST_TRUE((double)importance[cell] >= IMPORTANCE_LEAST && (double)importance[cell] <= IMPORTANCE_MOST);
        *tile = kept;
    }
    known_destroy(&known);
}
END_TEST

TCase *combination_known_tests(void)
{
    TCase *tcase = tcase_create("known");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_weights_known, 0, 4);
    tcase_add_test(tcase, test_errors_known);
    tcase_add_test(tcase, test_rates_adopted);
    tcase_add_test(tcase, test_plan_known);
    tcase_add_test(tcase, test_alone_known);
    tcase_add_test(tcase, test_worth_known);
    tcase_add_test(tcase, test_importance_known);
    tcase_add_test(tcase, test_wild_numbers);
    tcase_add_loop_test(tcase, test_visits_known, 0, 2);
    return tcase;
}
