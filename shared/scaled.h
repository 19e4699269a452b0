/* Numbers with the precision of a float and an exponent that does not run out: products of ratios of densities along a
 * path leave float's range long before the weights that are made of them do (Veach 1997, section 10.2.2). */
#ifndef TWINLIGHT_SCALED_H
#define TWINLIGHT_SCALED_H

#include "platform.h"

/* mantissa 2^exponent with 1 <= mantissa < 2, or mantissa 0 and exponent SCALED_ZERO; never negative. Infinity is
 * mantissa 1 and exponent SCALED_INFINITE, and stays it but for a product with zero, which is zero. */
typedef struct Scaled {
    float mantissa;
    int exponent;
} Scaled;

#define SCALED_ZERO (-0x20000000)
#define SCALED_INFINITE 0x20000000

SHARED_FUNCTION Scaled scaled_zero(void)
{
    Scaled zero;
    zero.mantissa = 0.0f;
    zero.exponent = SCALED_ZERO;
    return zero;
}

SHARED_FUNCTION Scaled scaled_infinite(void)
{
    Scaled infinite;
    infinite.mantissa = 1.0f;
    infinite.exponent = SCALED_INFINITE;
    return infinite;
}

/* x >= 0; NaN and negative numbers give 0. */
SHARED_FUNCTION Scaled scaled_from(float x)
{
    Scaled result;
    if (!(x > 0.0f))
        return scaled_zero();
    if (!float_finite(x))
        return scaled_infinite();
    result.mantissa = float_mantissa(x, &result.exponent);
    return result;
}

/* Zero where it underflows, infinity where it overflows. */
SHARED_FUNCTION float scaled_float(Scaled a)
{
    if (a.mantissa == 0.0f || a.exponent < -126)
        return 0.0f;
    if (a.exponent > 127)
        return FLOAT_INFINITY;
    return a.mantissa * bits_float((uint)(a.exponent + 127) << 23);
}

SHARED_FUNCTION bool scaled_is_infinite(Scaled a)
{
    return a.exponent == SCALED_INFINITE;
}

SHARED_FUNCTION Scaled scaled_multiply(Scaled a, Scaled b)
{
    if (a.mantissa == 0.0f || b.mantissa == 0.0f)
        return scaled_zero();
    if (scaled_is_infinite(a) || scaled_is_infinite(b))
        return scaled_infinite();
    Scaled product;
    product.mantissa = a.mantissa * b.mantissa;
    product.exponent = a.exponent + b.exponent;
    if (product.mantissa >= 2.0f) {
        product.mantissa = product.mantissa * 0.5f;
        product.exponent += 1;
    }
    return product;
}

/* a / b; anything over zero is infinite, but zero over anything is zero. Infinite over infinite is 1. */
SHARED_FUNCTION Scaled scaled_divide(Scaled a, Scaled b)
{
    if (a.mantissa == 0.0f)
        return scaled_zero();
    if (b.mantissa == 0.0f)
        return scaled_infinite();
    if (scaled_is_infinite(b))
        return scaled_is_infinite(a) ? scaled_from(1.0f) : scaled_zero();
    if (scaled_is_infinite(a))
        return a;
    Scaled quotient;
    quotient.mantissa = a.mantissa / b.mantissa;
    quotient.exponent = a.exponent - b.exponent;
    if (quotient.mantissa < 1.0f) {
        quotient.mantissa = quotient.mantissa * 2.0f;
        quotient.exponent -= 1;
    }
    return quotient;
}

SHARED_FUNCTION Scaled scaled_add(Scaled a, Scaled b)
{
    Scaled larger = a.exponent >= b.exponent ? a : b, smaller = a.exponent >= b.exponent ? b : a;
    int shift = larger.exponent - smaller.exponent;
    if (smaller.mantissa == 0.0f || shift > 30 || scaled_is_infinite(larger))
        return larger;
    Scaled sum;
    sum.mantissa = larger.mantissa + smaller.mantissa * bits_float((uint)(127 - shift) << 23);
    sum.exponent = larger.exponent;
    if (sum.mantissa >= 2.0f) {
        sum.mantissa = sum.mantissa * 0.5f;
        sum.exponent += 1;
    }
    return sum;
}

#endif
