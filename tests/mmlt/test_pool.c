/* Which pixels get pool samples with a light subpath, and which samples path tracing takes, over many generations, on a
 * fake backend that only records. */
#include "support/test_util.h"

#include "base/sample_statistics.h"
#include "chain/pool.h"
#include "mmlt/mmlt.h"

#include "math/rng.h"

#include <string.h>

#define GENERATIONS 64u

struct Backend {
    uint *samples, *walks; /* per pixel: pool samples, and those with a light subpath */
    uint chunks, begun, whole; /* chunks; those with such samples; how many if these were contiguous */
    uint wrong; /* pools with more or fewer such samples than stated */
    bool pilot; /* the next pool is the pilot, before the first generation, which shows nothing */
    uint paths[REPLICAS]; /* path tracing's samples of each pixel, in either sequence */
    uint repeated; /* passes of path tracing that do not continue with the next sample of their sequence */
    uint trial; /* bidirectional path tracing's next sample number that no trial has had */
    bool bright; /* path tracing finds light, so that pools adapt their visits */
};

#define CHUNK 512u

static void pool_record(Backend *backend, const FrameParams *frame, const Guide *guide)
{
    uint walks = 0;
    for (uint first = 0; first < frame->pass.item_count; first += CHUNK) {
        uint before = walks, end = first + CHUNK < frame->pass.item_count ? first + CHUNK : frame->pass.item_count;
        for (uint item = first; item < end; ++item) {
            bool walk = pool_has_light(frame, item);
            uint pixel = pool_item_place(frame, guide, item).pixel;
            ++backend->samples[pixel];
            backend->walks[pixel] += walk;
            walks += walk;
        }
        backend->begun += walks > before;
        ++backend->chunks;
    }
    backend->whole += (frame->pool.lights + CHUNK - 1) / CHUNK;
    backend->wrong += walks != frame->pool.lights;
}

/* Counts the samples of path tracing in either sequence, which are far apart. */
static void sequence_record(Backend *backend, const FrameParams *frame)
{
    uint half = frame->pass.sample_index >> 30, sample = frame->pass.sample_index & 0x3fffffffu;
    ck_assert_uint_lt(half, REPLICAS);
    backend->repeated += sample != backend->paths[half];
    backend->paths[half] += frame->pass.item_count / (frame->film.width * frame->film.height);
}

/* Trials of bidirectional path tracing have sample numbers of their own, behind those that sequences get to. */
static void trial_record(Backend *backend, const FrameParams *frame)
{
    uint pixels = frame->film.width * frame->film.height;
    ck_assert_uint_ge(frame->pass.sample_index, backend->trial ? backend->trial : 0x60000000u);
    ck_assert_uint_eq(frame->path.sobol, 0);
    backend->trial = frame->pass.sample_index + (frame->pass.item_count + pixels - 1) / pixels;
}

/* A separate splat for each path-tracing sample; the lower half of the image is a thousand times darker. */
static void paths_record(const FrameParams *frame, const SplatSink *sink)
{
    uint words[SPLAT_WORDS];
    for (uint item = 0; item < frame->pass.item_count; ++item) {
        ItemPlace place = item_place(frame, item);
        Random4 random = random_four(place.pixel, place.sample, 1, 2, 3, 4);
        float value =
            random_float(random.x[0]) * (place.pixel / frame->film.width < frame->film.height / 2 ? 1.0f : 1e-3f);
        words[SPLAT_PIXEL] = place.pixel | SPLAT_LIGHT;
        for (uint k = 0; k < 3; ++k)
            words[SPLAT_COLOR + k] = float_bits(value);
        sink->splats(sink->context, words, 1, 1);
    }
}

static bool record_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                       const atomic_int *stop, uint64_t *items_done, Error *error)
{
    (void)stop, (void)error;
    if (frame->pool.enabled != 0) {
        memset(list->pass_words, 0, (size_t)POOL_WORDS * frame->pass.item_count * sizeof(uint));
        if (!backend->pilot)
            pool_record(backend, frame, list->guide);
        backend->pilot = false;
    } else if ((frame->path.strategies & STRATEGY_INNER) != 0) {
        trial_record(backend, frame);
    } else {
        sequence_record(backend, frame);
        if (backend->bright && sink->splats)
            paths_record(frame, sink);
    }
    *items_done = frame->pass.item_count;
    return true;
}

static const BackendInterface RECORD = {.name = "record", .run = record_run};

/* Runs generations with pools of `pool` samples on an image of width x height pixels. */
static void generations_record(Backend *backend, int width, int height, uint pool, uint64_t seed, uint generations)
{
    Error error = {0};
    Film film;
    Mmlt mmlt;
    ck_assert(film_init(&film, width, height, (const int[4]){0, 0, width, height}, &error));
    ck_assert(film_light_reserve(&film, &error));
    static const Guide guide;
    const RenderOptions options = {.samples = 1, .max_depth = 4, .seed = seed, .chains = {.chains = 16, .pool = pool}};
    RenderRun run = {
        .interface = &RECORD,
        .backend = backend,
        .options = &options,
        .film = &film,
        .guide = &guide,
        .crop_pixels = (uint64_t)width * (uint64_t)height,
        .frame = {.path.max_depth = 4,
                  .film.width = (uint)width,
                  .film.height = (uint)height,
                  .film.crop_x1 = (uint)width,
                  .film.crop_y1 = (uint)height,
                  .film.filter = {.kind = PIXEL_FILTER_BOX, .radius_x = 0.5f, .radius_y = 0.5f, .weight = 1.0f},
                  .pass.seed_low = (uint)seed}};
    ck_assert(mmlt_init(&mmlt, &run, &error));
    backend->pilot = true;
    for (uint i = 0; i < generations; ++i)
        ck_assert_msg(mmlt_generation_run(&mmlt, 16, &error), "%s", error.message);
    mmlt_destroy(&mmlt);
    film_destroy(&film);
}

