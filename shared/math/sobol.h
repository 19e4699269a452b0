/* Points of Sobol's sequence, scrambled as Owen does ("Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995) by
 * hashes (Burley, "Practical hash-based Owen scrambling", 2020): any 2^m consecutive samples, from a multiple of 2^m
 * on, fill their four dimensions evenly, and every single point is uniform. Sets of four dimensions whose order is
 * shuffled, too, are padded together to as many dimensions as paths need. Integers alone: the same bits everywhere. */
#ifndef TWINLIGHT_MATH_SOBOL_H
#define TWINLIGHT_MATH_SOBOL_H

#include "math/rng.h"
#include "math/sobol_tables.h"

SHARED_FUNCTION uint bits_reversed(uint x)
{
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
}

/* An Owen scrambling in reversed bit order: whether a bit flips depends on the bits below it and the seed. (Laine and
 * Karras 2011; the constants are Vegdahl's, "Building a better LK hash", 2021.) */
SHARED_FUNCTION uint owen_scrambled(uint x, uint seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* Dimension 2 + d of the point with the given index; both in reversed bit order. */
SHARED_FUNCTION uint sobol_sum(uint d, uint index)
{
    uint sum = 0u;
    for (uint n = 0u; n < 8u; ++n)
        sum ^= SOBOL_SUMS[(d * 8u + n) * 16u + (index >> 4u * n & 15u)];
    return sum;
}

/* Four dimensions of point `sample` of the set that `seeds` chooses, the first of which is number `first` of the
 * result, and so on around. The first two have the best projections. */
SHARED_FUNCTION Random4 sobol_four(uint sample, Random4 seeds, uint first)
{
    uint order = seeds.x[0] ^ (seeds.x[2] >> 16 | seeds.x[2] << 16); /* mixed as MurmurHash3 ends (Appleby 2011) */
    order = (order ^ order >> 16) * 0x85ebca6bu;
    order = (order ^ order >> 13) * 0xc2b2ae35u;
    uint index = owen_scrambled(bits_reversed(sample), order ^ order >> 16);
    Random4 point;
    point.x[first & 3u] = bits_reversed(owen_scrambled(bits_reversed(index), seeds.x[0]));
    for (uint d = 0u; d < 3u; ++d)
        point.x[(first + 1u + d) & 3u] = bits_reversed(owen_scrambled(sobol_sum(d, index), seeds.x[1u + d]));
    return point;
}

#endif
