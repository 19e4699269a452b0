/* How the film adds up splats, on the host and on devices: every contribution is rounded to a whole number of units of
 * 2^exponent, the quantum, and added to a 64-bit sum in two's complement, so that neither the order of additions nor
 * which thread makes them matters.
 *
 * A sum that would leave 64 bits saturates at +-SUM_FULL and stays there, and the host reads any sum as at most SUM_MAX
 * in magnitude (film_sum_shown in host/film/film.h). Nor does the order matter then: let p be the total of all positive
 * contributions to a sum and n that of all negative ones, without sign. With both below 2^63 no order saturates the
 * sum. With p above that and n at most SUM_MAX, the sum saturates in some orders and is p - n >= SUM_MAX in others; it
 * reads as SUM_MAX in all. The order could matter only with n above SUM_MAX too, which takes more than 2^14 negative
 * contributions near NEGATIVE_MAX each; only filters with negative lobes and colours outside the gamut make any. */
#ifndef TWINLIGHT_CAMERA_FILM_SUM_H
#define TWINLIGHT_CAMERA_FILM_SUM_H

#include "layout/state.h"

/* Largest magnitude that is read of a sum: at or beyond +-this it is full. */
#define SUM_MAX ((ulong)1 << 62)

/* Where a saturated sum stays. */
#define SUM_FULL (((ulong)1 << 63) - 1u)

/* A sum below SUM_FAR stays below SUM_MAX even if 2^21 concurrent additions add less than UNITS_SMALL each, so those
 * need not check for saturation. */
#define SUM_FAR ((ulong)1 << 61)
#define UNITS_SMALL ((ulong)1 << 40)

/* Larger contributions are clamped. A single path may fill a sum; it takes 2^14 of the largest negative contributions
 * to do so. */
#define CONTRIBUTION_MAX SUM_MAX
#define NEGATIVE_MAX ((ulong)1 << 48)

/* A film as functions see it. It keeps the pixels x0 <= x < x1, y0 <= y < y1, row by row. */
typedef struct FilmView {
    uint width; /* of the whole film */
    uint x0, y0, x1, y1;
    int exponent;
    __global ulong *sums; /* 3 per pixel */
    __global ulong *light_sums; /* the same for splats with SPLAT_LIGHT */
    __global ulong *rare_sums; /* of splats with SPLAT_RARE, which are in one of the others too */
    __global ulong *depth_sums; /* the same again for each depth: film_depth_place */
    uint depth_kinds; /* kinds of depth_sums: 0 (splats carry no depth), 1: light, 3: light, own and rare */
    uint depth_last; /* largest depth that has sums; the smallest is SPLAT_DEPTH_MIN */
    __global uint *counts; /* samples of a pixel */
    __global ulong *saturated; /* contributions that were clamped */
    __global ulong *vanished; /* contributions that are not black, but less than half a unit in every channel */
    __global ulong *not_finite; /* contributions that were not finite and counted as zero */
} FilmView;

#define FILM_KIND_LIGHT 0u
#define FILM_KIND_OWN 1u
#define FILM_KIND_RARE 2u

/* Where the sums of one kind and of paths of `depth` segments begin in depth_sums; 3 per pixel. */
SHARED_FUNCTION size_t film_depth_place(uint pixels, uint kinds, uint depth, uint kind)
{
    return 3u * (size_t)pixels * ((depth - SPLAT_DEPTH_MIN) * kinds + kind);
}

/* Words of depth_sums. */
SHARED_FUNCTION size_t film_depth_words(uint pixels, uint kinds, uint depth_last)
{
    return depth_last >= SPLAT_DEPTH_MIN ? film_depth_place(pixels, kinds, depth_last + 1u, 0u) : 0u;
}

/* Words of a film's sums in one buffer (BUFFER_FILM), except for the sums by depth, which follow: the sums, the three
 * counters, the pixels' counts, two per word, the light sums if `more` is 1 or 2, and the rare sums if it is 2. */
SHARED_FUNCTION ulong film_words(uint pixels, uint more)
{
    return (1u + more) * 3u * (ulong)pixels + 3u + ((ulong)pixels + 1u) / 2u;
}

/* Points the view into such a buffer; depth_kinds must be set. */
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

/* Index of the pixel among those kept, or NONE. */
SHARED_FUNCTION uint film_slot(const FilmView *film, uint pixel)
{
    uint x = pixel % film->width, y = pixel / film->width;
    bool kept = x >= film->x0 && x < film->x1 && y >= film->y0 && y < film->y1;
    return kept ? (y - film->y0) * (film->x1 - film->x0) + x - film->x0 : NONE;
}

/* |value| in units of 2^exponent, rounded to the nearest, halves up, and clamped to CONTRIBUTION_MAX, or NEGATIVE_MAX
 * where value < 0. *clamped: whether it was larger. In integers, since without doubles a device cannot scale a float by
 * every power of two. */
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

/* Whether the sum has saturated. */
SHARED_FUNCTION bool film_sum_full(ulong sum)
{
    return sum == SUM_FULL || sum == 0u - SUM_FULL;
}

/* A sum that is not full plus `units`, which may themselves be another sum; saturates. */
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

/* Adds to one sum, atomically; saturates. */
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

/* Results of film_color_add. */
#define FILM_ADDED 0u
#define FILM_CLAMPED 1u
#define FILM_VANISHED 2u

/* Adds a contribution to the three sums of a pixel. Returns FILM_*. */
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

/* Adds to the sums by depth a splat that has been added to the main sums. */
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

/* Adds a splat of a buffer, and one sample to its pixel unless the splat comes from the light. Any number of threads or
 * work-items may do so concurrently. */
SHARED_FUNCTION void film_splat_add(const FilmView *film, __global const uint *splats, uint stride, uint item)
{
    uint name = state_load(splats, stride, SPLAT_PIXEL, item);
    bool from_light = (name & SPLAT_LIGHT) != 0u;
    uint pixel = name & (film->depth_kinds != 0u ? (1u << SPLAT_DEPTH_SHIFT) - 1u : ~SPLAT_LAYERS);
    uint slot = name != NONE ? film_slot(film, pixel) : NONE;
    if (slot == NONE)
        return;
    Vec3 color = state_load_vec3(splats, stride, SPLAT_COLOR, item);
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
