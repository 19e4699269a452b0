/* Non-negative numbers with the precision of a float and an exponent that does not overflow: products of density ratios
 * along a path leave the range of a float long before the MIS weights made of them do (Veach 1997, section 10.2.2). */
#ifndef TWINLIGHT_MATH_SCALED_H
#define TWINLIGHT_MATH_SCALED_H

#include "math/platform.h"

/* value * 2^exponent, never negative. The value lies in [SCALED_LEAST, SCALED_MOST), so that products, quotients and
 * sums of two values are normal floats; if the result lies in that range too, as it nearly always does, it needs no
 * renormalisation, and its rounding does not depend on the exponent. Zero and infinity have the float's value and
 * exponent 0. Infinity follows the float's rules, except that infinity * 0 = 0 and infinity / infinity = 1. */
typedef struct Scaled {
    float value;
    int exponent;
} Scaled;

#define SCALED_LEAST 8.673617380e-19f /* 2^-60 */
#define SCALED_MOST 1.152921505e18f /* 2^60 */

/* value * 2^exponent with the result's value in [1, 2); `value` must be positive and finite. */
SHARED_FUNCTION Scaled scaled_normalize(float value, int exponent)
{
    int shift;
    Scaled result;
    result.value = float_mantissa(value, &shift);
    result.exponent = exponent + shift;
    return result;
}

/* value * 2^exponent for any float `value`; NaN and negative values give 0. */
SHARED_FUNCTION Scaled scaled_make(float value, int exponent)
{
    Scaled result;
    result.value = value;
    result.exponent = exponent;
    if (value >= SCALED_LEAST && value < SCALED_MOST)
        return result;
    if (value > 0.0f && float_finite(value))
        return scaled_normalize(value, exponent);
    result.value = value > 0.0f ? value : 0.0f;
    result.exponent = 0;
    return result;
}

SHARED_FUNCTION Scaled scaled_zero(void)
{
    return scaled_make(0.0f, 0);
}

SHARED_FUNCTION Scaled scaled_from(float x)
{
    return scaled_make(x, 0);
}

SHARED_FUNCTION bool scaled_is_infinite(Scaled a)
{
    return !float_finite(a.value);
}

/* As a float: what is below the normal range gives 0, what is above it infinity. */
SHARED_FUNCTION float scaled_float(Scaled a)
{
    if (a.exponent == 0)
        return a.value;
    a = scaled_normalize(a.value, a.exponent);
    if (a.exponent < -126)
        return 0.0f;
    if (a.exponent > 127)
        return FLOAT_INFINITY;
    return a.value * bits_float((uint)(a.exponent + 127) << 23);
}

SHARED_FUNCTION Scaled scaled_multiply(Scaled a, Scaled b)
{
    return scaled_make(a.value * b.value, a.exponent + b.exponent);
}

/* a / b, where 0 / b = 0 for every b, a / 0 = infinity for a > 0, and infinity / infinity = 1. */
SHARED_FUNCTION Scaled scaled_divide(Scaled a, Scaled b)
{
    float value = a.value / b.value;
    if (value != value && scaled_is_infinite(a))
        return scaled_from(1.0f);
    return scaled_make(value, a.exponent - b.exponent);
}

/* The sum of numbers of different exponents. */
SHARED_FUNCTION Scaled scaled_add_shifted(Scaled a, Scaled b)
{
    if (a.value == 0.0f || scaled_is_infinite(b))
        return b;
    if (b.value == 0.0f || scaled_is_infinite(a))
        return a;
    a = scaled_normalize(a.value, a.exponent);
    b = scaled_normalize(b.value, b.exponent);
    Scaled larger = a.exponent >= b.exponent ? a : b, smaller = a.exponent >= b.exponent ? b : a;
    int shift = larger.exponent - smaller.exponent;
    if (shift > 30)
        return larger;
    return scaled_make(larger.value + smaller.value * bits_float((uint)(127 - shift) << 23), larger.exponent);
}

SHARED_FUNCTION Scaled scaled_add(Scaled a, Scaled b)
{
    return a.exponent == b.exponent ? scaled_make(a.value + b.value, a.exponent) : scaled_add_shifted(a, b);
}

#endif
