/* Functions of two arguments: pow and atan2. */
#include "math/test_math.h"

#include "math/elementary.h"

#include <mpfr.h>

/* A y such that x^y is of ordinary size (most pairs of floats overflow). */
static float power_exponent(float x, uint64_t *state)
{
    double limit = 128.0 / fmax(fabs(log2((double)x)), 1e-30);
    return (float)(limit * (2.3 * (double)test_uniform(state) - 1.15));
}

START_TEST(test_pow_mpfr)
{
    mpfr_t a, b, value;
    mpfr_inits2(64, a, b, value, (mpfr_ptr)0);
    uint64_t state = 1;
    double worst = 0.0;
    for (int i = 0; i < 300000; ++i) {
        uint bits = (uint)test_random(&state);
        float x = bits_float(i % 3 == 0 ? bits >> 1 : 0x3f800000u + (bits & 0x00ffffffu) - 0x00800000u);
        if (!(x > 0.0f) || !float_finite(x))
            continue;
        float y = i % 5 == 0 ? bits_float((uint)test_random(&state)) : power_exponent(x, &state);
        mpfr_set_flt(a, x, MPFR_RNDN);
        mpfr_set_flt(b, y, MPFR_RNDN);
        mpfr_pow(value, a, b, MPFR_RNDN);
        double exact = x == 1.0f ? 1.0 : mpfr_get_d(value, MPFR_RNDN);
        double error = test_ulp_error(float_pow(x, y), exact);
        test_require(error <= 2.0, "pow(%a, %a) = %a: %g ulp", (double)x, (double)y, (double)float_pow(x, y), error);
        worst = error > worst ? error : worst;
    }
    mpfr_clears(a, b, value, (mpfr_ptr)0);
    mpfr_free_cache();
    test_require(worst > 0.4, "worst > 0.4");
}
END_TEST

START_TEST(test_pow_sweep)
{
    static const float EXPONENTS[] = {2.0f, 0.5f,        -1.0f,       1.0f / 2.4f, 2.4f,
                                      5.0f, 1.0f / 3.0f, 0.45454545f, -2.2f,       100.0f};
    for (size_t e = 0; e < sizeof EXPONENTS / sizeof EXPONENTS[0]; ++e)
        for (uint bits = 1; bits < 0x7f800000u; bits += 16411) {
            float x = bits_float(bits), y = EXPONENTS[e];
            double error = test_ulp_error(float_pow(x, y), pow((double)x, (double)y));
            test_require(error <= 2.0, "pow(%a, %a): %g ulp", (double)x, (double)y, error);
        }
}
END_TEST

static const float EDGES[] = {0.0f,  0x1p-149f,      0x1.8p-127f, 0x1p-126f,     1e-20f,  0.25f,
                              0.5f,  0x1.fffffep-1f, 1.0f,        0x1.000002p0f, 1.5f,    2.0f,
                              1e20f, 0x1p126f,       0x1p127f,    FLOAT_MAX,     INFINITY};
#define EDGE_COUNT ((int)(sizeof EDGES / sizeof EDGES[0]))

START_TEST(test_pow_specials)
{
    for (int i = 0; i < EDGE_COUNT; ++i)
        for (int j = 0; j < EDGE_COUNT; ++j)
            for (int sign = -1; sign <= 1; sign += 2) {
                float x = EDGES[i], y = EDGES[j] * (float)sign;
                double exact = pow((double)x, (double)y), error = test_ulp_error(float_pow(x, y), exact);
                test_require(error <= 2.0, "pow(%a, %a) = %a, exact %a", (double)x, (double)y, (double)float_pow(x, y),
                             exact);
            }
    float nan = FLOAT_NAN;
    test_require(float_pow(nan, 0.0f) == 1.0f && float_pow(1.0f, nan) == 1.0f && float_pow(nan, -0.0f) == 1.0f,
                 "float_pow(nan, 0.0f) == 1.0f && float_pow(1.0f, nan) == 1.0f && float_pow(nan, -0.0f) == 1.0f");
    ck_assert_uint_eq(float_bits(float_pow(bits_float(0xffc12345u), 2.0f)), 0x7fc00000u);
    ck_assert_uint_eq(float_bits(float_pow(2.0f, bits_float(0x7f812345u))), 0x7fc00000u);
    ck_assert_uint_eq(float_bits(float_pow(-1.0f, 2.0f)), 0x7fc00000u);
    ck_assert_uint_eq(float_bits(float_pow(-0.0f, 3.0f)), 0u);
    ck_assert_uint_eq(float_bits(float_pow(-0.0f, -3.0f)), 0x7f800000u);
}
END_TEST

