/* Double arithmetic under the name of float: the yardstick that --enable-double compiles the CPU backend's kernels
 * with. From the end of this file on `float` means double, in every function, struct and cast of shared/; only bits
 * stay those of a float. What takes floats apart, or knows how many bits they have, is here a second time.
 *
 * Included by math/platform.h, and before the first header that has floats of its own, Embree's for one. */
#if defined(TWINLIGHT_DOUBLE) && !defined(TWINLIGHT_MATH_PLATFORM_DOUBLE_H)
#define TWINLIGHT_MATH_PLATFORM_DOUBLE_H

#define PLATFORM_DOUBLE 1

/* The nearest float's. Whole numbers, hashes and what leaves the kernels need no more. */
SHARED_FUNCTION uint float_bits(double x)
{
    float narrow = (float)x;
    uint bits;
    memcpy(&bits, &narrow, sizeof bits);
    return bits;
}

SHARED_FUNCTION double bits_float(uint bits)
{
    float narrow;
    memcpy(&narrow, &bits, sizeof narrow);
    return (double)narrow;
}

/* A float in state has its word as ever, so that who reads words, or the film, or another pass, finds it. The double is
 * kept beside it: state lies in the lower quarter of an aligned block, at offset p, and the double at half the block
 * plus 2 p. A word that was copied as a word has no double that fits it, and counts as it is. */
#define STATE_BLOCK ((size_t)1 << 26)

SHARED_FUNCTION double *state_double(const uint *word)
{
    uintptr_t address = (uintptr_t)word, block = address & ~(uintptr_t)(STATE_BLOCK - 1);
    return (double *)(block + STATE_BLOCK / 2 + 2 * (address - block));
}

SHARED_FUNCTION double word_float(const uint *word)
{
    double wide = *state_double(word);
    return float_bits(wide) == *word ? wide : bits_float(*word);
}

SHARED_FUNCTION void word_set_float(uint *word, double value)
{
    *word = float_bits(value);
    *state_double(word) = value;
}

/* Hierarchies of boxes stay floats; no ray of this build walks them. */
typedef float Float4 __attribute__((vector_size(16), may_alias));
#define float4_splat(x) ((Float4){(x), (x), (x), (x)})
#define float4_mad(a, b, c) ((a)*float4_splat(b) + float4_splat(c))

#define float_sqrt(x) sqrt(x)
#define float_abs(x) fabs(x)
#define float_floor(x) floor(x)

/* Instead of math/elementary.h's. */
#define float_sin(x) sin(x)
#define float_cos(x) cos(x)
#define float_exp(x) exp(x)
#define float_log(x) log(x)
#define float_pow(x, y) pow(x, y)
#define float_asin(x) asin(x)
#define float_acos(x) acos(x)
#define float_atan2(y, x) atan2(y, x)

SHARED_FUNCTION void float_sincos(double x, double *sine, double *cosine)
{
    *sine = sin(x);
    *cosine = cos(x);
}

#define float_select(condition, a, b) ((condition) ? (a) : (b))
#define float_copy_sign(magnitude, sign) copysign(magnitude, sign)

SHARED_FUNCTION double float_step(double x, double toward)
{
    return toward == 0.0 || !isfinite(x) ? x : nextafter(x, toward > 0.0 ? HUGE_VAL : -HUGE_VAL);
}

/* The mantissa in [1, 2) of a positive finite x. */
SHARED_FUNCTION double float_mantissa(double x, int *exponent)
{
    double half = frexp(x, exponent);
    --*exponent;
    return 2.0 * half;
}

#define PI 3.14159265358979323846
#define INV_PI 0.31830988618379067154
#define INV_2PI 0.15915494309189533577
#define INV_4PI 0.07957747154594766788
#define PI_OVER_2 1.57079632679489661923
#define PI_OVER_4 0.78539816339744830961

#define float double

#endif
