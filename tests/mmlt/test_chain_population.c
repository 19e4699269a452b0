/* A population and a pool combined: expected sums are right for any partition between them, in a single generation and
 * over many. */
#include "mmlt/chain_population.h"

#include "chain/chain.h"
#include "chain/pool.h"
#include "math/rng.h"
#include "mmlt/chain_seeds.h"

#include "support/test_util.h"

#include <math.h>
#include <string.h>

/* ---- one generation ---------------------------------------------------------------------------------------------- */

#define CHAINS 7u
#define POOL 20u
#define OFFSETS 4096u
#define FIELDS (CHAIN_PASS_NUMBERS + 2u)

/* Every chain and sample has its own depth, by which it is recognised, and chains have coordinates to carry along. */
static void chains_make(ChainPopulation *population, uint *words)
{
    chain_population_init(population, FIELDS);
    for (uint i = 0; i < CHAINS; ++i) {
        words[CHAIN_PASS_KEY * CHAINS + i] = chain_key(3 + i, 1);
        words[CHAIN_PASS_LUMINANCE * CHAINS + i] = float_bits(i == 0 ? 0.0f : ldexpf(1.0f, 2 * (int)i - 6));
        words[CHAIN_PASS_RUN * CHAINS + i] = 300 + i;
        words[CHAIN_PASS_CELL * CHAINS + i] = 100 * i;
        words[CHAIN_PASS_NUMBERS * CHAINS + i] = 100 + i;
        words[(CHAIN_PASS_NUMBERS + 1) * CHAINS + i] = 200 + i;
    }
    population->words = malloc(FIELDS * CHAINS * sizeof *words);
    ck_assert_ptr_nonnull(population->words);
    memcpy(population->words, words, FIELDS * CHAINS * sizeof *words);
    population->count = CHAINS;
    population->brightness = 2.5;
    population->samples = 60.0;
}

static void pool_make(uint *pool)
{
    for (uint i = 0; i < POOL; ++i) {
        float luminance = i % 4 == 0 ? 0.0f : 0.01f * (float)(1u << i % 13);
        pool[POOL_LUMINANCE * POOL + i] = float_bits(luminance);
        pool[POOL_WEIGHT * POOL + i] = float_bits(1.5f * luminance);
        pool[POOL_KEY * POOL + i] = luminance > 0.0f ? chain_key(20 + i, 2) : 0;
    }
}

/* The change of importance in the cell of chain i, as used by _i. */
static float change_of(int loop, uint i)
{
    return loop == 0 ? 1.0f : 0.25f + 0.5f * (float)i;
}

/* Averaged over all offsets of the comb, the weight of a path is its part of the partition; if importance has changed,
 * that part times the change. */
START_TEST(test_parts)
{
    static float change[IMPORTANCE_CELLS];
    static uint words[FIELDS * CHAINS], pool[POOL_WORDS * POOL];
    static double got[64];
    const double threshold = 3.0, most = 60.0 / 80.0;
    memset(got, 0, sizeof got);
    pool_make(pool);
    for (uint i = 0; i < CHAINS; ++i)
        change[100 * i] = change_of(_i, i);
    for (uint k = 0; k < OFFSETS; ++k) {
        ChainPopulation population;
        Error error = {0};
        ChainStarts starts;
        uint found = 0;
        const uint count = 16;
        chains_make(&population, words);
        const SystematicResampling resampling = {count, (k + 0.5) / OFFSETS, CHAIN_ORDER_STRATEGY};
        ck_assert(chain_population_renew(&population, &(PoolSamples){pool, POOL}, _i == 0 ? NULL : change, threshold,
                                         &resampling, &starts, &error));
        for (uint i = 0; i < count; ++i) {
            uint depth = chain_key_depth(population.words[CHAIN_PASS_KEY * count + i]);
            uint item = population.words[CHAIN_PASS_ITEM * count + i];
            got[depth] += population.brightness / count / OFFSETS;
            ck_assert_uint_eq(item, depth < 20 ? NONE : depth - 20);
            ck_assert_uint_eq(population.words[CHAIN_PASS_RUN * count + i], depth < 20 ? 300 + depth - 3 : 0);
            if (depth < 20) {
                ck_assert_uint_eq(population.words[CHAIN_PASS_NUMBERS * count + i], 100 + depth - 3);
                ck_assert_uint_eq(population.words[(CHAIN_PASS_NUMBERS + 1) * count + i], 200 + depth - 3);
                ck_assert_uint_eq(population.words[CHAIN_PASS_LUMINANCE * count + i],
                                  _i == 0 ? words[CHAIN_PASS_LUMINANCE * CHAINS + depth - 3] : 0);
                ++found;
            }
        }
        ck_assert_uint_eq(starts.kept, found);
        ck_assert_double_eq(population.samples, 80.0);
        chain_population_destroy(&population);
    }
    for (uint i = 0; i < CHAINS; ++i) {
        double ratio = (double)change_of(_i, i),
               f = ratio * (double)bits_float(words[CHAIN_PASS_LUMINANCE * CHAINS + i]);
        ck_assert_double_eq_tol(got[3 + i], ratio * 2.5 / CHAINS * most * f / (f + threshold), 2e-3);
    }
    for (uint i = 0; i < POOL; ++i) {
        double f = (double)bits_float(pool[POOL_LUMINANCE * POOL + i]);
        ck_assert_double_eq_tol(got[20 + i], 1.5 * f / POOL * (1.0 - most * f / (f + threshold)), 2e-3);
    }
}
END_TEST

