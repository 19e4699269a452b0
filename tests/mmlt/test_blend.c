/* Shares of chains, pool and path tracing, on generations made up of noise. */
#include "math/rng.h"
#include "mmlt/blend.h"
#include "mmlt/importance.h"

#include "mmlt/test_blend.h"

#include <string.h>

#define SIDE 32
#define PIXELS ((size_t)SIDE * SIDE)

static const atomic_int never = 0; /* a stop */

typedef struct Streams {
    Film films[BLEND_STREAMS];
    Blend blend;
    uint draws;
} Streams;

static void streams_init(Streams *streams)
{
    const int crop[4] = {0, 0, SIDE, SIDE};
    Error error = {0};
    *streams = (Streams){0};
    for (int s = 0; s < BLEND_STREAMS; ++s) {
        ck_assert(film_init(&streams->films[s], SIDE, SIDE, crop, &error));
        ck_assert(film_light_reserve(&streams->films[s], &error));
    }
    ck_assert(film_rare_reserve(&streams->films[BLEND_CHAINS], &error));
    ck_assert(blend_init(&streams->blend, &streams->films[0], &error));
}

static void streams_destroy(Streams *streams)
{
    for (int s = 0; s < BLEND_STREAMS; ++s)
        film_destroy(&streams->films[s]);
    blend_destroy(&streams->blend);
}

/* Uniform with mean 0 and variance 1. */
static double noise(Streams *streams)
{
    Random4 random = random_four(streams->draws++, 1, 2, 3, 4, 5);
    return (((double)random.x[0] + 0.5) / 4294967296.0 - 0.5) * sqrt(12.0);
}

/* Every pixel of the stream shows `mean` + noise: `deviation` for one sample a pixel. */
static void stream_set(Streams *streams, int s, double samples, double mean, double deviation)
{
    Film *film = &streams->films[s];
    film_clear(film);
    film->light_samples = (uint64_t)(samples * (double)PIXELS);
    for (size_t i = 0; i < PIXELS; ++i) {
        double value = mean + deviation * noise(streams) / sqrt(samples);
        for (size_t c = 0; c < 3; ++c)
            film->light_sums[3 * i + c] = llrint(value * samples * 0x1p30);
    }
}

static double generation(Streams *streams)
{
    Film *const films[BLEND_STREAMS] = {&streams->films[0], &streams->films[1], &streams->films[2]};
    Error error = {0};
    double sum = 0.0;
    ck_assert(blend_generation(&streams->blend, &streams->blend, films, &never, &error));
    for (size_t i = 0; i < 3 * PIXELS; ++i)
        sum += (double)films[BLEND_CHAINS]->light_sums[i];
    return sum * 0x1p-30 / 3.0 / (double)films[BLEND_CHAINS]->light_samples;
}

/* Shares go as samples over variance. */
START_TEST(test_shares)
{
    Streams streams;
    streams_init(&streams);
    for (int g = 0; g < 60; ++g) {
        stream_set(&streams, BLEND_CHAINS, 4.0, 1.0, 1.0);
        stream_set(&streams, BLEND_POOL, 1.0, 1.0, 0.5);
        stream_set(&streams, BLEND_PATHS, 2.0, 1.0, 2.0);
        double mean = generation(&streams);
        ck_assert_double_eq_tol(mean, 1.0, 0.08);
    }
    /* 4 / 1, 1 / 0.25, 2 / 4 */
    const double *share = streams.blend.share;
    printf("shares %.3f %.3f %.3f\n", share[0], share[1], share[2]);
    ck_assert_double_eq_tol(share[BLEND_CHAINS], 4.0 / 8.5, 0.02);
    ck_assert_double_eq_tol(share[BLEND_POOL], 4.0 / 8.5, 0.02);
    ck_assert_double_eq_tol(share[BLEND_PATHS], 0.5 / 8.5, 0.02);
    streams_destroy(&streams);
}
END_TEST

/* A stream that never sees the light has no variance, and yet no share worth speaking of. */
START_TEST(test_blind)
{
    Streams streams;
    streams_init(&streams);
    for (int g = 0; g < 30; ++g) {
        stream_set(&streams, BLEND_CHAINS, 4.0, 1.0, 1.0);
        stream_set(&streams, BLEND_POOL, 1.0, _i == BLEND_POOL ? 0.0 : 1.0, _i == BLEND_POOL ? 0.0 : 1.0);
        stream_set(&streams, BLEND_PATHS, 2.0, _i == BLEND_PATHS ? 0.0 : 1.0, _i == BLEND_PATHS ? 0.0 : 1.0);
        generation(&streams);
    }
    printf("a blind stream's share: %.5f\n", streams.blend.share[_i]);
    ck_assert_double_lt(streams.blend.share[_i], 0.01);
    streams_destroy(&streams);
}
END_TEST

