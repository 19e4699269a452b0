/* What the film does with a splat, on the host and on devices: every contribution is rounded to a whole number of units
 * of 2^exponent and added to a 64-bit sum in two's complement, so neither the order of additions nor who makes them
 * matters.
 *
 * A sum that would leave 64 bits becomes +-SUM_FULL and stays that, and what is read of any sum is at most SUM_MAX
 * (film_sum_shown). Let p be all that is positive in a sum and n all that is negative, without sign. With both below
 * 2^63 no order fills the sum. With p above that and n at most SUM_MAX the sum is full in some orders and p - n, which
 * is SUM_MAX or more, in others: what is read is SUM_MAX in all. Order could matter only with n above SUM_MAX, too,
 * which takes more than 2^14 negative contributions, as only filters with negative lobes and colours outside the gamut
 * make them, each near NEGATIVE_MAX. */
#ifndef TWINLIGHT_CAMERA_FILM_SUM_H
#define TWINLIGHT_CAMERA_FILM_SUM_H

#include "layout/state.h"

/* What is read of a sum at most: one at or beyond +-this is full. */
#define SUM_MAX ((ulong)1 << 62)

/* Where a sum stays. */
#define SUM_FULL (((ulong)1 << 63) - 1u)

/* A sum below SUM_FAR stays below SUM_MAX though 2^21 additions meet, each of less than UNITS_SMALL: such ones need not
 * ask whether it is full. */
#define SUM_FAR ((ulong)1 << 61)
#define UNITS_SMALL ((ulong)1 << 40)

/* A contribution of more units is clamped. One path may bring all that a sum can show; of the largest negative ones
 * 2^14 come to as much. */
#define CONTRIBUTION_MAX SUM_MAX
#define NEGATIVE_MAX ((ulong)1 << 48)

/* A film as functions see it; the pixels that are kept are x0 <= x < x1, y0 <= y < y1, row by row. */
typedef struct FilmView {
    uint width; /* of the whole film */
    uint x0, y0, x1, y1;
    int exponent;
    __global ulong *sums; /* 3 a pixel */
    __global ulong *light_sums; /* the same for splats with SPLAT_LIGHT */
    __global ulong *rare_sums; /* of all with SPLAT_RARE, which are in one of the others, too */
    __global ulong *depth_sums; /* the same once more for every number of segments: film_depth_place */
    uint depth_kinds; /* of them: 0 (names have no depth), 1: from the light, or 3: their own and rare ones, too */
    uint depth_last; /* from SPLAT_DEPTH_MIN on */
    __global uint *counts; /* samples of a pixel */
    __global ulong *saturated; /* contributions that were clamped */
    __global ulong *vanished; /* contributions that are not black, but less than half a unit in every channel */
    __global ulong *not_finite; /* contributions that counted as zero */
} FilmView;

#define FILM_KIND_LIGHT 0u
#define FILM_KIND_OWN 1u
#define FILM_KIND_RARE 2u

/* Sums of a kind and of paths of `depth` segments, 3 a pixel; where they begin in depth_sums. */
SHARED_FUNCTION size_t film_depth_place(uint pixels, uint kinds, uint depth, uint kind)
{
    return 3u * (size_t)pixels * ((depth - SPLAT_DEPTH_MIN) * kinds + kind);
}

/* All of them: what depth_sums has. */
SHARED_FUNCTION size_t film_depth_words(uint pixels, uint kinds, uint depth_last)
{
    return depth_last >= SPLAT_DEPTH_MIN ? film_depth_place(pixels, kinds, depth_last + 1u, 0u) : 0u;
}

/* The sums of a film in one buffer (BUFFER_FILM): sums, the three counters, the pixels' counts, two a word, as many of
 * the light's sums and the rare ones as there are (0, 1 or 2), and last those of depths. */
SHARED_FUNCTION ulong film_words(uint pixels, uint more)
{
    return (1u + more) * 3u * (ulong)pixels + 3u + ((ulong)pixels + 1u) / 2u;
}

/* Points the view's sums into such a buffer; depth_kinds are known. */
SHARED_FUNCTION void film_view_words(FilmView *film, __global ulong *words, uint pixels)
{
    film->sums = words;
    film->saturated = words + 3u * (size_t)pixels;
    film->vanished = film->saturated + 1;
    film->not_finite = film->saturated + 2;
    film->counts = (__global uint *)(film->saturated + 3);
    film->light_sums = words + film_words(pixels, 0u);
    film->rare_sums = words + film_words(pixels, 1u);
    film->depth_sums = words + film_words(pixels, film->depth_kinds > FILM_KIND_RARE ? 2u : 1u);
}

/* The pixel's place among those kept, or NONE. */
SHARED_FUNCTION uint film_slot(const FilmView *film, uint pixel)
{
    uint x = pixel % film->width, y = pixel / film->width;
    bool kept = x >= film->x0 && x < film->x1 && y >= film->y0 && y < film->y1;
    return kept ? (y - film->y0) * (film->x1 - film->x0) + x - film->x0 : NONE;
}

/* The nearest whole number of units of 2^exponent to |value|, halves up, at most CONTRIBUTION_MAX or NEGATIVE_MAX;
 * whether it was more goes to *clamped. In whole numbers, for devices have no doubles to scale the float by every power
 * of two. */