/* ---- starting paths ---------------------------------------------------------------------------------------------- */

/* Makes the next population of eight and counts its starts; every chain then has luminance 1. */
static void eight_renew(ChainPopulation *population, const uint *pool, ChainStarts *starts, ChainStatistics *statistics)
{
    Error error = {0};
    ck_assert(chain_population_renew(population, &(PoolSamples){pool, 4}, NULL, 0.0,
                                     &(SystematicResampling){8, 0.4, CHAIN_ORDER_STRATEGY}, starts, &error));
    chain_statistics_starts(statistics, starts);
    for (uint i = 0; i < 8; ++i)
        population->words[CHAIN_PASS_LUMINANCE * 8 + i] = float_bits(1.0f);
}

/* Eight chains from samples of contribution weight 4, 2, 1 and 1, with 3, 5, 3 and 5 segments. In the next generation
 * half of everything belongs to the chains: of the comb's eight teeth at (k + 0.4) / 4, five hit chains, of weight 1/8
 * each, and three hit samples, of weight 1/2, 1/4, 1/8 and 1/8. */
START_TEST(test_starts)
{
    uint pool[POOL_WORDS * 4];
    ChainPopulation population;
    ChainStarts starts;
    ChainStatistics statistics = {0};
    for (uint i = 0; i < 4; ++i) {
        pool[POOL_LUMINANCE * 4 + i] = float_bits(1.0f);
        pool[POOL_WEIGHT * 4 + i] = float_bits(i == 0 ? 4.0f : i == 1 ? 2.0f : 1.0f);
        pool[POOL_KEY * 4 + i] = chain_key(i % 2 == 0 ? 3 : 5, 1);
    }
    chain_population_init(&population, FIELDS);
    eight_renew(&population, pool, &starts, &statistics);
    ck_assert_uint_eq(starts.kept, 0);
    ck_assert(starts.chains[3] == 5 && starts.distinct[3] == 2 && starts.chains[5] == 3 && starts.distinct[5] == 2);
    eight_renew(&population, pool, &starts, &statistics);
    ck_assert_uint_eq(starts.kept, 5);
    ck_assert(starts.chains[3] == 5 && starts.distinct[3] == 4 && starts.chains[5] == 3 && starts.distinct[5] == 3);
    ck_assert(statistics.starts[3] == 10 && statistics.distinct_starts[3] == 6);
    ck_assert(statistics.starts[5] == 6 && statistics.distinct_starts[5] == 5);
    ck_assert_uint_eq(statistics.seeds, 11);
    ck_assert_double_eq(statistics.least_distinct, 0.5);
    /* A black pool starts no chains. */
    for (uint i = 0; i < 4; ++i)
        pool[POOL_KEY * 4 + i] = 0;
    chain_population_destroy(&population);
    chain_population_init(&population, FIELDS);
    eight_renew(&population, pool, &starts, &statistics);
    ck_assert(starts.kept == 0 && starts.chains[3] == 0 && statistics.seeds == 11 && statistics.least_distinct == 0.5);
    chain_population_destroy(&population);
}
END_TEST

/* ---- many generations -------------------------------------------------------------------------------------------- */

#define STATES 24u
#define SAMPLES 12u
#define REPEATS 40000u
#define GENERATIONS 6u

static double state_value(uint state)
{
    return state == 0 ? 200.0 : 0.25 + 0.125 * state; /* one sample in a hundred finds most of the light */
}

static double state_probability(uint state)
{
    return state == 0 ? 0.01 : 0.99 / (STATES - 1);
}

