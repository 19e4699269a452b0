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

#include "camera/film_axis.h"
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
    uint reconstruction; /* RECONSTRUCTION_* */
    FilmAxis axis_x, axis_y; /* for RECONSTRUCTION_SPLAT */
    __global uint *counts; /* samples of a pixel, in units of film_sample_units */
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

/* Index of the pixel in column x and row y among those kept, or NONE. */
SHARED_FUNCTION uint film_slot_at(const FilmView *film, uint x, uint y)
{
    bool kept = x >= film->x0 && x < film->x1 && y >= film->y0 && y < film->y1;
    return kept ? (y - film->y0) * (film->x1 - film->x0) + x - film->x0 : NONE;
}

/* The same of a pixel y * width + x of the whole film. */
SHARED_FUNCTION uint film_slot(const FilmView *film, uint pixel)
{
    return film_slot_at(film, pixel % film->width, pixel / film->width);
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

/* Results of adding a color. */
#define FILM_ADDED 0u
#define FILM_CLAMPED 1u
#define FILM_VANISHED 2u

/* A color in units of the film's sums. */
typedef struct FilmUnits {
    ulong rgb[3]; /* magnitudes */
    bool negative[3];
    uint what; /* FILM_* */
} FilmUnits;

SHARED_FUNCTION FilmUnits film_color_units(Vec3 color, int exponent)
{
    const float values[3] = {color.x, color.y, color.z};
    bool any_clamped = false, black = true, none = true;
    FilmUnits units;
    for (uint c = 0; c < 3u; ++c) {
        bool clamped;
        units.rgb[c] = film_units(values[c], exponent, &clamped);
        units.negative[c] = values[c] < 0.0f;
        any_clamped = any_clamped || clamped;
        black = black && values[c] == 0.0f;
        none = none && units.rgb[c] == 0u;
    }
    units.what = any_clamped ? FILM_CLAMPED : none && !black ? FILM_VANISHED : FILM_ADDED;
    return units;
}

/* Whether every channel is below UNITS_SMALL. */
SHARED_FUNCTION bool film_units_small(const FilmUnits *units)
{
    return (units->rgb[0] | units->rgb[1] | units->rgb[2]) < UNITS_SMALL;
}

/* A pixel's share of a splat. */
typedef struct FilmShare {
    uint slot; /* the pixel */
    uint place; /* film_pending_place */
    uint name; /* of the splat */
    ulong rgb[3]; /* units, two's complement */
    bool small; /* below UNITS_SMALL in magnitude */
    uint samples; /* to be counted, in units of film_sample_units */
} FilmShare;

SHARED_FUNCTION void film_sums_add(__global ulong *sums, const ulong rgb[3])
{
    for (uint c = 0; c < 3u; ++c)
        if (rgb[c] != 0u)
            film_sum_add(sums + c, rgb[c]);
}

/* What a thread of the host has not yet added to the film: a table of pixels, in which small shares that meet in a
 * pixel are added up without atomic operations. Devices have none. It is emptied after at most FILM_PENDING_SPLATS
 * splats, so that no sum in it overflows. Its places repeat every FILM_PENDING_COLUMNS columns and FILM_PENDING_ROWS
 * rows: more rows than a band of pixels (layout/item.h) has, and the filter around it. */
#define FILM_PENDING_COLUMNS 32u
#define FILM_PENDING_ROWS 16u
#define FILM_PENDING_PIXELS (FILM_PENDING_COLUMNS * FILM_PENDING_ROWS)
#define FILM_PENDING_SPLATS (1u << 16)

typedef struct FilmPendingPixel {
    __global ulong *sums; /* of the pixel; NULL: none */
    ulong rgb[3];
    uint slot, samples;
} FilmPendingPixel;

typedef struct FilmPending {
    FilmPendingPixel pixels[FILM_PENDING_PIXELS];
} FilmPending;

/* The place of the pixel in column x and row y. */
SHARED_FUNCTION uint film_pending_place(uint x, uint y)
{
    return y % FILM_PENDING_ROWS * FILM_PENDING_COLUMNS + x % FILM_PENDING_COLUMNS;
}

SHARED_FUNCTION void film_pending_begin(FilmPending *pending)
{
    for (uint place = 0; place < FILM_PENDING_PIXELS; ++place)
        pending->pixels[place].sums = 0;
}

SHARED_FUNCTION void film_pending_add(const FilmView *film, const FilmPendingPixel *pixel)
{
    if (!pixel->sums)
        return;
    film_sums_add(pixel->sums, pixel->rgb);
    if (pixel->samples != 0u)
        atomic_count_add(film->counts + pixel->slot, pixel->samples);
}

SHARED_FUNCTION void film_pending_end(const FilmView *film, const FilmPending *pending)
{
    for (uint place = 0; place < FILM_PENDING_PIXELS; ++place)
        film_pending_add(film, &pending->pixels[place]);
}

/* Gives a place of the table, which may be another pixel's, to the sums of the pixel `slot`. */
SHARED_FUNCTION void film_pending_take(const FilmView *film, FilmPendingPixel *pixel, __global ulong *sums, uint slot)
{
    film_pending_add(film, pixel);
    pixel->sums = sums;
    pixel->slot = slot;
    pixel->rgb[0] = pixel->rgb[1] = pixel->rgb[2] = 0u;
    pixel->samples = 0u;
}

/* Adds a small share to the sums of its pixel, which are sums[3 slot] and those after it, and to its samples. */
SHARED_FUNCTION void film_pending_put(const FilmView *film, FilmPending *pending, __global ulong *sums,
                                      const FilmShare *share, uint samples)
{
    FilmPendingPixel *pixel = &pending->pixels[share->place];
    sums += 3u * (size_t)share->slot;
    if (pixel->sums != sums)
        film_pending_take(film, pixel, sums, share->slot);
    for (uint c = 0; c < 3u; ++c)
        pixel->rgb[c] += share->rgb[c];
    pixel->samples += samples;
}

/* Adds a share to three sums of its pixel, and the samples to its count. */
SHARED_FUNCTION void film_rgb_add(const FilmView *film, FilmPending *pending, __global ulong *sums,
                                  const FilmShare *share, uint samples)
{
    if (pending && share->small) {
        film_pending_put(film, pending, sums, share, samples);
        return;
    }
    film_sums_add(sums + 3u * (size_t)share->slot, share->rgb);
    if (samples != 0u)
        atomic_count_add(film->counts + share->slot, samples);
}

/* Adds to the sums by depth a share that has been added to the main sums. */
SHARED_FUNCTION void film_depth_add(const FilmView *film, FilmPending *pending, const FilmShare *share)
{
    uint pixels = (film->x1 - film->x0) * (film->y1 - film->y0), kinds = film->depth_kinds;
    uint depth = share->name >> SPLAT_DEPTH_SHIFT & SPLAT_DEPTH_MAX;
    uint kind = (share->name & SPLAT_LIGHT) != 0u ? FILM_KIND_LIGHT : FILM_KIND_OWN;
    if (depth < SPLAT_DEPTH_MIN || depth > film->depth_last)
        return;
    if (kind < kinds)
        film_rgb_add(film, pending, film->depth_sums + film_depth_place(pixels, kinds, depth, kind), share, 0u);
    if ((share->name & SPLAT_RARE) != 0u && FILM_KIND_RARE < kinds)
        film_rgb_add(film, pending, film->depth_sums + film_depth_place(pixels, kinds, depth, FILM_KIND_RARE), share,
                     0u);
}

/* Adds a share to the sums that the splat's name says, at a pixel that the film keeps. */
SHARED_FUNCTION void film_share_add(const FilmView *film, FilmPending *pending, const FilmShare *share)
{
    bool from_light = (share->name & SPLAT_LIGHT) != 0u;
    film_rgb_add(film, pending, from_light ? film->light_sums : film->sums, share, share->samples);
    if ((share->name & SPLAT_RARE) != 0u && film->rare_sums)
        film_rgb_add(film, pending, film->rare_sums, share, 0u);
    if (film->depth_kinds != 0u)
        film_depth_add(film, pending, share);
}

#endif
#endif