static double atan2_exact(float y, float x, mpfr_t a, mpfr_t b, mpfr_t value)
{
    mpfr_set_flt(a, y, MPFR_RNDN);
    mpfr_set_flt(b, x, MPFR_RNDN);
    mpfr_atan2(value, a, b, MPFR_RNDN);
    return mpfr_get_d(value, MPFR_RNDN);
}

/* A third of the pairs are arbitrary floats, the others of similar size or next to a breakpoint of the argument
 * reduction. */
START_TEST(test_atan2_mpfr)
{
    mpfr_t a, b, value;
    mpfr_inits2(64, a, b, value, (mpfr_ptr)0);
    uint64_t state = 2;
    double worst = 0.0;
    for (int i = 0; i < 300000; ++i) {
        uint64_t r = test_random(&state);
        float x = bits_float((uint)r), y = bits_float((uint)(r >> 32));
        if (i % 3 == 1)
            y = x * (4.0f * test_uniform(&state) - 2.0f);
        if (i % 3 == 2)
            y = bits_float(float_bits(x * (i % 2 ? 0.5f : 1.0f)) + (uint)(r >> 60) - 8u);
        if (isnan(x) || isnan(y))
            continue;
        double error = test_ulp_error(float_atan2(y, x), atan2_exact(y, x, a, b, value));
        test_require(error <= 2.0, "atan2(%a, %a) = %a: %g ulp", (double)y, (double)x, (double)float_atan2(y, x),
                     error);
        worst = error > worst ? error : worst;
    }
    mpfr_clears(a, b, value, (mpfr_ptr)0);
    mpfr_free_cache();
    test_require(worst > 0.4, "worst > 0.4");
}
END_TEST

START_TEST(test_atan2_specials)
{
    for (int i = 0; i < EDGE_COUNT; ++i)
        for (int j = 0; j < EDGE_COUNT; ++j)
            for (int signs = 0; signs < 4; ++signs) {
                float y = signs & 1 ? -EDGES[i] : EDGES[i], x = signs & 2 ? -EDGES[j] : EDGES[j];
                double exact = atan2((double)y, (double)x);
                float angle = float_atan2(y, x);
                test_require(test_ulp_error(angle, exact) <= 2.0, "atan2(%a, %a) = %a", (double)y, (double)x,
                             (double)angle);
                ck_assert_int_eq(signbit(angle) != 0, signbit(y) != 0);
            }
    ck_assert_uint_eq(float_bits(float_atan2(FLOAT_NAN, 1.0f)), 0x7fc00000u);
    ck_assert_uint_eq(float_bits(float_atan2(INFINITY, bits_float(0xffffffffu))), 0x7fc00000u);
}
END_TEST

/* Increasing y at fixed x, densely where the ratio crosses 1/2, 1 and 2. */
START_TEST(test_atan2_monotone)
{
    static const float POINTS[] = {0.25f, 0.5f, 1.0f, 2.0f, 4.0f};
    for (size_t p = 0; p < sizeof POINTS / sizeof POINTS[0]; ++p)
        for (int side = 0; side < 2; ++side) {
            float last = 0.0f;
            for (uint bits = float_bits(POINTS[p]) - 1000u; bits <= float_bits(POINTS[p]) + 1000u; ++bits) {
                float angle = float_atan2(bits_float(bits), side ? -1.0f : 1.0f);
                test_require(last == 0.0f || (side ? angle <= last : angle >= last),
                             "last == 0.0f || (side ? angle <= last : angle >= last)");
                last = angle;
            }
        }
}
END_TEST

TCase *test_math_elementary_pairs(void)
{
    TCase *tcase = tcase_create("elementary pairs");
    tcase_set_timeout(tcase, 300.0);
    tcase_add_test(tcase, test_pow_mpfr);
    tcase_add_test(tcase, test_pow_sweep);
    tcase_add_test(tcase, test_pow_specials);
    tcase_add_test(tcase, test_atan2_mpfr);
    tcase_add_test(tcase, test_atan2_specials);
    tcase_add_test(tcase, test_atan2_monotone);
    return tcase;
}