/* A stream without samples this time has no share, and the others have all. Before variances are known path tracing's goes as
 * a part of its work, those of chains and pool as the pool's: in hard light it is far worse than the others, and of a large
 * picture it is nearly all. */
START_TEST(test_absent)
{
    Streams streams;
    const double pool[BLEND_STREAMS] = {[BLEND_POOL] = 1.0}, paths[BLEND_STREAMS] = {[BLEND_PATHS] = 2.0};
    const double part = 0.25 * blend_work(paths);
    streams_init(&streams);
    for (int g = 0; g < 6; ++g) {
        stream_set(&streams, BLEND_CHAINS, 4.0, 1.0, 1.0);
        stream_set(&streams, BLEND_POOL, 1.0, 1.0, 1.0);
        stream_set(&streams, BLEND_PATHS, 2.0, 1.0, 1.0);
        if (g == _i) {
            film_clear(&streams.films[BLEND_PATHS]);
            streams.films[BLEND_PATHS].light_samples = 0;
        }
        ck_assert_double_eq_tol(generation(&streams), 1.0, 0.08);
        const double *share = streams.blend.share;
        ck_assert_double_eq_tol(share[0] + share[1] + share[2], 1.0, 1e-12);
        if (g == _i)
            ck_assert_double_eq(share[BLEND_PATHS], 0.0);
        else if (g < 2)
            ck_assert_double_eq_tol(share[BLEND_PATHS], part / (2.0 * blend_work(pool) + part), 1e-12);
        else if (g > 2)
            ck_assert_double_gt(share[BLEND_PATHS], 0.0);
    }
    streams_destroy(&streams);
}
END_TEST

/* A stream that is shown alone has all, and nothing in a generation in which it has no samples. */
START_TEST(test_alone)
{
    Streams streams;
    streams_init(&streams);
    streams.blend.shown = 1 + BLEND_PATHS;
    for (int g = 0; g < 6; ++g) {
        stream_set(&streams, BLEND_CHAINS, 4.0, 1.0, 1.0);
        stream_set(&streams, BLEND_POOL, 1.0, 1.0, 1.0);
        stream_set(&streams, BLEND_PATHS, 2.0, 1.0, 1.0);
        if (g % 2 == 1)
            streams.films[BLEND_PATHS].light_samples = 0;
        ck_assert_double_eq_tol(generation(&streams), 1.0, 0.08);
        ck_assert_double_eq(streams.blend.share[BLEND_PATHS], g % 2 == 1 ? 0.0 : 1.0);
    }
    streams_destroy(&streams);
}
END_TEST

/* A pool of half a sample a pixel shows every other pixel twice as bright, and the next pool the others: that is no
 * variance of what it shows in the end, and counts as little as a correction may make it. */
START_TEST(test_partial)
{
    Streams streams;
    streams_init(&streams);
    for (int g = 0; g < 20; ++g) {
        stream_set(&streams, BLEND_CHAINS, 4.0, 1.0, 1.0);
        stream_set(&streams, BLEND_POOL, 0.5, 1.0, 0.0);
        stream_set(&streams, BLEND_PATHS, 2.0, 1.0, 2.0);
        for (size_t i = 0; i < 3 * PIXELS; ++i)
            streams.films[BLEND_POOL].light_sums[i] *= i / 3 % 2 == (size_t)g % 2 ? 2 : 0;
        generation(&streams);
    }
    /* 4 / 1, 0.5 / (0.5 / 4), 2 / 4: without the correction the pool's were 0.5 / 0.5. */
    const double *share = streams.blend.share;
    printf("shares with a partial pool %.3f %.3f %.3f\n", share[0], share[1], share[2]);
    ck_assert_double_eq_tol(share[BLEND_POOL], 4.0 / 8.5, 0.04);
    streams_destroy(&streams);
}
END_TEST

