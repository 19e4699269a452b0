/* Alias tables: the probabilities they imply, the arithmetic of sampling, invalid inputs. */
#include "math/test_math.h"

#include "layout/distribution.h"
#include "math/rng.h"
#include "scene/distribution_build.h"

/* Largest relative difference between weight / sum and the table's probability; infinite if an index of weight 0 can be
 * sampled. */
static double alias_error(const double *weights, size_t n, const AliasBucket *buckets)
{
    double *implied = calloc(n, sizeof *implied), sum = 0.0, worst = 0.0;
    for (size_t i = 0; i < n; ++i) {
        test_require(buckets[i].q >= 0.0f && buckets[i].q <= 1.0f && buckets[i].alias < n, "bucket %zu", i);
        implied[i] += (double)buckets[i].q;
        implied[buckets[i].alias] += 1.0 - (double)buckets[i].q;
        sum += weights[i];
    }
    for (size_t i = 0; i < n; ++i) {
        double exact = weights[i] / sum * (double)n;
        double error = exact > 0.0 ? fabs(implied[i] - exact) / exact : (implied[i] > 0.0 ? HUGE_VAL : 0.0);
        worst = error > worst ? error : worst;
    }
    free(implied);
    return worst;
}

/* Families of weights; those of case 2 (a few large ones among many nearly equal) accumulate the rounding of q. */
static double alias_weight(int family, size_t i, size_t n, uint64_t *state)
{
    double u = (double)test_uniform(state);
    switch (family) {
    case 0:
        return 3.7;
    case 1:
        return u;
    case 2:
        return i == n / 2 ? 2.0 : 0.999;
    case 3:
        return pow(10.0, -12.0 * u);
    case 4:
        return i % 3 == 0 ? 0.0 : u;
    case 5:
        return i == 0 ? 1e30 : 1e10 * u;
    default:
        return i == n - 1 ? 1.0 : 0.0;
    }
}

START_TEST(test_alias_implied)
{
    static const size_t SIZES[] = {1, 2, 3, 10, 1000, 1000003};
    uint64_t state = 30;
    Error error;
    for (size_t s = 0; s < sizeof SIZES / sizeof SIZES[0]; ++s) {
        size_t n = SIZES[s];
        if (n == 1 && _i == 4)
            continue; /* no positive weight */
        double *weights = malloc(n * sizeof *weights);
        AliasBucket *buckets = malloc(n * sizeof *buckets);
        for (size_t i = 0; i < n; ++i)
            weights[i] = alias_weight(_i, i, n, &state);
        test_require(alias_build(weights, n, buckets, &error), "%s", error.message);
        double worst = alias_error(weights, n, buckets);
        test_require(worst <= 1e-6, "family %d, %zu weights: relative error %g", _i, n, worst);
        free(weights);
        free(buckets);
    }
}
END_TEST

/* The bucket is floor(count x / 2^64), and the remainder decides, exactly: against 128-bit integers. */
START_TEST(test_alias_arithmetic)
{
    enum { N = 1000003 };
    AliasBucket *keep = malloc(N * sizeof *keep), *half = malloc(N * sizeof *half);
    for (uint i = 0; i < N; ++i) {
        keep[i] = (AliasBucket){1.0f, i};
        half[i] = (AliasBucket){0.5f, NONE};
    }
    uint64_t state = 31;
    for (int i = 0; i < 300000; ++i) {
        uint64_t bits = test_random(&state) >> (i % 7 == 0 ? 40 : 0);
        bits = i % 11 == 0 ? ~bits : bits;
        uint count = 1 + (uint)(test_random(&state) % N);
        unsigned __int128 product = (unsigned __int128)bits * count;
        uint bucket = (uint)(product >> 64);
        uint got = alias_sample(keep, count, (uint)(bits >> 32), (uint)bits);
        test_require(got == bucket, "count %u: bucket %u, not %u", count, got, bucket);
        bool kept = alias_sample(half, count, (uint)(bits >> 32), (uint)bits) == bucket;
        uint64_t rest = (uint64_t)product;
        if (rest < 0x7fffff0000000000u || rest > 0x800000ffffffffffu) /* except for rounding to float32 */
            test_require(kept == (rest >> 63 == 0), "count %u: rest %llx", count, (unsigned long long)rest);
    }
    free(keep);
    free(half);
}
END_TEST