static uint state_draw(uint repeat, uint generation, uint i)
{
    double u = (random_four(repeat, generation, i, 0, 7, 7).x[0] + 0.5) / 4294967296.0;
    if (u < 0.01)
        return 0;
    uint state = 1 + (uint)((u - 0.01) / 0.99 * (STATES - 1));
    return state < STATES ? state : STATES - 1;
}

/* Moves that preserve f: Metropolis steps between two neighbouring states. */
static uint state_move(uint state, uint repeat, uint generation, uint i)
{
    Random4 random = random_four(repeat, generation, i, 1, 7, 7);
    uint other = state == 0 ? 0 : 1 + ((state - 1) ^ 1u);
    if (other >= STATES || other == 0)
        return state;
    double ratio = state_value(other) * state_probability(other) / (state_value(state) * state_probability(state));
    return random.x[0] < ratio * 4294967296.0 ? other : state;
}

/* rare: all states but one are black, and so are most pools. */
static void generation_run(ChainPopulation *population, bool rare, uint repeat, uint generation, uint count,
                           double *sums)
{
    uint pool[POOL_WORDS * SAMPLES], states[SAMPLES];
    Error error = {0};
    for (uint i = 0; i < SAMPLES; ++i) {
        states[i] = state_draw(repeat, generation, i);
        float f = rare && states[i] != 0 ? 0.0f : (float)state_value(states[i]);
        pool[POOL_WEIGHT * SAMPLES + i] = pool[POOL_LUMINANCE * SAMPLES + i] = float_bits(f);
        pool[POOL_KEY * SAMPLES + i] = f > 0.0f ? chain_key(3 + states[i], 0) : 0;
    }
    double offset = (random_four(repeat, generation, 0, 2, 7, 7).x[0] + 0.5) / 4294967296.0;
    ck_assert(chain_population_renew(population, &(PoolSamples){pool, SAMPLES}, NULL, 4.0,
                                     &(SystematicResampling){count, offset, CHAIN_ORDER_STRATEGY}, NULL, &error));
    for (uint i = 0; population->brightness > 0.0 && i < count; ++i) {
        uint state = chain_key_depth(population->words[CHAIN_PASS_KEY * count + i]) - 3;
        state = state_move(state, repeat, generation, i);
        population->words[CHAIN_PASS_KEY * count + i] = chain_key(3 + state, 0);
        population->words[CHAIN_PASS_LUMINANCE * count + i] = float_bits((float)state_value(state));
        sums[state] += population->brightness / count;
    }
}

/* In every generation of a growing population, the mean of every state is right, even if there is mostly no population
 * because all pools were black. */
START_TEST(test_unbiased)
{
    const bool rare = _i == 1;
    static double mean[GENERATIONS][STATES], square[GENERATIONS][STATES];
    memset(mean, 0, sizeof mean);
    memset(square, 0, sizeof square);
    for (uint repeat = 0; repeat < REPEATS; ++repeat) {
        ChainPopulation population;
        chain_population_init(&population, CHAIN_PASS_NUMBERS);
        for (uint generation = 0; generation < GENERATIONS; ++generation) {
            double sums[STATES] = {0};
            generation_run(&population, rare, repeat, generation, generation < 3 ? 5 : 9, sums);
            for (uint state = 0; state < STATES; ++state) {
                mean[generation][state] += sums[state] / REPEATS;
                square[generation][state] += sums[state] * sums[state] / REPEATS;
            }
        }
        chain_population_destroy(&population);
    }
    for (uint generation = 0; generation < GENERATIONS; ++generation)
        for (uint state = 0; state < (rare ? 1 : STATES); ++state) {
            double expected = state_value(state) * state_probability(state), got = mean[generation][state];
            double error = sqrt((square[generation][state] - got * got) / REPEATS);
            if (state == 0)
                printf("generation %u: the rare state has %.4f +- %.4f of %.4f, spread %.3f\n", generation, got, error,
                       expected, error * sqrt(REPEATS));
            /* 144 values, 4.5 deviations: fails once in a thousand times by chance, and the seed is fixed. */
            ck_assert_double_eq_tol(got, expected, 4.5 * error);
        }
    /* What is remembered is the mean of all pools so far: the rare state's variance decreases with their number. */
    double first = square[0][0] - mean[0][0] * mean[0][0];
    double last = square[GENERATIONS - 1][0] - mean[GENERATIONS - 1][0] * mean[GENERATIONS - 1][0];
    ck_assert_double_lt(last, 0.4 * first);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("chain_population");
    TCase *tcase = tcase_create("chain_population");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_parts, 0, 2);
    tcase_add_test(tcase, test_starts);
    tcase_add_loop_test(tcase, test_unbiased, 0, 2);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
