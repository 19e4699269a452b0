/* Shards: their shares, seeds and blocks of samples; and adding what they have rendered: series of images, and
 * parts. */
#include "support/test_util.h"

#include "film/pixel_series.h"
#include "render/film_pilot.h"
#include "render/merge.h"
#include "render/shard.h"

#include <math.h>

/* ---- shares ------------------------------------------------------------------------------------------------------ */

static const uint64_t TOTALS[] = {1, 2, 7, 16, 17, 1000, 4093, UINT32_MAX, (uint64_t)1 << 61};
static const unsigned COUNTS[] = {1, 2, 3, 7, 16, 1000, 4093, SHARDS_MOST};

/* Shares follow each other without gap or overlap, and differ by one unit at most. */
START_TEST(test_share)
{
    const uint64_t total = TOTALS[_i];
    for (size_t i = 0; i < sizeof COUNTS / sizeof COUNTS[0]; ++i) {
        uint64_t next = 0, least = total / COUNTS[i];
        for (unsigned k = 1; k <= COUNTS[i]; ++k) {
            ShardRange range = shard_share((Shard){k, COUNTS[i]}, total);
            TEST_TRUE(range.first == next);
            TEST_TRUE(range.count == least || range.count == least + 1);
            next = range.first + range.count;
        }
        ck_assert(next == total);
    }
    ck_assert(shard_share((Shard){0, 0}, total).count == total);
}
END_TEST

/* Without a limit of samples, blocks do not overlap and stay below the pilot's samples. */
START_TEST(test_blocks)
{
    for (size_t i = 0; i < sizeof COUNTS / sizeof COUNTS[0]; ++i) {
        uint64_t next = 0;
        for (unsigned k = 1; k <= COUNTS[i]; ++k) {
            const RenderOptions options = {.shard = {k, COUNTS[i]}, .seconds = 1.0};
            ShardRange range = shard_samples(&options);
            TEST_TRUE(range.first == next && range.count >= 32768 && (range.count & (range.count - 1)) == 0);
            next = range.first + range.count;
        }
        ck_assert(next <= PILOT_SAMPLE && 3 * next > PILOT_SAMPLE / 2);
    }
}
END_TEST

/* No two shards of a picture have the same seed, nor has one that of the picture or of the next seed's shards. */
START_TEST(test_seeds)
{
    enum { SHARDS = 64, SEEDS = 4, ALL = SEEDS * (SHARDS + 1) };
    uint64_t seeds[ALL];
    int count = 0;
    for (unsigned seed = 0; seed < SEEDS; ++seed)
        for (unsigned k = 0; k <= SHARDS; ++k) {
            const RenderOptions options = {.seed = seed, .shard = {k, k > 0 ? SHARDS : 0}};
            seeds[count++] = shard_seed(&options);
        }
    for (int i = 0; i < ALL; ++i)
        for (int j = 0; j < i; ++j)
            TEST_TRUE(seeds[i] != seeds[j]);
    ck_assert(seeds[0] == 0);
}
END_TEST

START_TEST(test_check)
{
    Error error;
    RenderOptions options = {.samples = 8, .shard = {3, 8}};
    ck_assert(shard_check(&options, true, 100, &error));
    options.shard.count = 9;
    ck_assert(!shard_check(&options, true, 100, &error) && shard_check(&options, false, 100, &error));
    options.shard.count = 801;
    ck_assert(!shard_check(&options, false, 100, &error));
    options.samples = 0;
    ck_assert(shard_check(&options, true, 100, &error));
}
END_TEST

/* ---- series of images -------------------------------------------------------------------------------------------- */

#define PIXELS 50u
#define CHANNELS 3
#define IMAGES 24u

static float noise(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216.0f;
}

