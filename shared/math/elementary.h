/* Elementary functions from + - * / and the square root of float32 alone, so that they give the same bits in C and in
 * OpenCL C; the languages' own versions differ by an ulp between libraries. No fused multiply-add, no double.
 *
 * Bounds on the error, in units in the last place of the exact result (tests/math/test_math_elementary.c measures them
 * against MPFR):
 *
 *     float_sin, float_cos    1      every finite float          +-inf, NaN -> NaN
 *     float_exp               1      denormal results included   overflow -> inf, underflow -> 0
 *     float_log               1      every positive float        +-0 -> -inf, negative -> NaN
 *     float_pow               2      x >= 0                      see there
 *     float_asin, float_acos  1      |x| <= 1                    outside -> NaN
 *     float_atan2             2      every pair                  as in C11 F.10.1.4
 *
 * The only NaN that they return is 0x7fc00000. Denormals are kept. Polynomials interpolate at Chebyshev nodes of the
 * reduced interval; their coefficients are rounded to float32. */
#ifndef TWINLIGHT_MATH_ELEMENTARY_H
#define TWINLIGHT_MATH_ELEMENTARY_H

#include "math/platform.h"

#define FLOAT_NAN bits_float(0x7fc00000u)

#ifndef PLATFORM_DOUBLE

/* ---- exact building blocks (Dekker 1971) ---------------------------------------------------------------------- */

/* The upper 12 of the 24 significant bits of x. The rest, x minus that, has the lower 12, so products of such parts are
 * exact. */
SHARED_FUNCTION float float_upper_half(float x)
{
    return bits_float(float_bits(x) & 0xfffff000u);
}

/* a b - product, exactly, where product = a b rounded and nothing under- or overflows. */
SHARED_FUNCTION float float_product_error(float a, float b, float product)
{
    float a_upper = float_upper_half(a);
    float b_upper = float_upper_half(b);
    float a_lower = a - a_upper;
    float b_lower = b - b_upper;
    return ((a_upper * b_upper - product) + a_upper * b_lower + a_lower * b_upper) + a_lower * b_lower;
}

/* x 2^k for -280 <= k <= 254, rounded once when x is normal: two powers of two, for 2^k alone may not be a float. */
SHARED_FUNCTION float float_scale(float x, int k)
{
    int first = k / 2;
    float a = bits_float((uint)(first + 127) << 23);
    float b = bits_float((uint)(k - first + 127) << 23);
    return x * a * b;
}

/* ---- sine and cosine ------------------------------------------------------------------------------------------ */

/* 2/pi as a fixed-point number of seven words behind a word of zeros. */
__constant uint TWO_OVER_PI[8] = {0u,          0xa2f9836eu, 0x4e441529u, 0xfc2757d1u,
                                  0xf534ddc0u, 0xdb629599u, 0x3c439041u, 0xfe5163abu};

/* The upper 64 bits of a 64x64-bit product, less at most 3. */
SHARED_FUNCTION ulong ulong_product_upper(ulong a, ulong b)
{
    ulong a_upper = a >> 32, a_lower = a & 0xffffffffu;
    ulong b_upper = b >> 32, b_lower = b & 0xffffffffu;
    return a_upper * b_upper + ((a_upper * b_lower) >> 32) + ((a_lower * b_upper) >> 32);
}

/* x - k pi/2 as upper + lower for a finite x >= 2^6 given by its bits: x 2/pi modulo 4 from the only 96 bits of 2/pi
 * that matter (Payne and Hanek 1983). Returns k modulo 4. */
SHARED_FUNCTION uint angle_reduce_large(uint bits, float *upper, float *lower)
{
    uint mantissa = (bits & 0x007fffffu) | 0x00800000u;
    uint first_bit = (bits >> 23) - 127u - 23u - 2u + 32u; /* wraps to a small number when the exponent is small */
    uint word = first_bit >> 5, shift = first_bit & 31u;
    uint carry_shift = 31u - shift;
    uint w0 = (TWO_OVER_PI[word] << shift) | ((TWO_OVER_PI[word + 1u] >> 1) >> carry_shift);
    uint w1 = (TWO_OVER_PI[word + 1u] << shift) | ((TWO_OVER_PI[word + 2u] >> 1) >> carry_shift);
    uint w2 = (TWO_OVER_PI[word + 2u] << shift) | ((TWO_OVER_PI[word + 3u] >> 1) >> carry_shift);
    ulong turn = ((ulong)(mantissa * w0) << 32) + (ulong)mantissa * w1 + (((ulong)mantissa * w2) >> 32);
    ulong quadrant = (turn + 0x2000000000000000u) >> 62;
    ulong rest = turn - (quadrant << 62);
    bool negative = (rest >> 63) != 0u;
    ulong angle = ulong_product_upper(negative ? 0u - rest : rest, 0xc90fdaa22168c234u);
    float scale = negative ? -4.336808690e-19f : 4.336808690e-19f; /* 2^-61 */
    float a = (float)angle;
    *upper = a * scale;
    *lower = (angle >= (ulong)a ? (float)(angle - (ulong)a) : -(float)((ulong)a - angle)) * scale;
    return (uint)quadrant;
}

