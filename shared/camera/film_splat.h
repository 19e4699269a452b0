/* Which pixel a splat at an arbitrary film position goes to: one drawn among those whose filter covers the position.
 * The expected image is that of camera/pixel_filter.h, which draws film positions for a given pixel from the same
 * tables: pixel c gets f(film - c) / (integral of f) per unit of pixel area, and nothing is renormalised at borders. */
#ifndef TWINLIGHT_CAMERA_FILM_SPLAT_H
#define TWINLIGHT_CAMERA_FILM_SPLAT_H

#include "camera/film_axis.h"
#include "camera/pixel_filter.h"

/* Draws one of the pixels i of an axis in proportion to |f(film - i - 0.5)|; NONE if no filter covers `film`. *weight:
 * the sum of |f| / (integral of |f|) over all of them, with the sign of f at the one drawn.
 *
 * Reservoir sampling in one pass: the pixel drawn so far is replaced with probability f / (sum so far); what each
 * decision leaves of u is uniform again and serves the next. */
SHARED_FUNCTION uint film_splat_axis(const FilmAxis *axis, float film, float u, float *weight)
{
    uint chosen = NONE, first, last;
    float sum = 0.0f, sign = 1.0f;
    *weight = 0.0f;
    if (!film_axis_range(axis, film, &first, &last))
        return NONE;
    for (uint i = first; i <= last; ++i) {
        float sign_here;
        float f = film_axis_density(axis, film - ((float)i + 0.5f), &sign_here);
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

/* The pixel (y * width + x, inside the crop window) that a splat at film position `film` (pixels, continuous) goes to;
 * NONE if no pixel's filter covers the position. *weight: factor of its colour. u in [0, 1)^2. The film divides sums by
 * the samples per pixel, of which there are as many as light paths per pixel of the crop window. */
SHARED_FUNCTION uint film_splat_pixel(const SceneView *scene, Vec2 film, Vec2 u, float *weight)
{
    __global const FrameParams *frame = scene->frame;
    FilmAxis axis_x = film_axis_x(&frame->film, scene->lookup), axis_y = film_axis_y(&frame->film, scene->lookup);
    float weight_x, weight_y;
    uint x = film_splat_axis(&axis_x, film.x, u.x, &weight_x), y = film_splat_axis(&axis_y, film.y, u.y, &weight_y);
    *weight = filter_sign_kept(&frame->film, weight_x * weight_y) * frame->film.filter.weight;
    return x == NONE || y == NONE ? NONE : y * frame->film.width + x;
}

/* Coverage of the film position by all filters: the sum over pixels c of |f(film - c)| / (integral of |f|). 1 except
 * near borders and for filters that do not add up to a constant. */
SHARED_FUNCTION float film_splat_cover(const SceneView *scene, Vec2 film)
{
    __global const FilmParams *params = &scene->frame->film;
    FilmAxis axis_x = film_axis_x(params, scene->lookup), axis_y = film_axis_y(params, scene->lookup);
    return film_axis_sum(&axis_x, film.x) * film_axis_sum(&axis_y, film.y);
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
