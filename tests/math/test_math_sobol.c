/* Scrambled points of Sobol's sequence: the tables, how evenly samples fill their dimensions, and that scrambling keeps
 * every estimate unbiased. */
#include "math/test_math.h"

#include "math/sobol.h"

static Random4 seeds_draw(uint64_t *state)
{
    Random4 seeds;
    for (int i = 0; i < 4; ++i)
        seeds.x[i] = (uint)test_random(state);
    return seeds;
}

/* Direction numbers of the recurrence (Bratley and Fox 1988), the first at the top bit. polynomial: degree and inner
 * coefficients, as Joe and Kuo list them. */
static void directions_make(uint degree, uint polynomial, const uint *initial, uint directions[32])
{
    uint m[32];
    for (uint k = 0; k < 32; ++k) {
        m[k] = k < degree ? initial[k] : m[k - degree] ^ m[k - degree] << degree;
        for (uint j = 1; k >= degree && j < degree; ++j)
            m[k] ^= (polynomial >> (degree - 1 - j) & 1u) != 0 ? m[k - j] << j : 0u;
        directions[k] = m[k] << (31 - k);
    }
}

START_TEST(test_tables)
{
    static const uint DEGREES[3] = {1, 2, 3}, POLYNOMIALS[3] = {0, 1, 1}, INITIAL[3] = {1, 3, 1};
    uint64_t state = 40;
    for (uint d = 0; d < 3; ++d) {
        const uint initial[3] = {1, d == 0 ? 1 : INITIAL[1], INITIAL[2]};
        uint directions[32];
        directions_make(DEGREES[d], POLYNOMIALS[d], initial, directions);
        for (int trial = 0; trial < 1000; ++trial) {
            uint index = (uint)test_random(&state), sum = 0;
            for (uint k = 0; k < 32; ++k)
                sum ^= (index >> k & 1u) != 0 ? directions[k] : 0u;
            uint got = bits_reversed(sobol_sum(d, bits_reversed(index)));
            test_require(got == sum, "dimension %u, index %x: %x, not %x", d + 2, index, got, sum);
        }
    }
}
END_TEST

/* A bit of an Owen scrambling flips by the seed and the more significant bits alone (here: in reversed order). */
START_TEST(test_nested)
{
    uint64_t state = 41;
    for (int trial = 0; trial < 20000; ++trial) {
        uint seed = (uint)test_random(&state), x = (uint)test_random(&state), k = (uint)trial % 32u;
        uint other = (x & ((2u << k) - 1u)) | ((uint)test_random(&state) & ~((2u << k) - 1u));
        uint differs = owen_scrambled(x, seed) ^ owen_scrambled(other, seed);
        test_require((differs & ((2u << k) - 1u)) == 0u, "bit %u", k);
        uint flipped = owen_scrambled(x, seed) ^ owen_scrambled(x ^ 1u << k, seed);
        test_require((flipped & ((2u << k) - 1u)) == 1u << k, "bit %u", k);
    }
}
END_TEST

/* Every 2^m samples from a multiple of 2^m on have one point in each of the 2^m intervals of every dimension, and the
 * best pair one in each box of 2^-a x 2^(a-m): a (0, m, 2)-net. */
START_TEST(test_stratified)
{
    enum { M = 8, BLOCKS = 20 };
    uint64_t state = 42;
    for (int trial = 0; trial < BLOCKS; ++trial) {
        Random4 seeds = seeds_draw(&state);
        uint pair = (uint)trial % 4u;
        for (uint m = 0; m <= M; ++m) {
            uint count = 1u << m, begin = ((uint)test_random(&state) >> 12) * count;
            unsigned char seen[4 + M + 1][1 << M] = {{0}};
            for (uint i = 0; i < count; ++i) {
                Random4 point = sobol_four(begin + i, seeds, pair);
                for (uint d = 0; d < 4; ++d)
                    ++seen[d][(uint)((uint64_t)point.x[d] >> (32 - m))];
                uint64_t x = point.x[pair], y = point.x[(pair + 1u) & 3u];
                for (uint a = 0; a <= m; ++a)
                    ++seen[4 + a][(uint)(x >> (32 - a) << (m - a) | y >> (32 - (m - a)))];
            }
            for (uint k = 0; k < 4 + m + 1; ++k)
                for (uint i = 0; i < count; ++i)
                    test_require(seen[k][i] == 1, "2^%u samples, partition %u: %d in one cell", m, k, seen[k][i]);
        }
    }
}
END_TEST