/* x - k pi/2 as upper + lower, |upper| <= pi/4, for x >= 0 given by its bits. Returns k modulo 4. Up to 201 pi/2 is
 * subtracted in three parts, the first two of 17 bits, so that k times them is exact (Cody and Waite 1980). */
SHARED_FUNCTION uint angle_reduce(uint bits, float *upper, float *lower)
{
    if (bits >= 0x43480000u) /* 200 */
        return angle_reduce_large(bits, upper, lower);
    float x = bits_float(bits);
    uint quadrant = (uint)(int)(x * 0.636619772f + 0.5f);
    float k = (float)(int)quadrant;
    float first = x - k * 1.57078552f;
    float second = k * 1.08042732e-05f;
    float difference = first - second;
    float tail = ((first - difference) - second) - k * 6.07710063e-11f;
    *upper = difference + tail;
    *lower = (difference - *upper) + tail;
    return quadrant & 3u;
}

/* Sine and cosine of x radians. */
SHARED_FUNCTION void float_sincos(float x, float *sine, float *cosine)
{
    uint bits = float_bits(x) & ~FLOAT_SIGN_BIT;
    if (bits >= 0x7f800000u) {
        *sine = FLOAT_NAN;
        *cosine = FLOAT_NAN;
        return;
    }
    float r, low;
    uint quadrant = angle_reduce(bits, &r, &low);
    float z = r * r;
    float s = r + (r * z * (-0.166666672f + z * (0.00833333191f - z * (0.000198400856f - z * 2.72498505e-06f))) + low);
    float half_square = 0.5f * z;
    float c = 1.0f - half_square;
    c = c +
        (((1.0f - c) - half_square) + (z * z * (0.0416666642f - z * (0.00138883025f - z * 2.45478805e-05f)) - r * low));
    /* Exchanged in odd quadrants without a branch: no processor predicts quadrants. */
    uint swap = (float_bits(s) ^ float_bits(c)) & (0u - (quadrant & 1u));
    *sine = bits_float(float_bits(s) ^ swap ^ ((quadrant & 2u) << 30) ^ (float_bits(x) & FLOAT_SIGN_BIT));
    *cosine = bits_float(float_bits(c) ^ swap ^ (((quadrant + 1u) & 2u) << 30));
}

SHARED_FUNCTION float float_sin(float x)
{
    float sine, cosine;
    float_sincos(x, &sine, &cosine);
    return sine;
}

SHARED_FUNCTION float float_cos(float x)
{
    float sine, cosine;
    float_sincos(x, &sine, &cosine);
    return cosine;
}

/* ---- exponential and logarithm -------------------------------------------------------------------------------- */

/* e^x = 2^k e^r with |r| <= ln(2) / 2. */
SHARED_FUNCTION float float_exp(float x)
{
    float bounded = float_clamp(x, -105.0f, 89.0f); /* e^-105 rounds to 0, e^89 to infinity; a NaN becomes -105 */
    int k = (int)(bounded * 1.44269502f + 200.5f) - 200;
    float n = (float)k;
    float upper = bounded - n * 0.693145752f; /* exact: 15 bits of ln 2 */
    float lower = n * 1.42860677e-06f;
    float r = upper - lower;
    float low = (upper - r) - lower;
    float p = 0.5f + r * (0.166665763f + r * (0.0416665561f + r * (0.00836321246f + r * 0.00139262248f)));
    float y = float_scale(1.0f + (r + (r * r * p + low)), k);
    return x != x ? FLOAT_NAN : y;
}