/* Bright dots in one tile are expected in those beside it, and not elsewhere. */
START_TEST(test_beside)
{
    Streams streams;
    streams_init(&streams);
    for (int g = 0; g < 20; ++g) {
        for (int s = 0; s < BLEND_STREAMS; ++s)
            stream_set(&streams, s, 1.0, 1.0, 1.0);
        if (g % 4 == 0)
            streams.films[BLEND_POOL].light_sums[0] += llrint(1000.0 * 0x1p30);
        generation(&streams);
    }
    const BlendTile *known = streams.blend.known;
    double own = known[0].spread[BLEND_POOL], beside = known[5].spread[BLEND_POOL],
           elsewhere = known[15].spread[BLEND_POOL];
    printf("variance with dots %.3g, beside them %.3g, elsewhere %.3g\n", own, beside, elsewhere);
    ck_assert_double_gt(own, 1.5 * elsewhere);
    ck_assert_double_gt(beside, 1.5 * elsewhere);
    streams_destroy(&streams);
}
END_TEST

/* What chains keep apart counts with chains and pool, not with path tracing. */
START_TEST(test_excess)
{
    Streams streams;
    streams_init(&streams);
    for (int g = 0; g < 6; ++g) {
        stream_set(&streams, BLEND_CHAINS, 4.0, 1.0, 0.1);
        stream_set(&streams, BLEND_POOL, 1.0, 1.0, 0.1);
        stream_set(&streams, BLEND_PATHS, 2.0, 3.0, 0.1);
        for (size_t i = 0; i < 3 * PIXELS; ++i)
            streams.films[BLEND_CHAINS].sums[i] = llrint(4.0 * 2.0 * 0x1p30);
        ck_assert_double_eq_tol(generation(&streams), 3.0, 0.02);
    }
    streams_destroy(&streams);
}
END_TEST

/* The plan gives the time to what is good: nothing but path tracing is, or nothing but chains. Their errors fall
 * with the pools, too, so that pools get 0.45 of the time of both; path tracing gets the least there is, a part of 20. */
START_TEST(test_plan)
{
    Streams streams;
    streams_init(&streams);
    ck_assert_double_eq(blend_plan(&streams.blend).paths_per_step, 0.0);
    for (int g = 0; g < 20; ++g) {
        stream_set(&streams, BLEND_CHAINS, 4.0, 1.0, _i == 0 ? 10.0 : 1.0);
        stream_set(&streams, BLEND_POOL, 1.0, 1.0, 10.0);
        stream_set(&streams, BLEND_PATHS, 2.0, 1.0, _i == 0 ? 1.0 : 10.0);
        generation(&streams);
    }
    BlendPlan plan = blend_plan(&streams.blend);
    printf("plan: %.3f paths, %.3f samples of a pool for a step\n", plan.paths_per_step, plan.pool_per_step);
    ck_assert_int_eq(plan.paths_per_step > 10.0, _i == 0);
    if (_i == 1) {
        double steps = blend_work((double[BLEND_STREAMS]){[BLEND_CHAINS] = 1.0});
        double pool = blend_work((double[BLEND_STREAMS]){[BLEND_POOL] = plan.pool_per_step});
        double paths = blend_work((double[BLEND_STREAMS]){[BLEND_PATHS] = plan.paths_per_step});
        ck_assert_double_eq_tol(paths / (steps + pool + paths), 0.05, 1e-6);
        ck_assert_double_eq_tol(pool / (steps + pool), 0.45, 0.05);
    }
    streams_destroy(&streams);
}
END_TEST

/* Of a picture whose right half is a hundred times as dark as its left one: far from the border the root of that, but for what
 * every place has at least, so that the mean worth of a path stays the same. A picture without light has no place before
 * another. */
