/* Systematic resampling of a pool: counts, order, and the weight of a chain. */
#include "chain/pool.h"
#include "mmlt/chain_seeds.h"

#include "support/test_util.h"

#define POOL 1000u

/* Weights of very different size, a third of them zero, with keys of a few depths. */
static void pool_make(double *weights, uint *keys, double *sum)
{
    *sum = 0.0;
    for (uint i = 0; i < POOL; ++i) {
        weights[i] = i % 3 == 0 ? 0.0 : 0.001 * ((i * 7919u) % 1009u + 1u) * (i % 50 == 1 ? 100.0 : 1.0);
        keys[i] = i % 3 == 0 ? 0u : chain_key(3u + i % 5u, i % 3u);
        *sum += weights[i];
    }
}

START_TEST(test_counts)
{
    static uint keys[POOL], seeds[4096], times[POOL];
    static double weights[POOL];
    double sum, found, offset = (_i + 0.5) / 9.0;
    const uint count = 4096;
    const ChainOrder order = (ChainOrder)(_i % 3);
    Error error = {0};
    pool_make(weights, keys, &sum);
    memset(times, 0, sizeof times);
    ck_assert(chain_seeds_choose(&(SeedCandidates){weights, keys, POOL}, &(SystematicResampling){count, offset, order},
                                 seeds, &found, &error));
    ck_assert_double_eq_tol(found, sum, 1e-9);
    for (uint i = 0; i < count; ++i) {
        uint key = keys[seeds[i]], last = i > 0 ? keys[seeds[i - 1]] : 0;
        ck_assert_uint_ne(key, 0);
        ++times[seeds[i]];
        if (i == 0)
            continue;
        if (order == CHAIN_ORDER_STRATEGY && chain_key_depth(last) == chain_key_depth(key))
            ck_assert_uint_le(chain_key_s(last), chain_key_s(key));
        if (order != CHAIN_ORDER_NONE)
            ck_assert_uint_le(chain_key_depth(last), chain_key_depth(key));
        if (order == CHAIN_ORDER_NONE || (order == CHAIN_ORDER_DEPTH && chain_key_depth(last) == chain_key_depth(key)))
            ck_assert_uint_le(seeds[i - 1], seeds[i]);
    }
    for (uint i = 0; i < POOL; ++i) {
        double expected = count * weights[i] / sum;
        ck_assert_double_gt(times[i], expected - 1.0 - 1e-6);
        ck_assert_double_lt(times[i], expected + 1.0 + 1e-6);
    }
}
END_TEST

/* The offset shifts the comb: over a fine grid of offsets, every sample is selected in proportion to its weight. */
START_TEST(test_mean)
{
    static uint keys[POOL], seeds[64], times[POOL];
    static double weights[POOL];
    double sum, found;
    const uint count = 64, offsets = 4096;
    Error error = {0};
    pool_make(weights, keys, &sum);
    for (uint k = 0; k < offsets; ++k) {
        const SystematicResampling resampling = {count, (k + 0.5) / offsets, CHAIN_ORDER_STRATEGY};
        ck_assert(chain_seeds_choose(&(SeedCandidates){weights, keys, POOL}, &resampling, seeds, &found, &error));
        for (uint i = 0; i < count; ++i)
            ++times[seeds[i]];
    }
    for (uint i = 0; i < POOL; ++i) {
        double expected = count * weights[i] / sum;
        ck_assert_double_eq_tol((double)times[i] / offsets, expected, 2.0 / offsets);
    }
}
END_TEST

START_TEST(test_dark)
{
    static uint keys[POOL];
    static double weights[POOL];
    uint seeds[4] = {7, 7, 7, 7};
    double found = 1.0;
    Error error = {0};
    ck_assert(chain_seeds_choose(&(SeedCandidates){weights, keys, POOL},
                                 &(SystematicResampling){4, 0.5, CHAIN_ORDER_STRATEGY}, seeds, &found, &error));
    ck_assert_double_eq(found, 0.0);
    ck_assert_uint_eq(seeds[0], 7);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("chain seeds");
    TCase *tcase = tcase_create("seeds");
    tcase_add_loop_test(tcase, test_counts, 0, 9);
    tcase_add_test(tcase, test_mean);
    tcase_add_test(tcase, test_dark);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