SHARED_FUNCTION ulong film_units(float value, int exponent, bool *clamped)
{
    uint bits = float_bits(value), field = bits >> 23 & 0xffu;
    ulong mantissa = field != 0u ? (bits & 0x7fffffu) | 0x800000u : bits & 0x7fffffu;
    int shift = (field != 0u ? (int)field : 1) - 150 - exponent; /* |value| = mantissa * 2^(shift + exponent) */
    if (shift < 0) {
        uint down = shift > -63 ? (uint)-shift : 63u;
        *clamped = false;
        return (mantissa + ((ulong)1 << (down - 1u))) >> down;
    }
    uint up = shift < 63 ? (uint)shift : 63u;
    ulong most = value < 0.0f ? NEGATIVE_MAX : CONTRIBUTION_MAX;
    *clamped = mantissa > most >> up;
    return *clamped ? most : mantissa << up;
}

/* Whether a sum stays as it is. */
SHARED_FUNCTION bool film_sum_full(ulong sum)
{
    return sum == SUM_FULL || sum == 0u - SUM_FULL;
}

/* A sum that is not full with so many units more, which may be another sum. */
SHARED_FUNCTION ulong film_sum_of(ulong sum, ulong units)
{
    ulong after = sum + units;
    bool wrapped = ((sum ^ after) & (units ^ after)) >> 63 != 0u || after == (ulong)1 << 63;
    if (film_sum_full(units) || !wrapped)
        return film_sum_full(units) ? units : after;
    return units >> 63 != 0u ? 0u - SUM_FULL : SUM_FULL;
}

#ifdef atomic_sum_add

/* Whether |number| < limit. */
SHARED_FUNCTION bool film_sum_below(ulong number, ulong limit)
{
    return number + (limit - 1u) <= 2u * (limit - 1u);
}

/* Adds to one sum. */
SHARED_FUNCTION void film_sum_add(__global ulong *sum, ulong units)
{
    ulong before = atomic_sum_load(sum);
    if (film_sum_below(units, UNITS_SMALL) && film_sum_below(before, SUM_FAR)) {
        atomic_sum_add(sum, units);
        return;
    }
    while (!film_sum_full(before)) {
        ulong seen = atomic_sum_exchange(sum, before, film_sum_of(before, units));
        if (seen == before)
            return;
        before = seen;
    }
}

/* What becomes of a contribution. */
#define FILM_ADDED 0u
#define FILM_CLAMPED 1u
#define FILM_VANISHED 2u

/* Adds a contribution to three sums. */
SHARED_FUNCTION uint film_color_add(__global ulong *sums, Vec3 color, int exponent)
{
    const float values[3] = {color.x, color.y, color.z};
    bool any_clamped = false, black = true, none = true;
    for (uint c = 0; c < 3u; ++c) {
        bool clamped;
        ulong units = film_units(values[c], exponent, &clamped);
        if (units != 0u)
            film_sum_add(sums + c, values[c] < 0.0f ? 0u - units : units);
        any_clamped = any_clamped || clamped;
        black = black && values[c] == 0.0f;
        none = none && units == 0u;
    }
    if (any_clamped)
        return FILM_CLAMPED;
    return none && !black ? FILM_VANISHED : FILM_ADDED;
}

/* Adds to the sums of the path's number of segments what has been added to those of all. */
SHARED_FUNCTION void film_depth_add(const FilmView *film, uint slot, uint name, Vec3 color)
{
    uint pixels = (film->x1 - film->x0) * (film->y1 - film->y0), kinds = film->depth_kinds;
    uint depth = name >> SPLAT_DEPTH_SHIFT & SPLAT_DEPTH_MAX;
    uint kind = (name & SPLAT_LIGHT) != 0u ? FILM_KIND_LIGHT : FILM_KIND_OWN;
    if (depth < SPLAT_DEPTH_MIN || depth > film->depth_last)
        return;
    if (kind < kinds)
        film_color_add(film->depth_sums + film_depth_place(pixels, kinds, depth, kind) + 3u * (size_t)slot, color,
                       film->exponent);
    if ((name & SPLAT_RARE) != 0u && FILM_KIND_RARE < kinds)
        film_color_add(film->depth_sums + film_depth_place(pixels, kinds, depth, FILM_KIND_RARE) + 3u * (size_t)slot,
                       color, film->exponent);
}

/* Adds splat t of a buffer, and one sample to its pixel unless it comes from the light. Any number of threads or
 * work-items may do so at once. */
SHARED_FUNCTION void film_splat_add(const FilmView *film, __global const uint *splats, uint stride, uint t)
{
    uint name = state_load(splats, stride, SPLAT_PIXEL, t);
    bool from_light = (name & SPLAT_LIGHT) != 0u;
    uint pixel = name & (film->depth_kinds != 0u ? (1u << SPLAT_DEPTH_SHIFT) - 1u : ~SPLAT_LAYERS);
    uint slot = name != NONE ? film_slot(film, pixel) : NONE;
    if (slot == NONE)
        return;
    Vec3 color = state_load_vec3(splats, stride, SPLAT_COLOR, t);
    if (!from_light)
        atomic_count_add(film->counts + slot, 1u);
    if (!vec3_finite(color)) {
        atomic_sum_add(film->not_finite, 1u);
        return;
    }
    uint what = film_color_add((from_light ? film->light_sums : film->sums) + 3u * (size_t)slot, color, film->exponent);
    if (what != FILM_ADDED)
        atomic_sum_add(what == FILM_CLAMPED ? film->saturated : film->vanished, 1u);
    if ((name & SPLAT_RARE) != 0u && film->rare_sums)
        film_color_add(film->rare_sums + 3u * (size_t)slot, color, film->exponent);
    if (film->depth_kinds != 0u)
        film_depth_add(film, slot, name, color);
}

#endif
#endif
