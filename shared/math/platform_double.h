/* Double precision under the name `float`: --enable-double compiles the CPU backend's kernels with it, as a reference.
 * From the end of this file on, `float` means double in every function, struct and cast of shared/; only bit patterns
 * stay those of a 32-bit float. What takes floats apart or depends on their width in bits is defined here a second
 * time.
 *
 * Included by math/platform.h. Headers with floats of their own, such as Embree's, must be included before that. */
#if defined(TWINLIGHT_DOUBLE) && !defined(TWINLIGHT_MATH_PLATFORM_DOUBLE_H)
#define TWINLIGHT_MATH_PLATFORM_DOUBLE_H

#define PLATFORM_DOUBLE 1

/* Bits of the nearest float: integers, hashes and the output of kernels need no more. */
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

/* A float in state keeps its 32-bit word for code that reads words: the film, other passes. Its double is kept beside
 * it: state lies in the lower quarter of an aligned block, and the double of the word at offset p at half the block
 * plus 2 p. If the word does not match its double, because it was copied as a word, the word counts. */
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

/* Hierarchies of boxes stay in single precision; no ray of this build traverses them. */
typedef float Float4 __attribute__((vector_size(16), may_alias));
#define float4_splat(x) ((Float4){(x), (x), (x), (x)})
#define float4_mad(a, b, c) ((a)*float4_splat(b) + float4_splat(c))

#define float_sqrt(x) sqrt(x)
#define float_abs(x) fabs(x)
#define float_floor(x) floor(x)

/* Replace those of math/elementary.h. */
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

/* The mantissa in [1, 2) of a positive finite x, with x = mantissa * 2^exponent. */
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
