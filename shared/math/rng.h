/* Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1,
 * 2, 3", SC 2011). Four random words are a function of a counter and a key: there is no state to store or to seed. */
#ifndef TWINLIGHT_MATH_RNG_H
#define TWINLIGHT_MATH_RNG_H

#include "math/platform.h"

typedef struct Random4 {
    uint x[4];
} Random4;

/* The four words of counter (c0, c1, c2, c3) under key (k0, k1). */
SHARED_FUNCTION Random4 random_four(uint c0, uint c1, uint c2, uint c3, uint k0, uint k1)
{
    for (int round = 0; round < 10; ++round) {
        ulong p0 = (ulong)0xd2511f53u * c0;
        ulong p1 = (ulong)0xcd9e8d57u * c2;
        c0 = (uint)(p1 >> 32) ^ c1 ^ k0;
        c2 = (uint)(p0 >> 32) ^ c3 ^ k1;
        c1 = (uint)p1;
        c3 = (uint)p0;
        k0 += 0x9e3779b9u;
        k1 += 0xbb67ae85u;
    }
    Random4 result;
    result.x[0] = c0;
    result.x[1] = c1;
    result.x[2] = c2;
    result.x[3] = c3;
    return result;
}

/* Uniform in (0, 1): the odd multiples of 2^-24, exactly. Never 0, never 1, symmetric about 1/2. Uses the upper 23
 * bits. */
SHARED_FUNCTION float random_float(uint bits)
{
    return ((float)(bits >> 9) + 0.5f) * 1.1920928955078125e-07f;
}

#endif
