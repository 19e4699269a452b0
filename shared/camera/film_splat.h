/* Which pixel a splat at an arbitrary film position goes to: one drawn among those whose filter covers the position.
 * The expected image is that of camera/pixel_filter.h, which draws film positions for a given pixel from the same
 * tables: pixel c gets f(film - c) / (integral of f) per unit of pixel area, and nothing is renormalised at borders. */
#ifndef TWINLIGHT_CAMERA_FILM_SPLAT_H
#define TWINLIGHT_CAMERA_FILM_SPLAT_H

#include "camera/pixel_filter.h"

/* |f| at `offset` (pixels from the pixel's centre) along one axis, over the integral of |f|: the density of
 * pixel_filter_sample. table: that of the axis, in `lookup`. *sign: of f. */
SHARED_FUNCTION float film_splat_density(const SceneView *scene, uint table, float radius, float offset, float *sign)
{
    uint kind = scene->frame->film.filter.kind;
    *sign = 1.0f;
    if (kind == PIXEL_FILTER_BOX)
        return 0.5f / radius;
    if (kind == PIXEL_FILTER_TRIANGLE)
        return float_max(radius - float_abs(offset), 0.0f) / (radius * radius);
    __global const float *cdf = scene->lookup + table;
    uint cell = distribution_cell_of(0.5f * (offset / radius) + 0.5f, PIXEL_FILTER_CELLS);
    *sign = cdf[PIXEL_FILTER_CELLS + 1u + cell];
    return (cdf[cell + 1u] - cdf[cell]) * ((0.5f * (float)PIXEL_FILTER_CELLS) / radius);
}

/* The pixels begin <= i < end along an axis whose filter may cover `film`: *first ... *last. False if there are
 * none. */
SHARED_FUNCTION bool film_splat_range(float radius, uint begin, uint end, float film, uint *first, uint *last)
{
    float low = float_max(float_floor(film - 0.5f - radius) + 1.0f, (float)begin);
    float high = float_min(float_floor(film - 0.5f + radius), (float)end - 1.0f);
    if (!(low <= high))
        return false;
    *first = (uint)low;
    *last = (uint)high;
    return true;
}

/* An axis of the film: the filter along it, and the pixels begin <= i < end of the crop window. */
typedef struct FilmAxis {
    uint table; /* in `lookup` */
    float radius;
    uint begin, end;
} FilmAxis;

SHARED_FUNCTION FilmAxis film_axis_x(__global const FrameParams *frame)
{
    FilmAxis axis = {frame->film.filter.table_x, frame->film.filter.radius_x, frame->film.crop_x0, frame->film.crop_x1};
    return axis;
}

SHARED_FUNCTION FilmAxis film_axis_y(__global const FrameParams *frame)
{
    FilmAxis axis = {frame->film.filter.table_y, frame->film.filter.radius_y, frame->film.crop_y0, frame->film.crop_y1};
    return axis;
}

/* Draws one of the pixels i of an axis in proportion to |f(film - i - 0.5)|; NONE if no filter covers `film`. *weight:
 * the sum of |f| / (integral of |f|) over all of them, with the sign of f at the one drawn.
 *
 * Reservoir sampling in one pass: the pixel drawn so far is replaced with probability f / (sum so far); what each
 * decision leaves of u is uniform again and serves the next. */
SHARED_FUNCTION uint film_splat_axis(const SceneView *scene, FilmAxis axis, float film, float u, float *weight)
{
    uint chosen = NONE, first, last;
    float sum = 0.0f, sign = 1.0f;
    *weight = 0.0f;
    if (!film_splat_range(axis.radius, axis.begin, axis.end, film, &first, &last))
        return NONE;
    for (uint i = first; i <= last; ++i) {
        float sign_here;
        float f = film_splat_density(scene, axis.table, axis.radius, film - ((float)i + 0.5f), &sign_here);
        if (!(f > 0.0f))
            continue;
        float before = sum, place;
        sum += f;
        place = u * sum;
        bool take = chosen == NONE || place < f;
        u = float_select(take, place, place - f) / float_select(take, f, before);
        chosen = take ? i : chosen;
        sign = take ? sign_here : sign;
    }
    *weight = sign * sum;
    return chosen;
}

/* |*weight| of film_splat_axis. */
SHARED_FUNCTION float film_splat_sum(const SceneView *scene, FilmAxis axis, float film)
{
    uint first, last;
    float sum = 0.0f, sign;
    if (!film_splat_range(axis.radius, axis.begin, axis.end, film, &first, &last))
        return 0.0f;
    for (uint i = first; i <= last; ++i)
        sum += film_splat_density(scene, axis.table, axis.radius, film - ((float)i + 0.5f), &sign);
    return sum;
}

/* The pixel (y * width + x, inside the crop window) that a splat at film position `film` (pixels, continuous) goes to;
 * NONE if no pixel's filter covers the position. *weight: factor of its colour. u in [0, 1)^2. The film divides sums by
 * the samples per pixel, of which there are as many as light paths per pixel of the crop window. */
SHARED_FUNCTION uint film_splat_pixel(const SceneView *scene, Vec2 film, Vec2 u, float *weight)
{
    __global const FrameParams *frame = scene->frame;
    float weight_x, weight_y;
    uint x = film_splat_axis(scene, film_axis_x(frame), film.x, u.x, &weight_x);
    uint y = film_splat_axis(scene, film_axis_y(frame), film.y, u.y, &weight_y);
    *weight = weight_x * weight_y * frame->film.filter.weight;
    return x == NONE || y == NONE ? NONE : y * frame->film.width + x;
}

/* Coverage of the film position by all filters: the sum over pixels c of |f(film - c)| / (integral of |f|). 1 except
 * near borders and for filters that do not add up to a constant. */
SHARED_FUNCTION float film_splat_cover(const SceneView *scene, Vec2 film)
{
    __global const FrameParams *frame = scene->frame;
    return film_splat_sum(scene, film_axis_x(frame), film.x) * film_splat_sum(scene, film_axis_y(frame), film.y);
}

/* The cell of an axis of `pixels` pixels, beginning at pixel `first`, that contains `film` or is nearest to it. */
SHARED_FUNCTION uint importance_axis(float film, uint first, uint pixels)
{
    float place = (film - (float)first) * ((float)IMPORTANCE_SIDE / (float)pixels);
    return (uint)float_clamp(place, 0.0f, (float)IMPORTANCE_SIDE - 1.0f);
}

/* The cell of the target importance that contains a film position. */
SHARED_FUNCTION uint importance_cell(__global const FrameParams *frame, Vec2 film)
{
    uint x = importance_axis(film.x, frame->film.crop_x0, frame->film.crop_x1 - frame->film.crop_x0);
    uint y = importance_axis(film.y, frame->film.crop_y0, frame->film.crop_y1 - frame->film.crop_y0);
    return y * IMPORTANCE_SIDE + x;
}

SHARED_FUNCTION float film_importance(__global const FrameParams *frame, __global const Guide *guide, Vec2 film)
{
    return guide->importance[importance_cell(frame, film)];
}

#endif
