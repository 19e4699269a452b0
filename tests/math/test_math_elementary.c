/* Functions of one argument: error bounds over all floats, special values, monotonicity. */
#include "math/test_math.h"

#include "math/elementary.h"

#include <mpfr.h>

typedef struct Unary {
    const char *name;
    float (*ours)(float x);
    int (*exact)(mpfr_t y, const mpfr_t x, mpfr_rnd_t rounding);
    double (*reference)(double x); /* the C library's, in double: its error is 1e-8 of a float ulp */
    double bound; /* in ulp, as stated in math/elementary.h */
} Unary;

static const Unary UNARY[] = {
    {"sin", float_sin, mpfr_sin, sin, 1.0},     {"cos", float_cos, mpfr_cos, cos, 1.0},
    {"exp", float_exp, mpfr_exp, exp, 1.0},     {"log", float_log, mpfr_log, log, 1.0},
    {"asin", float_asin, mpfr_asin, asin, 1.0}, {"acos", float_acos, mpfr_acos, acos, 1.0},
};
#define UNARY_COUNT ((int)(sizeof UNARY / sizeof UNARY[0]))

static double unary_exact(const Unary *unary, float x, mpfr_t argument, mpfr_t value)
{
    mpfr_set_flt(argument, x, MPFR_RNDN);
    unary->exact(value, argument, MPFR_RNDN);
    return mpfr_get_d(value, MPFR_RNDN);
}

static void unary_check(const Unary *unary, float x, double exact, double *worst)
{
    double error = test_ulp_error(unary->ours(x), exact);
    if (!(error <= unary->bound))
        ck_abort_msg("%s(%a): %a, exact %a: %g ulp", unary->name, (double)x, (double)unary->ours(x), exact, error);
    *worst = error > *worst ? error : *worst;
}

/* Every 32771st bit pattern (a prime, so that all exponents and signs occur) against MPFR. */
START_TEST(test_unary_mpfr)
{
    const Unary *unary = &UNARY[_i];
    mpfr_t argument, value;
    mpfr_inits2(64, argument, value, (mpfr_ptr)0);
    double worst = 0.0;
    for (uint64_t bits = 0; bits < UINT64_C(1) << 32; bits += 32771) {
        float x = bits_float((uint)bits);
        unary_check(unary, x, unary_exact(unary, x, argument, value), &worst);
    }
    mpfr_clears(argument, value, (mpfr_ptr)0);
    mpfr_free_cache();
    test_require(worst > 0.4, "worst > 0.4"); /* the sweep includes inexact results */
}
END_TEST

/* Every 521st bit pattern against double arithmetic. TWINLIGHT_TEST_STRIDE=1 tests all floats (minutes). */
START_TEST(test_unary_sweep)
{
    const Unary *unary = &UNARY[_i];
    const char *setting = getenv("TWINLIGHT_TEST_STRIDE");
    uint64_t stride = setting ? strtoull(setting, NULL, 10) : 521;
    double worst = 0.0;
    for (uint64_t bits = 0; bits < UINT64_C(1) << 32; bits += stride ? stride : 521) {
        float x = bits_float((uint)bits);
        unary_check(unary, x, unary->reference((double)x), &worst);
    }
    if (setting)
        printf("%s: %.4f ulp\n", unary->name, worst);
}
END_TEST

/* 1000 floats on either side of each breakpoint of the algorithms: error bounds against MPFR. */
START_TEST(test_unary_breakpoints)
{
    static const float POINTS[] = {0x1p-126f,  0x1p-12f,   0.5f,        0.70710678f, 0.78539816f, 1.0f,
                                   1.5707964f, 2.3561945f, 3.1415927f,  6.2831855f,  88.722839f,  87.336544f,
                                   103.27893f, 103.97208f, 200.0f,      314.15927f,  1e5f,        8388608.0f,
                                   1e22f,      FLOAT_MAX,  0.34657359f, 1.4142135f,  12867.963f,  66.0f};
    const Unary *unary = &UNARY[_i];
    mpfr_t argument, value;
    mpfr_inits2(64, argument, value, (mpfr_ptr)0);
    double worst = 0.0;
    for (size_t p = 0; p < sizeof POINTS / sizeof POINTS[0]; ++p)
        for (int offset = -1000; offset <= 1000; ++offset)
            for (uint sign = 0; sign < 2; ++sign) {
                float x = bits_float((float_bits(POINTS[p]) + (uint)offset) ^ (sign << 31));
                unary_check(unary, x, unary_exact(unary, x, argument, value), &worst);
            }
    mpfr_clears(argument, value, (mpfr_ptr)0);
}
END_TEST

