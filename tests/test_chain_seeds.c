/* Systematic resampling of a pool: counts, order, and what a chain is worth. */
#include "chain_seeds.h"
#include "pool.h"

#include "test_util.h"

#define POOL 1000u

/* Weights of very different size, a third of them none, keys of a few depths. */
static void pool_make(uint *pool, double *sum)
{
    *sum = 0.0;
    for (uint i = 0; i < POOL; ++i) {
        float weight = i % 3 == 0 ? 0.0f : 0.001f * (float)((i * 7919u) % 1009u + 1u) * (i % 50 == 1 ? 100.0f : 1.0f);
        pool[POOL_WEIGHT * POOL + i] = float_bits(weight);
        pool[POOL_KEY * POOL + i] = i % 3 == 0 ? 0u : chain_key(3u + i % 5u, i % 3u);
        *sum += (double)weight;
    }
}

START_TEST(test_counts)
{
    static uint pool[POOL_WORDS * POOL], seeds[4096], keys[4096], times[POOL];
    double sum, brightness, offset = 0.125 * (_i + 0.5);
    const uint count = 4096;
    Error error = {0};
    pool_make(pool, &sum);
    memset(times, 0, sizeof times);
    ck_assert(chain_seeds_choose(pool, POOL, _i % 2 == 0, offset, count, seeds, keys, &brightness, &error));
    ck_assert_double_eq_tol(brightness, sum / POOL, 1e-9);
    for (uint i = 0; i < count; ++i) {
        ck_assert_uint_eq(keys[i], pool[POOL_KEY * POOL + seeds[i]]);
        ++times[seeds[i]];
        if (i > 0 && _i % 2 == 0) {
            uint before = chain_key_depth(keys[i - 1]) * 64 + chain_key_s(keys[i - 1]);
            ck_assert_uint_le(before, chain_key_depth(keys[i]) * 64 + chain_key_s(keys[i]));
        } else if (i > 0) {
            ck_assert_uint_le(seeds[i - 1], seeds[i]);
        }
    }
    for (uint i = 0; i < POOL; ++i) {
        double expected = count * (double)bits_float(pool[POOL_WEIGHT * POOL + i]) / sum;
        ck_assert_double_gt(times[i], expected - 1.0 - 1e-6);
        ck_assert_double_lt(times[i], expected + 1.0 + 1e-6);
    }
}
END_TEST

/* The offset moves the comb: over a fine grid of offsets every sample is taken as often as it is worth. */
START_TEST(test_mean)
{
    static uint pool[POOL_WORDS * POOL], seeds[64], keys[64], times[POOL];
    double sum, brightness;
    const uint count = 64, offsets = 4096;
    Error error = {0};
    pool_make(pool, &sum);
    for (uint k = 0; k < offsets; ++k) {
        ck_assert(chain_seeds_choose(pool, POOL, true, (k + 0.5) / offsets, count, seeds, keys, &brightness, &error));
        for (uint i = 0; i < count; ++i)
            ++times[seeds[i]];
    }
    for (uint i = 0; i < POOL; ++i) {
        double expected = count * (double)bits_float(pool[POOL_WEIGHT * POOL + i]) / sum;
        ck_assert_double_eq_tol((double)times[i] / offsets, expected, 2.0 / offsets);
    }
}
END_TEST

START_TEST(test_dark)
{
    static uint pool[POOL_WORDS * POOL];
    uint seeds[4] = {7, 7, 7, 7}, keys[4] = {0};
    double brightness = 1.0;
    Error error = {0};
    ck_assert(chain_seeds_choose(pool, POOL, true, 0.5, 4, seeds, keys, &brightness, &error));
    ck_assert_double_eq(brightness, 0.0);
    ck_assert_uint_eq(seeds[0], 7);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("chain seeds");
    TCase *tcase = tcase_create("seeds");
    tcase_add_loop_test(tcase, test_counts, 0, 8);
    tcase_add_test(tcase, test_mean);
    tcase_add_test(tcase, test_dark);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