/* Pixels per side, pool samples per pixel, whether pools adapt their visits. */
static const struct {
    int side;
    double part;
    bool bright;
} SIZES[] = {{128, 1.0, false},     {128, 0.5, false},  {128, 0.25, false}, {128, 2.0, false}, {128, 0.75, false},
             {128, 0.37, false},    {128, 0.81, false}, {128, 1.13, false}, {128, 0.2, false}, {128, 1.0 / 13, false},
             {127, 2.0 / 3, false}, {128, 1.0, true},   {128, 0.5, true},   {128, 0.37, true}, {128, 0.1, true}};

/* The numbers of light subpaths per pixel vary at most half as much as with random selection, for all sizes; if visits
 * adapt, so that few rounds are completed before they change, at most as much. Hardly any pixel gets none. */
START_TEST(test_even)
{
    int side = SIZES[_i].side;
    uint pixels = (uint)(side * side), none = 0;
    double squares = 0.0, drawn = 0.0;
    SampleMoments walks = {0};
    Backend backend = {
        .samples = calloc(pixels, sizeof(uint)), .walks = calloc(pixels, sizeof(uint)), .bright = SIZES[_i].bright};
    ck_assert(backend.samples && backend.walks);
    generations_record(&backend, side, side, (uint)(SIZES[_i].part * pixels), 1, GENERATIONS);
    for (uint i = 0; i < pixels; ++i) {
        double expected = 0.25 * backend.samples[i], off = backend.walks[i] - expected;
        squares += off * off;
        drawn += 0.75 * expected;
        none += backend.walks[i] == 0 && expected >= 3.0;
        sample_moments_add(&walks, backend.walks[i]);
    }
    ck_assert_uint_eq(backend.repeated, 0);
    ck_assert_uint_ge(backend.paths[0], 4);
    ck_assert_uint_eq(backend.paths[1], 0); /* a second sequence is for halves */
    double deviation = sqrt(walks.squares / walks.count) / walks.mean;
    printf("%d x %d, pools of %.3f of the pixels%s: %.2f walks a pixel, relative deviation %.3f, %.3f times the "
           "variance of "
           "draws, %.2f %% have none; chunks with walks %.3f of all, %.3f times the least\n",
           side, side, SIZES[_i].part, SIZES[_i].bright ? ", visits" : "", walks.mean, deviation, squares / drawn,
           100.0 * none / pixels, (double)backend.begun / backend.chunks, (double)backend.begun / backend.whole);
    ck_assert_uint_eq(backend.wrong, 0);
    ck_assert_double_lt(squares, (backend.bright ? 1.0 : 0.5) * drawn);
    ck_assert_uint_le(none, pixels / 1000);
    free(backend.samples);
    free(backend.walks);
}
END_TEST

/* The first generation alone prefers no pixel: over many seeds, all get the same number of light subpaths. */
START_TEST(test_first)
{
    enum { SIDE = 24, PIXELS = SIDE * SIDE, SEEDS = 512 };
    static uint samples[PIXELS], walks[PIXELS];
    Backend backend = {.samples = samples, .walks = walks};
    double least = 0.0, most = 0.0;
    for (uint64_t seed = 0; seed < SEEDS; ++seed)
        generations_record(&backend, SIDE, SIDE, _i == 0 ? PIXELS : PIXELS / 4, seed, 1);
    for (uint i = 0; i < PIXELS; ++i) {
        double away = (walks[i] - 0.25 * samples[i]) / sqrt(0.25 * 0.75 * samples[i]);
        least = away < least ? away : least;
        most = away > most ? away : most;
    }
    printf("first pools: walks of a pixel %.2f ... %.2f standard errors from a quarter of its samples\n", least, most);
    ck_assert_double_gt(least, -5.0);
    ck_assert_double_lt(most, 5.0);
}
END_TEST

/* The mean brightness is that of the other replica's pools, also if generations without any came between; of the
 * pilot before there is one. */
START_TEST(test_brightness)
{
    PoolEstimator pool = {.pilot_brightness = 5.0};
    for (uint index = 0; index < 20; ++index) {
        const Generation generation = {.index = index, .replica = (int)(index % 2), .other = (int)((index + 1) % 2)};
        if (index % 4 >= 2)
            continue;
        ck_assert_double_eq_tol(pool_estimator_brightness(&pool, &generation),
                                index == 0       ? 5.0
                                : index % 2 == 0 ? 3.0
                                                 : 1.0,
                                1e-12);
        pool.brightness = index % 2 == 0 ? 1.0 : 3.0;
        pool_estimator_count(&pool, &generation);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("pool");
    TCase *even = tcase_create("even");
    tcase_set_timeout(even, 300);
    tcase_add_loop_test(even, test_even, 0, sizeof SIZES / sizeof SIZES[0]);
    suite_add_tcase(suite, even);
    TCase *first = tcase_create("first");
    tcase_add_test(first, test_brightness);
    tcase_add_loop_test(first, test_first, 0, 2);
    suite_add_tcase(suite, first);
    return test_run(suite);
}