/* The floats closest to multiples of pi/2, for which a poor argument reduction loses every bit (Muller, "Elementary
 * Functions", section 11.2: the worst for float32 is 16367173 x 2^72, at a distance of 1.6e-9). */
START_TEST(test_reduction_worst)
{
    static const float POINTS[] = {0x1.f37ce2p95f, 0x1.921fb6p0f, 0x1.921fb6p1f, 0x1.8bc2b2p87f, 0x1.fc2da2p10f};
    mpfr_t argument, value;
    mpfr_inits2(64, argument, value, (mpfr_ptr)0);
    double worst = 0.0;
    for (size_t p = 0; p < sizeof POINTS / sizeof POINTS[0]; ++p)
        for (int i = 0; i < 2; ++i)
            unary_check(&UNARY[i], POINTS[p], unary_exact(&UNARY[i], POINTS[p], argument, value), &worst);
    mpfr_clears(argument, value, (mpfr_ptr)0);
}
END_TEST

typedef struct Special {
    float (*function)(float x);
    uint x, y; /* as bits */
} Special;

static const Special SPECIALS[] = {
    {float_sin, 0x00000000u, 0x00000000u},
    {float_sin, 0x80000000u, 0x80000000u}, /* +0, -0 */
    {float_sin, 0x00000001u, 0x00000001u},
    {float_sin, 0x807fffffu, 0x807fffffu}, /* denormals */
    {float_sin, 0x7f800000u, 0x7fc00000u},
    {float_sin, 0xff800000u, 0x7fc00000u}, /* infinities */
    {float_sin, 0xffffffffu, 0x7fc00000u},
    {float_cos, 0x7f800001u, 0x7fc00000u}, /* NaN */
    {float_cos, 0x00000000u, 0x3f800000u},
    {float_cos, 0x80000001u, 0x3f800000u},
    {float_cos, 0x7f800000u, 0x7fc00000u},
    {float_exp, 0x00000000u, 0x3f800000u},
    {float_exp, 0x80000001u, 0x3f800000u},
    {float_exp, 0x7f800000u, 0x7f800000u},
    {float_exp, 0xff800000u, 0x00000000u},
    {float_exp, 0xff800001u, 0x7fc00000u},
    {float_exp, 0x42b17218u, 0x7f800000u},
    {float_exp, 0x7f7fffffu, 0x7f800000u}, /* 88.72284: overflow */
    {float_exp, 0x42b17217u, 0x7f7fff84u},
    {float_exp, 0xc2cff1b5u, 0x00000000u}, /* largest finite; e^-103.97208: underflow */
    {float_exp, 0xc2cff1b4u, 0x00000001u},
    {float_exp, 0xff7fffffu, 0x00000000u},
    {float_log, 0x00000000u, 0xff800000u},
    {float_log, 0x80000000u, 0xff800000u},
    {float_log, 0x7f800000u, 0x7f800000u},
    {float_log, 0xff800000u, 0x7fc00000u},
    {float_log, 0x80000001u, 0x7fc00000u},
    {float_log, 0x7f800001u, 0x7fc00000u},
    {float_log, 0x3f800000u, 0x00000000u},
    {float_log, 0x00000001u, 0xc2ce8ed0u}, /* log 1; log 2^-149 */
    {float_asin, 0x80000000u, 0x80000000u},
    {float_asin, 0x3f800000u, 0x3fc90fdbu},
    {float_asin, 0xbf800000u, 0xbfc90fdbu},
    {float_asin, 0x3f800001u, 0x7fc00000u},
    {float_asin, 0x00000001u, 0x00000001u},
    {float_asin, 0xff800000u, 0x7fc00000u},
    {float_acos, 0x3f800000u, 0x00000000u},
    {float_acos, 0xbf800000u, 0x40490fdbu},
    {float_acos, 0x00000000u, 0x3fc90fdbu},
    {float_acos, 0xbf800001u, 0x7fc00000u},
    {float_acos, 0x7fc00123u, 0x7fc00000u},
};

