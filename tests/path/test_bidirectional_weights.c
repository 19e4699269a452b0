/* Weights of strategies from densities: against long double, at the limits of float's range, and their sum. */
#include "path/bidirectional_path.h"
#include "support/bidirectional.h"

#include "support/test_files.h"

#include <string.h>

/* Straight from the definition: densities as full products, in long double, whose exponent has 15 bits. */
static long double exact_density(const TestPath *path, uint s)
{
    long double product = s == 1 ? (long double)path->connect : 1.0L;
    for (uint i = 1; i <= path->k; ++i)
        product *= i <= path->k - s ? (long double)path->camera[i] : (long double)path->light[i];
    return product;
}

/* Returns the largest error of a weight. */
static double path_check(const TestPath *path, uint set, uint exponent)
{
    long double sum = 0.0L, path_tracing = 0.0L;
    double weights = 0.0, worst = 0.0;
    bool any = false;
    for (uint s = 0; s <= path->k; ++s)
        if (test_path_possible(path, set, s)) {
            sum += powl(exact_density(path, s), exponent);
            if (s < 2)
                path_tracing = sum;
        }
    for (uint s = 0; s <= path->k; ++s) {
        if (!test_path_possible(path, set, s))
            continue;
        long double expected = powl(exact_density(path, s), exponent) / sum;
        const StrategyWeights both = test_path_weights(path, set, exponent, s);
        double weight = (double)both.own;
        TEST_NEAR(weight, expected, 1e-5); /* the requirement is 1e-4 */
        TEST_NEAR(both.path_tracing, path_tracing / sum, 1e-5); /* independent of s */
        worst = fmax(worst, fabs(weight - (double)expected));
        weights += weight;
        any = true;
    }
    if (any)
        TEST_NEAR(weights, 1.0, 1e-5);
    return worst;
}

static const uint SETS[] = {STRATEGIES_PT, STRATEGIES_IBPT, STRATEGIES_BDPT};

static void path_draw(TestPath *path, unsigned *state, uint k, double octaves)
{
    path->k = k;
    path->connect = (float)exp2(6.0 * test_random_unit(state) - 3.0);
    path->hittable = test_random_unit(state) < 0.8;
    for (uint i = 1; i <= k; ++i) {
        path->camera[i] = (float)exp2(octaves * (2.0 * test_random_unit(state) - 1.0));
        path->light[i] = (float)exp2(octaves * (2.0 * test_random_unit(state) - 1.0));
        path->delta[i] = i < k && test_random_unit(state) < 0.25;
    }
    path->delta[0] = false;
    if (!path->hittable)
        path->camera[k] = 0.0f;
}

START_TEST(test_random_paths)
{
    static const double OCTAVES[] = {0.5, 3.0, 30.0};
    unsigned state = 17;
    TestPath path;
    for (int i = 0; i < 20000; ++i) {
        path_draw(&path, &state, 1 + (uint)(i % 20), OCTAVES[i % 3]);
        path_check(&path, SETS[i / 3 % 3], 1 + (uint)(i & 1));
    }
}
END_TEST

/* The weight by nested float ratios, 1 / (1 + r1 (1 + r2 (...)) ...), which never forms a product over the whole path
 * but overflows if ratios are large far from the connection and small near it. */
static float nested_weight(const TestPath *path, uint s)
{
    float up = 0.0f, down = 0.0f;
    for (uint i = path->k; i > s; --i) /* strategies s + 1 ... k */
        up = path->light[path->k - i + 1] / path->camera[path->k - i + 1] * (1.0f + up);
    for (uint i = 1; i <= s; ++i) /* s - 1 ... 0 */
        down = path->camera[path->k - i + 1] / path->light[path->k - i + 1] * (1.0f + down);
    return 1.0f / (1.0f + up + down);
}