/* Splits a positive finite x into m 2^e with sqrt(1/2) <= m < sqrt(2). */
SHARED_FUNCTION float float_split(float x, int *e)
{
    uint bits = float_bits(x);
    int bias = 127;
    if (bits < 0x00800000u) {
        bits = float_bits(x * 8388608.0f);
        bias = 150;
    }
    uint exponent = (bits + 0x004afb0du) >> 23; /* 0x3f800000 - the bits of sqrt(1/2) */
    *e = (int)exponent - bias;
    return bits_float(bits - ((exponent - 127u) << 23));
}

/* log((1 + s) / (1 - s)) = 2 s + s z R(z), z = s^2, with s = f / (2 + f) and f = m - 1; 2 s is written as f - s f so
 * that its rounding error is that of a small term (FreeBSD's e_logf.c explains the arrangement). */
SHARED_FUNCTION float float_log(float x)
{
    uint bits = float_bits(x);
    if (bits - 1u >= 0x7f7fffffu) { /* 0, infinity, negative, NaN */
        float special = bits == 0x7f800000u ? x : FLOAT_NAN;
        return (bits & ~FLOAT_SIGN_BIT) == 0u ? -FLOAT_INFINITY : special;
    }
    int e;
    float f = float_split(x, &e) - 1.0f;
    float s = f / (2.0f + f);
    float z = s * s;
    float r = z * (0.666666687f + z * (0.400001228f + z * (0.285508156f + z * 0.233305737f)));
    float half_square = 0.5f * f * f;
    float n = (float)e;
    return (s * (half_square + r) + n * 1.42860677e-06f - half_square + f) + n * 0.693145752f;
}

/* log2(x) of a positive finite x as an unevaluated sum of two floats with a relative error below 2^-33:
 * (2 / ln 2) (s + s^3/3 + s^5/5 ...) with the first two terms in twice the precision. */
SHARED_FUNCTION float float_log2_pair(float x, float *lower)
{
    int e;
    float m = float_split(x, &e);
    float f = m - 1.0f;
    float d = m + 1.0f;
    float d_lower = (m - (d - (d - m))) + (1.0f - (d - m)); /* exact (Knuth's sum) */
    float reciprocal = 1.0f / d;
    float s = f * reciprocal;
    float product = s * d;
    float s_lower = (((f - product) - float_product_error(s, d, product)) - s * d_lower) * reciprocal;
    float z = s * s;
    float z_lower = float_product_error(s, s, z) + 2.0f * s * s_lower;
    float third = z * 0.333333343f;
    float third_lower = float_product_error(z, 0.333333343f, third) + (z_lower * 0.333333343f - z * 9.93410776e-09f);
    float cube = s * third;
    float rest = s * z * z * (0.200000077f + z * (0.142811179f + z * 0.115241162f));
    rest = rest + (float_product_error(s, third, cube) + s * third_lower + s_lower * third) + s_lower;
    float sum = s + cube;
    float sum_lower = ((s - sum) + cube) + rest;
    float a = sum * 2.88539004f; /* 2 / ln 2 */
    float a_lower = float_product_error(sum, 2.88539004f, a) + (sum * 3.85192607e-08f + sum_lower * 2.88539004f);
    float n = (float)e;
    float upper = n + a;
    float upper_lower = ((n - upper) + a) + a_lower;
    float result = upper + upper_lower;
    *lower = (upper - result) + upper_lower;
    return result;
}

/* x^y for x >= 0; NaN for x < 0 (-0 counts as 0). x^0 = 1^y = 1, even for a NaN; 0^y is 0 or infinity; otherwise a NaN
 * gives NaN and infinities their limits. */
SHARED_FUNCTION float float_pow(float x, float y)
{
    if (y == 0.0f || x == 1.0f)
        return 1.0f;
    if (!(x >= 0.0f) || y != y)
        return FLOAT_NAN;
    if (x == 0.0f || float_bits(x) == 0x7f800000u)
        return (x == 0.0f) == (y > 0.0f) ? 0.0f : FLOAT_INFINITY;
    float lower;
    float upper = float_log2_pair(x, &lower);
    float product = y * upper;
    float bounded = float_clamp(product, -160.0f, 160.0f);
    int k = (int)(bounded + 200.5f) - 200;
    float r = (bounded - (float)k) + (float_product_error(y, upper, product) + y * lower);
    float p = 0.240226507f + r * (0.0555038117f + r * (0.0096181035f + r * (0.00133813021f + r * 0.000154448833f)));
    float z = float_scale(1.0f + (r * 0.693147182f + r * r * p), k);
    if (bounded != product) /* out of range: r means nothing */
        return product > 0.0f ? FLOAT_INFINITY : 0.0f;
    return z;
}