static void images_add(PixelSeries *series, unsigned from, unsigned to)
{
    float image[PIXELS * CHANNELS];
    uint32_t weights[PIXELS];
    for (unsigned i = from; i < to; ++i) {
        unsigned state = i * 7919u + 1u;
        for (unsigned v = 0; v < PIXELS * CHANNELS; ++v)
            image[v] = noise(&state) + 0.3f * (float)i;
        for (unsigned p = 0; p < PIXELS; ++p)
            weights[p] = p == 0 ? 0u : p == 1 ? (i == 3u) : 1u + state % (p + i);
        pixel_series_add(series, image, series->uniform ? NULL : weights, 1.0 + 0.5 * i);
    }
}

static void series_near(const PixelSeries *a, const PixelSeries *b)
{
    for (size_t v = 0; v < PIXELS * CHANNELS; ++v) {
        ck_assert_double_eq_tol((double)a->mean[v], (double)b->mean[v], 1e-9 + 2e-6 * fabs((double)b->mean[v]));
        ck_assert_double_eq_tol((double)a->spread[v], (double)b->spread[v], 1e-9 + 1e-5 * (double)b->spread[v]);
        ck_assert_double_eq_tol(pixel_series_variance(a, v), pixel_series_variance(b, v),
                                1e-9 + 1e-5 * pixel_series_variance(b, v));
    }
    for (size_t i = 0; i < PIXELS; ++i) {
        ck_assert_double_eq_tol(pixel_series_weight(a, i), pixel_series_weight(b, i),
                                1e-9 + 1e-6 * pixel_series_weight(b, i));
        ck_assert_uint_eq(pixel_series_pictures(a, i), pixel_series_pictures(b, i));
    }
}

/* Series of some of the images, merged, are the series of all, however they are divided. */
START_TEST(test_series)
{
    const bool uniform = _i != 0;
    for (unsigned split = 0; split <= IMAGES; split += 5) {
        PixelSeries all, first, second;
        Error error;
        ck_assert(pixel_series_init(&all, PIXELS, CHANNELS, uniform, &error) &&
                  pixel_series_init(&first, PIXELS, CHANNELS, uniform, &error) &&
                  pixel_series_init(&second, PIXELS, CHANNELS, uniform, &error));
        images_add(&all, 0, IMAGES);
        images_add(&first, 0, split);
        images_add(&second, split, IMAGES);
        pixel_series_merge(&first, &second);
        series_near(&first, &all);
        pixel_series_destroy(&all);
        pixel_series_destroy(&first);
        pixel_series_destroy(&second);
    }
}
END_TEST

/* ---- what is missing --------------------------------------------------------------------------------------------- */

static void missing_compare(const char *wanted, unsigned wanted_count, size_t size, unsigned shards, unsigned every)
{
    MergePart parts[200];
    Merge merge = {.parts = parts, .head = {.shard = {1, shards}}};
    char text[256];
    for (unsigned k = 1; k <= shards; ++k)
        if (k % every == 1 || k == 2)
            parts[merge.count++] = (MergePart){.number = k};
    ck_assert_uint_eq(merge_missing(&merge, text, size), wanted_count);
    if (wanted)
        ck_assert_str_eq(text, wanted);
    ck_assert_uint_lt(strlen(text), size);
}

START_TEST(test_missing)
{
    missing_compare("3 ... 8, 10", 7, 256, 10, 8);
    missing_compare("3, 4, 6 ... 8, 10, 11", 7, 256, 11, 4);
    missing_compare("", 0, 64, 1, 2);
    missing_compare("4, 6, 8, 10, 12, 14, 16, 18, ...", 74, 64, 150, 2);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shard");
    TCase *tcase = tcase_create("shard");
    tcase_add_loop_test(tcase, test_share, 0, sizeof TOTALS / sizeof TOTALS[0]);
    tcase_add_test(tcase, test_blocks);
    tcase_add_test(tcase, test_seeds);
    tcase_add_test(tcase, test_check);
    tcase_add_loop_test(tcase, test_series, 0, 2);
    tcase_add_test(tcase, test_missing);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