START_TEST(test_unary_specials)
{
    for (size_t i = 0; i < sizeof SPECIALS / sizeof SPECIALS[0]; ++i) {
        uint y = float_bits(SPECIALS[i].function(bits_float(SPECIALS[i].x)));
        test_require(y == SPECIALS[i].y, "special %zu: f(0x%08x) = 0x%08x, not 0x%08x", i, SPECIALS[i].x, y,
                     SPECIALS[i].y);
    }
}
END_TEST

/* Monotonicity between adjacent floats within `reach` of a breakpoint of the algorithm. rising: the function increases
 * with the bit pattern there. */
static void monotone_check(float (*function)(float x), float at, bool rising, int reach)
{
    uint first = float_bits(at) - (uint)reach;
    float last = function(bits_float(first));
    for (uint bits = first + 1; bits <= float_bits(at) + (uint)reach; ++bits) {
        float y = function(bits_float(bits));
        test_require(rising ? y >= last : y <= last, "not monotone at %a: %a after %a", (double)bits_float(bits),
                     (double)y, (double)last);
        last = y;
    }
}

START_TEST(test_unary_monotone)
{
    for (int k = -140; k < 127; ++k) {
        float at = (float)ldexp(0.70710678118654752, k);
        monotone_check(float_log, at, true, 50);
        monotone_check(float_exp, (float)fabs((k + 0.5) * 0.69314718055994531), true, 50);
    }
    for (int k = 0; k < 128; ++k) { /* breakpoints at quadrant changes, (k + 1/2) pi/2; the extrema are between them */
        float at = (float)((k + 0.5) * 1.5707963267948966);
        monotone_check(float_sin, at, k % 4 == 0 || k % 4 == 3, 50);
        monotone_check(float_cos, at, k % 4 == 2 || k % 4 == 3, 50);
    }
    monotone_check(float_sin, 200.0f, cos(200.0) > 0.0, 1000);
    monotone_check(float_cos, 200.0f, sin(200.0) < 0.0, 1000);
    monotone_check(float_asin, 0.5f, true, 1000);
    monotone_check(float_acos, 0.5f, false, 1000);
    monotone_check(float_acos, -0.5f, true, 1000);
    monotone_check(float_asin, 0x1.fff8p-1f, true, 128); /* up to 1 */
    monotone_check(float_acos, 0x1.fff8p-1f, false, 128);
}
END_TEST

START_TEST(test_sincos_same)
{
    for (uint64_t bits = 0; bits < UINT64_C(1) << 32; bits += 65537) {
        float x = bits_float((uint)bits), s, c;
        float_sincos(x, &s, &c);
        test_require(float_bits(s) == float_bits(float_sin(x)), "sin(%a)", (double)x);
        test_require(float_bits(c) == float_bits(float_cos(x)), "cos(%a)", (double)x);
        if (x != 0.0f && float_finite(x)) {
            test_require(float_sin(-x) == -s, "float_sin(-x) == -s");
            test_require(float_cos(-x) == c, "float_cos(-x) == c");
        }
    }
}
END_TEST

TCase *test_math_elementary(void)
{
    TCase *tcase = tcase_create("elementary");
    tcase_set_timeout(tcase, 3600.0);
    tcase_add_loop_test(tcase, test_unary_mpfr, 0, UNARY_COUNT);
    tcase_add_loop_test(tcase, test_unary_sweep, 0, UNARY_COUNT);
    tcase_add_loop_test(tcase, test_unary_breakpoints, 0, UNARY_COUNT);
    tcase_add_test(tcase, test_reduction_worst);
    tcase_add_test(tcase, test_unary_specials);
    tcase_add_test(tcase, test_unary_monotone);
    tcase_add_test(tcase, test_sincos_same);
    return tcase;
}
