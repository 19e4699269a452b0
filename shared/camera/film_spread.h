/* How splats get onto the film. With RECONSTRUCTION_SAMPLE a splat goes to the pixel that it names, which was drawn in
 * proportion to the filters that cover its position (or the position in proportion to the pixel's filter). With
 * RECONSTRUCTION_SPLAT it is spread over all these pixels in that proportion: the expected value of that draw, given
 * the position. The expected image is the same; variance per pixel is less by the integral of the filter's square (4/9
 * of it is left for a triangle of radius 1), and neighbouring pixels have noise in common. */
#ifndef TWINLIGHT_CAMERA_FILM_SPREAD_H
#define TWINLIGHT_CAMERA_FILM_SPREAD_H

#include "camera/film_sum.h"
#include "camera/splat_offset.h"

/* A splat is spread in this many equal parts. They are whole, so that the shares of all pixels add up to the splat, and
 * the number of parts that a pixel's samples have given it is exact. */
#define SPREAD_PARTS 256u

/* Units per sample in the film's counts. A pixel is divided by the parts that it has got, so that a constant image
 * stays constant wherever samples lie. */
SHARED_FUNCTION uint film_sample_units(uint reconstruction)
{
    return reconstruction == RECONSTRUCTION_SPLAT ? SPREAD_PARTS : 1u;
}

/* Whether the shares of pixels can be negative. Then their sum is no measure of how many samples lie nearby, and a
 * sample counts for its own pixel alone. */
SHARED_FUNCTION bool film_filter_signed(uint kind)
{
    return kind == PIXEL_FILTER_MITCHELL || kind == PIXEL_FILTER_SINC;
}

#ifdef atomic_sum_add

/* A number in [0, 1) that is uniform over positions: random rounding of shares. */
SHARED_FUNCTION float spread_rounding(uint offset)
{
    uint bits = (offset ^ offset >> 15) * 0x2c1b3c6du;
    return (float)(bits >> 8) * 0x1p-24f;
}

/* The filters' densities along an axis at a film position. */
#define SPREAD_PIXELS_MAX 17u

typedef struct SpreadAxis {
    uint first, count; /* pixels */
    float density[SPREAD_PIXELS_MAX];
    float sign[SPREAD_PIXELS_MAX];
    float sum; /* of the densities */
} SpreadAxis;

SHARED_FUNCTION void spread_axis_set(SpreadAxis *out, const FilmAxis *axis, float film)
{
    uint last;
    out->count = 0u;
    out->sum = 0.0f;
    if (!film_axis_range(axis, film, &out->first, &last))
        return;
    out->count = last - out->first + 1u < SPREAD_PIXELS_MAX ? last - out->first + 1u : SPREAD_PIXELS_MAX;
    for (uint i = 0; i < out->count; ++i) {
        out->density[i] = film_axis_density(axis, film - ((float)(out->first + i) + 0.5f), &out->sign[i]);
        out->sum += out->density[i];
    }
}

/* A splat that is being spread. */
typedef struct Spread {
    const FilmView *film;
    FilmPending *pending;
    FilmUnits units;
    FilmShare share;
    bool counts; /* as a sample of all pixels */
    __global ulong *pending_sums; /* all shares go to these alone, by way of `pending`; NULL: film_share_add */
    uint parts; /* given to pixels so far, and the same in units */
    ulong given[3];
} Spread;

/* A channel's units that the first `parts` of all parts have. */
SHARED_FUNCTION ulong spread_due(ulong units, uint parts, bool small)
{
    return small ? units * parts / SPREAD_PARTS
                 : units / SPREAD_PARTS * parts + units % SPREAD_PARTS * parts / SPREAD_PARTS;
}

/* Gives the pixel share.slot the parts up to `parts` of all. */
SHARED_FUNCTION void spread_add(Spread *spread, uint parts, bool negative)
{
    uint samples = spread->counts ? parts - spread->parts : 0u;
    for (uint c = 0; c < 3u; ++c) {
        ulong due = spread_due(spread->units.rgb[c], parts, spread->share.small), own = due - spread->given[c];
        spread->share.rgb[c] = spread->units.negative[c] != negative ? 0u - own : own;
        spread->given[c] = due;
    }
    spread->parts = parts;
    if (spread->pending_sums) {
        film_pending_put(spread->film, spread->pending, spread->pending_sums, &spread->share, samples);
        return;
    }
    spread->share.samples = samples;
    film_share_add(spread->film, spread->pending, &spread->share);
}

/* Spreads a splat over the pixels of both axes. Systematic rounding: after each pixel, the parts given are the floor of
 * `rounding` plus those due, so that every pixel's expected share is exact. */