/* ---- inverse functions ---------------------------------------------------------------------------------------- */

/* (asin(sqrt(z)) - sqrt(z)) / sqrt(z)^3 for 0 <= z <= 1/4. */
SHARED_FUNCTION float float_asin_tail(float z)
{
    return 0.166666731f + z * (0.0749885291f + z * (0.0450018942f + z * (0.0265506636f + z * 0.0380939618f)));
}

/* asin(sqrt(z)) for 0 <= z <= 1/4 as a sum: returns the larger part. The rounding error of the square root is part of
 * the smaller one. */
SHARED_FUNCTION float float_asin_root(float z, float *tail)
{
    float s = float_sqrt(z);
    float product = s * s;
    float root_error = z > 0.0f ? ((z - product) - float_product_error(s, s, product)) / (s + s) : 0.0f;
    *tail = s * z * float_asin_tail(z) + root_error;
    return s;
}

/* asin(x) = pi/2 - 2 asin(sqrt((1 - x) / 2)). */
SHARED_FUNCTION float float_asin(float x)
{
    float a = float_abs(x);
    if (!(a <= 1.0f))
        return FLOAT_NAN;
    if (a < 0.5f)
        return x + x * (x * x) * float_asin_tail(x * x);
    float tail;
    float s = float_asin_root(0.5f * (1.0f - a), &tail);
    float upper = 1.57079637f - 2.0f * s;
    float rest = ((1.57079637f - upper) - 2.0f * s) + (-4.37113883e-08f - 2.0f * tail);
    float y = upper + rest;
    return x < 0.0f ? -y : y;
}

SHARED_FUNCTION float float_acos(float x)
{
    float a = float_abs(x);
    if (!(a <= 1.0f))
        return FLOAT_NAN;
    if (a < 0.5f) {
        float upper = 1.57079637f - x;
        return upper + (((1.57079637f - upper) - x) + (-4.37113883e-08f - x * (x * x) * float_asin_tail(x * x)));
    }
    float tail;
    float s = float_asin_root(0.5f * (1.0f - a), &tail);
    if (x > 0.0f)
        return 2.0f * (s + tail);
    float upper = 3.14159274f - 2.0f * s;
    return upper + (((3.14159274f - upper) - 2.0f * s) + (-8.74227766e-08f - 2.0f * tail));
}

/* The angle of (x, y) in [-pi, pi]. The ratio q of the smaller over the larger magnitude is reduced to (q - 1) / (q +
 * 1) above 1/2, then one base angle (0, pi/4, pi/2, 3 pi/4 or pi) in two parts is added. */
SHARED_FUNCTION float float_atan2(float y, float x)
{
    if (x != x || y != y)
        return FLOAT_NAN;
    float ax = float_abs(x), ay = float_abs(y);
    float large = float_max(ax, ay), small = float_min(ax, ay);
    if (float_bits(large) >= 0x7e800000u) { /* 2^126: large + small might overflow; infinities count as 1 */
        bool infinite = float_bits(large) == 0x7f800000u;
        small = infinite ? (float_bits(small) == 0x7f800000u ? 1.0f : 0.0f) : 0.25f * small;
        large = infinite ? 1.0f : 0.25f * large;
    }
    bool near_diagonal = small > 0.5f * large;
    float numerator = near_diagonal ? small - large : small; /* exact */
    float denominator = near_diagonal ? small + large : large;
    float t = denominator == 0.0f ? 0.0f : numerator / denominator;
    float z = t * t;
    float angle =
        t + t * z * (-0.333333254f + z * (0.199982092f + z * (-0.142271444f + z * (0.104222722f - z * 0.0558065511f))));
    float base = near_diagonal ? 0.785398185f : 0.0f;
    float base_lower = near_diagonal ? -2.18556941e-08f : 0.0f;
    if (ay > ax) {
        base = 1.57079637f - base;
        base_lower = -4.37113883e-08f - base_lower;
        angle = -angle;
    }
    if ((float_bits(x) & FLOAT_SIGN_BIT) != 0u) {
        float turned = 3.14159274f - base;
        base_lower = ((3.14159274f - turned) - base) + (-8.74227766e-08f - base_lower);
        base = turned;
        angle = -angle;
    }
    return bits_float(float_bits(base + (base_lower + angle)) ^ (float_bits(y) & FLOAT_SIGN_BIT));
}

#endif

#endif