static double alias_chi_square(const double *weights, int n, uint draws, uint key)
{
    AliasBucket buckets[600];
    double observed[600] = {0}, expected[600], sum = 0.0;
    Error error;
    test_require(alias_build(weights, (size_t)n, buckets, &error), "%s", error.message);
    for (int i = 0; i < n; ++i)
        sum += weights[i];
    for (int i = 0; i < n; ++i)
        expected[i] = weights[i] / sum * draws;
    for (uint k = 0; k < draws; ++k) {
        Random4 r = random_four(k, 0u, 0u, 0u, key, 7u);
        uint i = alias_sample(buckets, (uint)n, r.x[0], r.x[1]);
        test_require(weights[i] > 0.0, "index %u of weight 0", i);
        observed[i] += 1.0;
    }
    return test_chi_square(observed, expected, n);
}

/* Evenly spaced fractions give every index evenly spaced rests, in each of the up to three parts that it has. */
START_TEST(test_alias_rest)
{
    enum { N = 4096, BINS = 16 };
    static const double WEIGHTS[3] = {1.0, 3.0, 2.0};
    AliasBucket buckets[3];
    int counts[3][BINS] = {{0}};
    Error error;
    test_require(alias_build(WEIGHTS, 3, buckets, &error), "%s", error.message);
    for (uint k = 0; k < N; ++k) {
        float rest = -1.0f;
        uint bits = k * (0xffffffffu / N) + 0x7ffffu, i = alias_sample_rest(buckets, 3, bits, 12345u, &rest);
        test_require(i == alias_sample(buckets, 3, bits, 12345u), "another index");
        test_require(rest > 0.0f && rest < 1.0f, "rest %g", (double)rest);
        ++counts[i][(int)(rest * BINS)];
    }
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < BINS; ++k)
            test_require(fabs(counts[i][k] - WEIGHTS[i] / 6.0 * N / BINS) <= 6.0, "index %d, bin %d: %d", i, k,
                         counts[i][k]);
}
END_TEST

START_TEST(test_alias_chi_square)
{
    static const int SIZES[] = {2, 17, 600};
    double weights[600];
    uint64_t state = 32;
    for (int s = 0; s < 3; ++s) {
        for (int i = 0; i < SIZES[s]; ++i)
            weights[i] = alias_weight(_i, (size_t)i, (size_t)SIZES[s], &state);
        double p = alias_chi_square(weights, SIZES[s], 400000, (uint)(_i * 3 + s));
        test_require(p > 5e-5, "family %d, %d weights: p = %g", _i, SIZES[s], p); /* 18 tests: 1e-3 after Sidak */
    }
}
END_TEST

START_TEST(test_alias_refusals)
{
    AliasBucket buckets[2];
    Error error;
    static const double BAD[][2] = {{0.0, 0.0}, {1.0, -1.0}, {1.0, (double)NAN}, {HUGE_VAL, 1.0}, {1.7e308, 1.7e308}};
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; ++i) {
        error.message[0] = '\0';
        ck_assert(!alias_build(BAD[i], 2, buckets, &error));
        ck_assert(error.message[0] != '\0');
    }
    ck_assert(!alias_build(BAD[0], 0, buckets, &error));
}
END_TEST

TCase *test_math_alias(void)
{
    TCase *tcase = tcase_create("alias");
    tcase_set_timeout(tcase, 300.0);
    tcase_add_loop_test(tcase, test_alias_implied, 0, 7);
    tcase_add_loop_test(tcase, test_alias_chi_square, 0, 6);
    tcase_add_test(tcase, test_alias_rest);
    tcase_add_test(tcase, test_alias_arithmetic);
    tcase_add_test(tcase, test_alias_refusals);
    return tcase;
}