/* Mean and variance over scramblings of the mean of f over the first `count` samples. f: of two dimensions. */
static void estimate(int first, uint count, int trials, double (*f)(double, double), double *mean, double *variance)
{
    double sum = 0.0, squares = 0.0;
    uint64_t state = 43;
    for (int trial = 0; trial < trials; ++trial) {
        Random4 seeds = seeds_draw(&state);
        double value = 0.0;
        for (uint i = 0; i < count; ++i) {
            Random4 point = sobol_four(i, seeds, 0);
            value += f((double)random_float(point.x[first]), (double)random_float(point.x[first + 1])) / count;
        }
        sum += value;
        squares += value * value;
    }
    *mean = sum / trials;
    *variance = squares / trials - *mean * *mean;
}

static double smooth(double x, double y)
{
    return 4.0 * x * y * y * exp(x);
}
#define SMOOTH_MEAN (4.0 / 3.0)

static double step(double x, double y)
{
    return x + y < 0.7 ? 1.0 : 0.0;
}
#define STEP_MEAN 0.245

/* The mean is right for any number of samples; the variance falls faster than 1 / N: of a smooth function at least as 1
 * / N^2, of one with an edge at least as N^-1.2. */
START_TEST(test_convergence)
{
    enum { TRIALS = 4000 };
    static const uint COUNTS[4] = {1, 5, 16, 256};
    for (int pair = 0; pair < 2; ++pair)
        for (int edge = 0; edge < 2; ++edge) {
            double mean[4], variance[4], expected = edge ? STEP_MEAN : SMOOTH_MEAN;
            for (int k = 0; k < 4; ++k) {
                estimate(2 * pair, COUNTS[k], TRIALS, edge ? step : smooth, &mean[k], &variance[k]);
                test_require(fabs(mean[k] - expected) <= 4.5 * sqrt(variance[k] / TRIALS) + 1e-5,
                             "pair %d, edge %d, %u samples: mean %g, not %g", pair, edge, COUNTS[k], mean[k], expected);
            }
            double slope = log(variance[3] / variance[2]) / log(16.0);
            printf("pair %d, edge %d: variance %.3g alone, %.3g of 16, %.3g of 256, slope %.2f\n", pair, edge,
                   variance[0], variance[2], variance[3], slope);
            test_require(variance[2] < variance[0] / 20.0, "16 samples: variance %g of %g", variance[2], variance[0]);
            test_require(slope < (edge ? -1.2 : -2.0), "pair %d, edge %d: slope %g", pair, edge, slope);
        }
}
END_TEST

/* Sets with other seeds are padded: over scramblings, the products of their numbers at the same sample average to the
 * product of the averages. Samples 2 k and 2 k + 1 are in opposite halves of both, so that the variance may be up to
 * twice that of independent numbers. */
START_TEST(test_padded)
{
    enum { TRIALS = 4000, COUNT = 16 };
    uint64_t state = 44;
    double sum = 0.0, squares = 0.0;
    for (int trial = 0; trial < TRIALS; ++trial) {
        Random4 a = seeds_draw(&state), b = seeds_draw(&state);
        double value = 0.0;
        for (uint i = 0; i < COUNT; ++i)
            value += ((double)random_float(sobol_four(i, a, 0).x[0]) - 0.5) *
                     ((double)random_float(sobol_four(i, b, 0).x[0]) - 0.5) / COUNT;
        sum += value;
        squares += value * value;
    }
    double variance = squares / TRIALS - sum / TRIALS * (sum / TRIALS), independent = 1.0 / 144.0 / COUNT;
    test_require(fabs(sum / TRIALS) < 4.0 * sqrt(variance / TRIALS), "mean %g", sum / TRIALS);
    test_require(variance < 2.0 * independent, "variance %g, not %g", variance, independent);
}
END_TEST

TCase *test_math_sobol(void)
{
    TCase *tcase = tcase_create("sobol");
    tcase_set_timeout(tcase, 60.0);
    tcase_add_test(tcase, test_tables);
    tcase_add_test(tcase, test_nested);
    tcase_add_test(tcase, test_stratified);
    tcase_add_test(tcase, test_convergence);
    tcase_add_test(tcase, test_padded);
    return tcase;
}
