/* Quotients and square roots of selected numbers, to find out whether a device rounds them as IEEE 754 requires
 * (backend_ocl/rounding_probe.h). No rendering uses this. */
#ifndef TWINLIGHT_ROUNDING_CL
#define TWINLIGHT_ROUNDING_CL

#include "math/rng.h"

/* Results of an item: a / b, 1 / b, a / 3, sqrt(c), and 1 / sqrt(c), which takes two operations. */
#define ROUNDING_WORDS 5u
#define ROUNDING_OPERATIONS 6u

typedef struct RoundingOperands {
    float a, b, c;
} RoundingOperands;

/* x 2^exponent, a normal number; x is 1 ... 2^24 - 1. */
SHARED_FUNCTION float rounding_scale(uint x, int exponent)
{
    return bits_float(float_bits((float)x) + ((uint)exponent << 23));
}

/* The a in [0, b) with a 2^25 = r (mod b); b is odd, 0 < r < b. If r or b - r is small and odd, a / b is next to k /
 * 2^25 for an odd k: halfway between two floats if a is more than b / 2, and next to a float if it is less. */
SHARED_FUNCTION uint rounding_hard_dividend(uint b, uint r)
{
    for (int i = 0; i < 25; ++i)
        r = (r & 1u) != 0u ? (r + b) >> 1 : r >> 1;
    return r;
}

/* The x of 24 bits with x 2^shift = s^2 - r, for an odd s of 25 bits; r is small and 1 modulo 8. The root is next to s,
 * which is halfway between two floats. The root of r modulo 2^26 is found bit by bit. */
SHARED_FUNCTION uint rounding_hard_radicand(int r, uint *shift)
{
    uint s = 1u;
    for (uint bit = 3u; bit < 26u; ++bit)
        if ((((s * s - (uint)r) >> bit) & 1u) != 0u)
            s += 1u << (bit - 1u);
    s = s < 0x01000000u ? 0x02000000u - s : s;
    ulong square = (ulong)s * s;
    square = r < 0 ? square + (uint)-r : square - (uint)r;
    *shift = square >> 49 == 0u ? 25u : 26u;
    return (uint)(square >> *shift);
}

/* Operands of item i, by i modulo 8: 0 ... 3 any bits; 4 a denormal and any bits; 5 quotients around the smallest
 * normal number, and denormal radicands; 6, 7 quotients and roots next to where rounding changes. */
SHARED_FUNCTION RoundingOperands rounding_operands(uint i)
{
    Random4 random = random_four(i, 0u, 0u, 0u, 0x726f756eu, 0x64696e67u);
    uint kind = i % 8u, a = random.x[0], b = random.x[1], c = random.x[2], d = random.x[3];
    RoundingOperands operands;
    if (kind == 4u && (d & 1u) != 0u) {
        a = a & 0x807fffffu;
    } else if (kind == 4u) {
        b = b & 0x807fffffu;
    } else if (kind == 5u) { /* 2^-100 ... 2^-93 by 2^24 ... 2^55 */
        a = (a & 0x83ffffffu) + 0x0d800000u;
        b = (b & 0x8fffffffu) + 0x4b800000u;
        c = c & 0x007fffffu;
    } else if (kind >= 6u) {
        uint divisor = (b >> 8) | 0x00800001u, r = (d & 0x1eu) | 1u, shift;
        uint dividend = rounding_hard_dividend(divisor, (d & 1u) != 0u ? divisor - r : r);
        uint radicand = rounding_hard_radicand((int)((d >> 5) & 0xffu) * 8 - 1023, &shift);
        a = float_bits(rounding_scale(dividend, (int)(c & 0x7fu) - 64)) | (a & FLOAT_SIGN_BIT);
        b = float_bits(rounding_scale(divisor, (int)((c >> 7) & 0x7fu) - 64));
        c = float_bits(rounding_scale(radicand, 2 * ((int)((c >> 14) & 0x3fu) - 32) + (int)(shift & 1u)));
    }
    operands.a = bits_float(a);
    operands.b = bits_float(b);
    operands.c = bits_float((c & 0x7fu) != 0u ? c & ~FLOAT_SIGN_BIT : c);
    return operands;
}

/* To: ROUNDING_WORDS words for each item. */
__kernel void rounding_compute(uint first, __global uint *out)
{
    size_t i = get_global_id(0);
    RoundingOperands x = rounding_operands(first + (uint)i);
    __global uint *word = out + ROUNDING_WORDS * i;
    word[0] = float_bits(x.a / x.b);
    word[1] = float_bits(1.0f / x.b);
    word[2] = float_bits(x.a / 3.0f);
    word[3] = float_bits(float_sqrt(x.c));
    word[4] = float_bits(1.0f / float_sqrt(x.c));
}

#endif