SHARED_FUNCTION void spread_all(Spread *spread, const SpreadAxis *across, const SpreadAxis *down, float rounding)
{
    const FilmView *film = spread->film;
    float scale = (float)SPREAD_PARTS / (across->sum * down->sum), density = 0.0f;
    for (uint j = 0; j < down->count; ++j) {
        uint y = down->first + j, row = (y - film->y0) * (film->x1 - film->x0) - film->x0;
        for (uint i = 0; i < across->count; ++i) {
            bool last = j + 1u == down->count && i + 1u == across->count;
            density += across->density[i] * down->density[j];
            float due = last ? (float)SPREAD_PARTS : float_min(density * scale, (float)SPREAD_PARTS);
            uint parts = (uint)(due + rounding), x = across->first + i;
            spread->share.slot = row + x;
            spread->share.place = film_pending_place(x, y);
            if (parts != spread->parts)
                spread_add(spread, parts, across->sign[i] * down->sign[j] < 0.0f);
        }
    }
}

/* A splat that names the pixel `slot`. */
typedef struct FilmSplat {
    uint name, slot;
    uint column, row; /* of the pixel in the whole film */
    uint offset; /* splat_offset */
    FilmUnits units;
} FilmSplat;

/* Adds a splat to its pixel. */
SHARED_FUNCTION void film_whole_add(const FilmView *film, FilmPending *pending, const FilmSplat *splat)
{
    FilmShare share;
    share.slot = splat->slot;
    share.place = film_pending_place(splat->column, splat->row);
    share.name = splat->name;
    share.small = film_units_small(&splat->units);
    for (uint c = 0; c < 3u; ++c)
        share.rgb[c] = splat->units.negative[c] ? 0u - splat->units.rgb[c] : splat->units.rgb[c];
    share.samples = (splat->name & SPLAT_LIGHT) == 0u ? film_sample_units(film->reconstruction) : 0u;
    film_share_add(film, pending, &share);
}

/* Adds a splat to all pixels whose filter covers it. */
SHARED_FUNCTION void film_spread_add(const FilmView *film, FilmPending *pending, const FilmSplat *splat)
{
    bool sample = (splat->name & SPLAT_LIGHT) == 0u, own = film_filter_signed(film->axis_x.kind);
    float x = (float)splat->column + 0.5f + splat_offset_of(splat->offset & 0xffffu, film->axis_x.radius);
    float y = (float)splat->row + 0.5f + splat_offset_of(splat->offset >> 16, film->axis_y.radius);
    SpreadAxis across, down;
    spread_axis_set(&across, &film->axis_x, x);
    spread_axis_set(&down, &film->axis_y, y);
    if (!(across.sum * down.sum > 0.0f)) { /* by rounding, at the edge of the reach */
        film_whole_add(film, pending, splat);
        return;
    }
    Spread spread;
    spread.film = film;
    spread.pending = pending;
    spread.units = splat->units;
    spread.share.name = splat->name;
    spread.share.small = film_units_small(&splat->units);
    spread.counts = sample && !own;
    spread.pending_sums = 0;
    if (pending && spread.share.small && (splat->name & SPLAT_RARE) == 0u && film->depth_kinds == 0u)
        spread.pending_sums = sample ? film->sums : film->light_sums;
    spread.parts = 0u;
    spread.given[0] = spread.given[1] = spread.given[2] = 0u;
    spread_all(&spread, &across, &down, spread_rounding(splat->offset));
    if (sample && own)
        atomic_count_add(film->counts + splat->slot, SPREAD_PARTS);
}

/* Adds a splat of a buffer, and a sample to its pixel unless the splat comes from the light; of a splat that is spread,
 * a part of a sample to each of its pixels. Any number of threads or work-items may do so concurrently. pending: those
 * of this thread; NULL: none. */
SHARED_FUNCTION void film_splat_add(const FilmView *film, FilmPending *pending, __global const uint *splats,
                                    uint stride, uint item)
{
    FilmSplat splat;
    splat.name = state_load(splats, stride, SPLAT_PIXEL, item);
    uint pixel = splat.name & (film->depth_kinds != 0u ? (1u << SPLAT_DEPTH_SHIFT) - 1u : ~SPLAT_LAYERS);
    splat.column = pixel % film->width;
    splat.row = pixel / film->width;
    splat.slot = film_slot_at(film, splat.column, splat.row);
    if (splat.name == NONE || splat.slot == NONE)
        return;
    Vec3 color = state_load_vec3(splats, stride, SPLAT_COLOR, item);
    if (!vec3_finite(color)) {
        atomic_sum_add(film->not_finite, 1u);
        color = vec3_splat(0.0f);
    }
    if ((splat.name & SPLAT_LIGHT) != 0u && vec3_is_zero(color))
        return;
    splat.units = film_color_units(color, film->exponent);
    if (film->reconstruction == RECONSTRUCTION_SPLAT) {
        splat.offset = state_load(splats, stride, SPLAT_OFFSET, item);
        film_spread_add(film, pending, &splat);
    } else {
        film_whole_add(film, pending, &splat);
    }
    if (splat.units.what != FILM_ADDED)
        atomic_sum_add(splat.units.what == FILM_CLAMPED ? film->saturated : film->vanished, 1u);
}

#endif
#endif
