/* Discrete distributions that the host tabulates (host/scene/distribution_build.h) and kernels draw from. */
#ifndef TWINLIGHT_LAYOUT_DISTRIBUTION_H
#define TWINLIGHT_LAYOUT_DISTRIBUTION_H

#include "layout/scene_types.h"

/* Draws an index below `count` (> 0) from an alias table. bits0 and bits1 form one 64-bit fraction. The integer part of
 * its product with `count` is the bucket, the fractional part decides whether the bucket's own index is kept. All
 * buckets are equally probable to within count 2^-64. *rest: where in its part of the fraction that was, uniform in (0,
 * 1) given the index, and stratified as bits0 is. */
SHARED_FUNCTION uint alias_sample_rest(__global const AliasBucket *buckets, uint count, uint bits0, uint bits1,
                                       float *rest)
{
    ulong low = (ulong)bits1 * count;
    ulong high = (ulong)bits0 * count + (low >> 32);
    uint bucket = (uint)(high >> 32);
    ulong part = (high << 32) | (low & 0xffffffffu);
    float q = buckets[bucket].q;
    ulong kept = q < 1.0f ? (ulong)(q * 18446744073709551616.0f) : 0u; /* q 2^64; 0: all, or none */
    bool keeps = q >= 1.0f || part < kept;
    ulong first = keeps ? 0u : kept, all = keeps ? kept : 0u - kept;
    float size = all > 0u ? (float)all : 18446744073709551616.0f;
    *rest = float_clamp((float)(part - first) / size, 5.9604645e-8f, 0.99999994f);
    return keeps ? bucket : buckets[bucket].alias;
}

SHARED_FUNCTION uint alias_sample(__global const AliasBucket *buckets, uint count, uint bits0, uint bits1)
{
    float rest;
    return alias_sample_rest(buckets, count, bits0, bits1, &rest);
}

/* The cell i < count of a CDF of count + 1 values with cdf[first + i] <= u < cdf[first + i + 1]; never an empty one.
 * Requires cdf[first] <= u < cdf[first + count]. */
SHARED_FUNCTION uint distribution_cell(__global const float *lookup, uint first, uint count, float u)
{
    uint low = 0u, high = count;
    while (high - low > 1u) {
        uint middle = (low + high) >> 1;
        if (lookup[first + middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The cell of x in [0, 1] if [0, 1) is cut into `count` equal cells. */
SHARED_FUNCTION uint distribution_cell_of(float x, uint count)
{
    float cell = x * (float)count;
    if (!(cell >= 0.0f))
        return 0u;
    return cell < (float)count ? (uint)cell : count - 1u;
}

/* The point at `fraction` of cell `cell`: a float x < 1 with distribution_cell_of(x, count) == cell. Rounding may put
 * (cell + fraction) / count an ulp or two beyond the cell's border; it is stepped back. count < 2^22. */
SHARED_FUNCTION float distribution_place(uint cell, float fraction, uint count)
{
    float x = float_min(((float)cell + fraction) / (float)count, 0.99999994f);
    for (int i = 0; i < 4; ++i) {
        uint at = distribution_cell_of(x, count);
        if (at == cell)
            break;
        x = float_step(x, at > cell ? -1.0f : 1.0f);
    }
    return x;
}

/* Density of one cell, over the unit square. */
SHARED_FUNCTION float distribution2d_cell_pdf(__global const float *lookup, Distribution2D d, uint x, uint y)
{
    uint row = d.first_conditional + y * (d.width + 1u);
    float marginal = lookup[d.first_marginal + y + 1u] - lookup[d.first_marginal + y];
    float conditional = lookup[row + x + 1u] - lookup[row + x];
    return (marginal * (float)d.height) * (conditional * (float)d.width);
}

/* Density at uv, over the unit square. Zero where the table is. */
SHARED_FUNCTION float distribution2d_pdf(__global const float *lookup, Distribution2D d, Vec2 uv)
{
    return distribution2d_cell_pdf(lookup, d, distribution_cell_of(uv.x, d.width),
                                   distribution_cell_of(uv.y, d.height));
}

/* Draws a point uv of the unit square by inverting the marginal CDF at u.y, then that row's CDF at u.x. *pdf is exactly
 * distribution2d_pdf(uv), positive unless the whole table is zero: then it is 0 and the point is meaningless. Exact for
 * u from random_float: the host puts every CDF value on a multiple of 2^-23, so that the fraction of such u that fall
 * into a cell *is* the cell's probability. */
SHARED_FUNCTION Vec2 distribution2d_sample(__global const float *lookup, Distribution2D d, Vec2 u, float *pdf)
{
    float ux = float_clamp(u.x, 0.0f, 0.99999994f);
    float uy = float_clamp(u.y, 0.0f, 0.99999994f);
    if (!(lookup[d.first_marginal + d.height] > 0.0f)) {
        *pdf = 0.0f;
        return vec2(ux, uy);
    }
    uint y = distribution_cell(lookup, d.first_marginal, d.height, uy);
    uint row = d.first_conditional + y * (d.width + 1u);
    uint x = distribution_cell(lookup, row, d.width, ux);
    float y0 = lookup[d.first_marginal + y], y1 = lookup[d.first_marginal + y + 1u];
    float x0 = lookup[row + x], x1 = lookup[row + x + 1u];
    *pdf = distribution2d_cell_pdf(lookup, d, x, y);
    return vec2(distribution_place(x, (ux - x0) / (x1 - x0), d.width),
                distribution_place(y, (uy - y0) / (y1 - y0), d.height));
}

#endif