START_TEST(test_importance)
{
    Streams streams;
    float importance[IMPORTANCE_CELLS];
    double sum = 0.0, worth = 0.0, least = 0.05 * 0.505;
    streams_init(&streams);
    for (int s = 0; s < BLEND_STREAMS; ++s) {
        stream_set(&streams, s, 1.0, 0.0, 0.0);
        for (size_t i = 0; i < 3 * PIXELS; ++i)
            streams.films[s].light_sums[i] = (i / 3 % SIDE < SIDE / 2 ? 100 : 1) * (1ll << 22);
    }
    importance_learn(&streams.blend, importance);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        ck_assert_float_eq(importance[i], 1.0f);
    generation(&streams);
    generation(&streams);
    importance_learn(&streams.blend, importance);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        uint column = i % IMPORTANCE_SIDE;
        ck_assert_float_eq(importance[i], importance[column]); /* all rows are alike */
        ck_assert(column == 0 || importance[i] >= importance[i - 1]);
    }
    ck_assert_double_eq_tol((double)importance[IMPORTANCE_SIDE - 1] / (double)importance[0],
                            sqrt((1.0 + least) / (0.01 + least)), 0.01);
    for (size_t i = 0; i < IMPORTANCE_CELLS; ++i) {
        double light = i % IMPORTANCE_SIDE < IMPORTANCE_SIDE / 2 ? 1.0 : 0.01;
        sum += light;
        worth += light * (double)importance[i];
    }
    ck_assert_double_eq_tol(worth / sum, 1.0, 0.1);
    streams_destroy(&streams);
}
END_TEST

/* Pools go where the error is: of a picture of four columns of tiles, whose last one has ten times the standard deviation of the
 * others, by the root of the square error, but for a quarter that is even. The column beside it is believed to have a third of
 * that square (mmlt/blend_learn.c). Pools that have been there more often already say that there is more. What nothing is known of
 * is visited alike. */
START_TEST(test_visits)
{
    Streams streams;
    Error error = {0};
    double samples[BLEND_STREAMS] = {1.0, 1.0, 1.0}, visited[IMPORTANCE_CELLS];
    uint visits[IMPORTANCE_CELLS + 1];
    streams_init(&streams);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        visited[i] = _i == 0 || i % IMPORTANCE_SIDE < 24 ? 1.0 : 4.0;
    ck_assert(importance_visits(&streams.blend, samples, visited, visits, &error));
    ck_assert_uint_eq(visits[IMPORTANCE_CELLS], 0);
    for (int g = 0; g < 20; ++g) {
        for (int s = 0; s < BLEND_STREAMS; ++s) {
            stream_set(&streams, s, 1.0, 1.0, 0.1);
            for (size_t i = 0; i < 3 * PIXELS; ++i)
                if (i / 3 % SIDE >= 24)
                    streams.films[s].light_sums[i] = llrint((1.0 + noise(&streams)) * 0x1p30);
        }
        generation(&streams);
    }
    ck_assert(importance_visits(&streams.blend, samples, visited, visits, &error));
    double columns[4] = {0.0}, all = (double)visits[IMPORTANCE_CELLS] / (double)PIXELS, sum = 0.0;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) { /* a pixel each */
        double each = visits[i + 1] - visits[i];
        ck_assert(each >= 1.0 && each <= VISITS_MOST);
        ck_assert_double_eq_tol(importance_rarity(&streams.blend, visits, i) * each, all, 1e-9);
        columns[i % IMPORTANCE_SIDE / 8] += each / (all * (double)PIXELS / 4.0);
    }
    const double deviations[4] = {1.0, 1.0, sqrt(34.0), _i == 0 ? 10.0 : 20.0};
    for (int i = 0; i < 4; ++i)
        sum += deviations[i] / 4.0;
    for (int i = 0; i < 4; ++i) {
        printf("visits of column %d: %.3f times the mean\n", i, columns[i]);
        ck_assert_double_eq_tol(columns[i], 0.25 + 0.75 * deviations[i] / sum, 0.25);
    }
    importance_tell(visits, &streams.blend);
    double tiles = 0.0;
    for (size_t i = 0; i < 16; ++i)
        tiles += 1.0 / streams.blend.rarity[i] / 16.0;
    ck_assert_double_eq_tol(tiles, 1.0, 0.05);
    streams_destroy(&streams);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("blend");
    TCase *tcase = tcase_create("blend");
    tcase_add_test(tcase, test_shares);
    tcase_add_loop_test(tcase, test_blind, BLEND_POOL, BLEND_STREAMS);
    tcase_add_loop_test(tcase, test_absent, 0, 6);
    tcase_add_test(tcase, test_alone);
    tcase_add_test(tcase, test_partial);
    tcase_add_test(tcase, test_beside);
    tcase_add_test(tcase, test_excess);
    tcase_add_loop_test(tcase, test_plan, 0, 2);
    tcase_add_test(tcase, test_importance);
    tcase_add_loop_test(tcase, test_visits, 0, 2);
    suite_add_tcase(suite, tcase);
    suite_add_tcase(suite, blend_known_tests());
    return test_run(suite);
}