/* Largest error of the weights by nested ratios. */
static double nested_check(const TestPath *path)
{
    long double sum = 0.0L;
    double worst = 0.0;
    for (uint s = 0; s <= path->k; ++s)
        sum += exact_density(path, s);
    for (uint s = 0; s <= path->k; ++s) {
        double error = (double)fabsl((long double)nested_weight(path, s) - exact_density(path, s) / sum);
        worst = isnan(error) ? HUGE_VAL : fmax(worst, error);
    }
    return worst;
}

/* Ratios of 2^60 and 2^-60 at each of 20 vertices: their products are far outside float's range and, squared and taken
 * over the whole path, even outside long double's. */
START_TEST(test_ratios_of_sixty_octaves)
{
    static const int SIGNS[][2] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    TestPath path = {.k = 20, .connect = 1.0f, .hittable = true};
    for (int octaves = 3; octaves <= 60; octaves += 57) {
        double worst = 0.0, worst_nested = 0.0;
        for (uint turn = 1; turn <= 80; ++turn) {
            const int *signs = SIGNS[turn % 4];
            for (uint i = 1; i <= 20; ++i) {
                path.camera[i] = 1.3f;
                path.light[i] = 0.7f * (float)exp2(octaves * signs[i < (turn + 3) / 4 ? 0 : 1]);
            }
            for (uint set = 0; set < 3; ++set)
                for (uint exponent = 1; exponent <= 2; ++exponent)
                    worst = fmax(worst, path_check(&path, SETS[set], exponent));
            worst_nested = fmax(worst_nested, nested_check(&path));
        }
        printf("ratios of 2^+-%d, 20 segments: weights off by up to %.2g; nested ratios of floats by %.2g\n", octaves,
               worst, worst_nested);
        ck_assert((worst_nested < 1e-5) == (octaves == 3));
    }
}
END_TEST

/* Zero or infinite densities: weights stay in [0, 1] and are never NaN, and a strategy without density gets no
 * weight. */
START_TEST(test_extremes)
{
    static const float VALUES[] = {0.0f, 1e-45f, 1e-38f, 1.0f, 3e38f, INFINITY};
    TestPath path = {.k = 4, .connect = 1.0f, .hittable = true};
    for (int i = 0; i < 6 * 6 * 6 * 6; ++i) {
        int digits[4] = {i % 6, i / 6 % 6, i / 36 % 6, i / 216};
        for (uint j = 1; j <= 4; ++j)
            path.camera[j] = path.light[j] = 1.0f;
        path.camera[2] = VALUES[digits[0]];
        path.light[2] = VALUES[digits[1]];
        path.camera[3] = VALUES[digits[2]];
        path.light[3] = VALUES[digits[3]];
        for (uint s = 0; s <= 4; ++s)
            for (uint exponent = 1; exponent <= 2; ++exponent) {
                float weight = test_path_weight(&path, STRATEGIES_BDPT, exponent, s);
                TEST_TRUE(weight >= 0.0f && weight <= 1.0f);
            }
    }
    for (uint j = 1; j <= 4; ++j)
        path.camera[j] = path.light[j] = 1.0f;
    path.light[2] = 0.0f; /* needed by (3,2) and (4,1) */
    for (uint s = 0; s <= 2; ++s)
        TEST_NEAR(test_path_weight(&path, STRATEGIES_BDPT, 2, s), 1.0 / 3.0, 1e-6);
    path.light[2] = 1.0f;
    path.camera[2] = INFINITY; /* sampled with certainty from the camera */
    TEST_NEAR(test_path_weight(&path, STRATEGIES_BDPT, 2, 3), 0.0, 0.0);
    TEST_NEAR(test_path_weight(&path, STRATEGIES_BDPT, 2, 4), 0.0, 0.0);
}
END_TEST

START_TEST(test_connectable_edges)
{
    for (uint delta = 0; delta < 64; delta += 2)
        for (uint i = 1; i < 6; ++i)
            TEST_TRUE(edge_connectable(delta, i) == ((delta >> i & 1) == 0 && (i == 1 || (delta >> (i - 1) & 1) == 0)));
    TEST_TRUE(!edge_connectable(0x80000000u, 31));
    TEST_TRUE(edge_connectable(0x1fffffffu, 31));
}
END_TEST

