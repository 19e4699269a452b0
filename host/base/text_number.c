#include "base/text_number.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static int digit_of(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : -1;
}

/* A parsed decimal number: (-1)^negative mantissa 10^exponent; `exact` unless digits were dropped. */
typedef struct Decimal {
    uint64_t mantissa;
    int exponent;
    int digits;
    bool negative, exact;
} Decimal;

static void decimal_digit(Decimal *d, int digit, bool fraction)
{
    if (d->digits < 18) {
        d->mantissa = 10 * d->mantissa + (uint64_t)digit;
        d->digits += d->mantissa > 0;
        d->exponent -= fraction;
    } else {
        d->exact = d->exact && digit == 0;
        d->exponent += !fraction;
    }
}

static bool decimal_scan(const char *text, size_t length, Decimal *d)
{
    const char *p = text, *end = text + length;
    *d = (Decimal){.exact = true};
    if (p < end && (*p == '+' || *p == '-'))
        d->negative = *p++ == '-';
    const char *first = p;
    for (; p < end && digit_of(*p) >= 0; ++p)
        decimal_digit(d, digit_of(*p), false);
    ptrdiff_t count = p - first;
    if (p < end && *p == '.') {
        const char *fraction = ++p;
        for (; p < end && digit_of(*p) >= 0; ++p)
            decimal_digit(d, digit_of(*p), true);
        count += p - fraction;
    }
    if (count == 0)
        return false;
    if (p < end && (*p == 'e' || *p == 'E')) {
        bool negative = false;
        int exponent = 0;
        ++p;
        if (p < end && (*p == '+' || *p == '-'))
            negative = *p++ == '-';
        if (p == end)
            return false;
        for (; p < end && digit_of(*p) >= 0; ++p)
            exponent = exponent < 100000 ? 10 * exponent + digit_of(*p) : exponent;
        d->exponent += negative ? -exponent : exponent;
    }
    return p == end;
}

static const double POWERS[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* Correctly rounded float by one rounding to double and one to float; false where that might be wrong. Clinger's fast
 * path (W. D. Clinger, "How to Read Floating Point Numbers Accurately", PLDI 1990) needs mantissa and power of ten
 * exact in double; the second rounding can only be wrong if the double lies halfway between two floats. */
static bool decimal_fast(const Decimal *d, float *value)
{
    if (!d->exact || d->mantissa > (UINT64_C(1) << 53) || d->exponent < -22 || d->exponent > 22)
        return false;
    double x = (double)d->mantissa;
    x = d->exponent < 0 ? x / POWERS[-d->exponent] : x * POWERS[d->exponent];
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    if ((bits & 0x1fffffffu) == 0x10000000u || (x > 0.0 && x < 1e-37) || x > 3e38)
        return false;
    *value = (float)(d->negative ? -x : x);
    return true;
}

/* Converts any decimal by strtof, which rounds correctly but needs a terminated string. */
static NumberStatus decimal_slow(const char *text, size_t length, float *value)
{
    char small[128];
    char *copy = length < sizeof small ? small : malloc(length + 1);
    if (!copy)
        return NUMBER_MALFORMED;
    memcpy(copy, text, length);
    copy[length] = '\0';
    *value = strtof(copy, NULL);
    if (copy != small)
        free(copy);
    return isfinite(*value) ? NUMBER_OK : NUMBER_OVERFLOW;
}

NumberStatus number_float(const char *text, size_t length, float *value)
{
    Decimal d;
    if (!decimal_scan(text, length, &d))
        return NUMBER_MALFORMED;
    if (d.mantissa == 0 && d.exact) {
        *value = d.negative ? -0.0f : 0.0f;
        return NUMBER_OK;
    }
    return decimal_fast(&d, value) ? NUMBER_OK : decimal_slow(text, length, value);
}

NumberStatus number_integer(const char *text, size_t length, int *value)
{
    size_t i = length > 0 && (text[0] == '+' || text[0] == '-') ? 1 : 0;
    bool overflow = false;
    int64_t sum = 0;
    if (i == length)
        return NUMBER_MALFORMED;
    for (; i < length; ++i) {
        if (digit_of(text[i]) < 0)
            return NUMBER_MALFORMED;
        sum = overflow ? sum : 10 * sum + digit_of(text[i]);
        overflow = overflow || sum > (int64_t)INT_MAX + 1;
    }
    sum = text[0] == '-' ? -sum : sum;
    if (overflow || sum > INT_MAX)
        return NUMBER_OVERFLOW;
    *value = (int)sum;
    return NUMBER_OK;
}