START_TEST(test_sets)
{
    TEST_TRUE(strategy_taken(STRATEGIES_PT, 0, 1) && !strategy_taken(STRATEGIES_BDPT, 1, 1));
    for (uint k = 2; k < 8; ++k)
        for (uint s = 0; s <= k; ++s) {
            TEST_TRUE(strategy_taken(STRATEGIES_PT, s, k) == (s <= 1));
            TEST_TRUE(strategy_taken(STRATEGIES_IBPT, s, k) == (s <= 1 || s == k));
            TEST_TRUE(strategy_taken(STRATEGIES_BDPT, s, k));
            TEST_TRUE(strategy_taken(STRATEGIES_BDPT & ~STRATEGY_CAMERA_DIRECT, s, k) == !(s == 2 && k == 2));
        }
}
END_TEST

/* ---- numbers with a large exponent ------------------------------------------------------------------------------- */

static long double scaled_exact(Scaled a)
{
    return ldexpl((long double)a.value, a.exponent);
}

static void scaled_check(Scaled got, long double expected)
{
    TEST_TRUE(got.value == 0.0f ? got.exponent == 0 : got.value >= SCALED_LEAST && got.value < SCALED_MOST);
    TEST_TRUE(fabsl(scaled_exact(got) - expected) <= 2e-7L * expected);
}

START_TEST(test_scaled)
{
    unsigned state = 3;
    for (int i = 0; i < 100000; ++i) {
        float a = bits_float((uint)(test_random_unit(&state) * 0x7f7fffff)),
              b = bits_float((uint)(test_random_unit(&state) * 0x7f7fffff));
        Scaled x = scaled_from(a), y = scaled_from(b), z = scaled_multiply(scaled_multiply(x, x), scaled_divide(x, y));
        scaled_check(x, (long double)a);
        scaled_check(scaled_multiply(x, y), (long double)a * (long double)b);
        scaled_check(scaled_add(x, y), (long double)a + (long double)b);
        if (b > 0.0f)
            scaled_check(z, (long double)a * (long double)a * ((long double)a / (long double)b));
        if (a >= 1.17549435e-38f)
            TEST_TRUE(scaled_float(x) == a);
    }
    Scaled zero = scaled_zero(), infinite = scaled_from(INFINITY), one = scaled_from(1.0f);
    TEST_TRUE(scaled_float(zero) == 0.0f && scaled_float(infinite) == INFINITY);
    TEST_TRUE(scaled_float(scaled_multiply(zero, infinite)) == 0.0f && scaled_float(scaled_divide(zero, zero)) == 0.0f);
    TEST_TRUE(scaled_float(scaled_divide(infinite, infinite)) == 1.0f &&
              scaled_float(scaled_divide(one, infinite)) == 0.0f);
    TEST_TRUE(scaled_is_infinite(scaled_divide(one, zero)) && scaled_is_infinite(scaled_add(one, infinite)));
    TEST_TRUE(scaled_is_infinite(scaled_multiply(infinite, scaled_from(1e-30f))));
    TEST_TRUE(scaled_float(scaled_from(NAN)) == 0.0f && scaled_float(scaled_from(-1.0f)) == 0.0f);
    TEST_TRUE(scaled_float(scaled_add(zero, one)) == 1.0f);
}
END_TEST

TCase *bidirectional_weights_case(void)
{
    TCase *tcase = tcase_create("weights");
    tcase_add_test(tcase, test_scaled);
    tcase_add_test(tcase, test_sets);
    tcase_add_test(tcase, test_connectable_edges);
    tcase_add_test(tcase, test_random_paths);
    tcase_add_test(tcase, test_ratios_of_sixty_octaves);
    tcase_add_test(tcase, test_extremes);
    return tcase;
}
