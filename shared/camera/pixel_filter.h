/* The pixel filter, importance sampled: the offset of a pixel's sample is drawn from |f|, and its radiance goes to that
 * pixel alone with a weight of constant magnitude (Ernst, Stamminger and Greiner, "Filter Importance Sampling", IEEE
 * Symposium on Interactive Ray Tracing, 2006); or, with RECONSTRUCTION_SPLAT, to all pixels whose filter covers the
 * position (camera/film_spread.h). */
#ifndef TWINLIGHT_CAMERA_PIXEL_FILTER_H
#define TWINLIGHT_CAMERA_PIXEL_FILTER_H

#include "layout/distribution.h"
#include "layout/scene_view.h"

/* Inverse of the triangle filter's distribution function; the result is in [-1, 1]. */
SHARED_FUNCTION float pixel_filter_triangle(float u)
{
    return u < 0.5f ? float_sqrt(2.0f * u) - 1.0f : 1.0f - float_sqrt(2.0f * (1.0f - u));
}

/* Inverts the table that begins at `table` in `lookup`. Returns the offset in units of the radius, in [-1, 1], and
 * multiplies *sign by the cell's sign. A cell without mass is never chosen. */
SHARED_FUNCTION float pixel_filter_invert(const SceneView *scene, uint table, float u, float *sign)
{
    __global const float *cdf = scene->lookup + table;
    uint cell = distribution_cell(scene->lookup, table, PIXEL_FILTER_CELLS, u);
    float inside = (u - cdf[cell]) / (cdf[cell + 1u] - cdf[cell]);
    *sign *= cdf[PIXEL_FILTER_CELLS + 1u + cell];
    return ((float)cell + inside) * (2.0f / (float)PIXEL_FILTER_CELLS) - 1.0f;
}

/* The weight of a splat, whose sign is f's at the pixel that it names. If the film spreads splats over pixels, it
 * applies the sign of each. */
SHARED_FUNCTION float filter_sign_kept(__global const FilmParams *film, float weight)
{
    return film->reconstruction == RECONSTRUCTION_SPLAT ? float_abs(weight) : weight;
}

/* Offset from the pixel's centre in pixels, drawn from |f| with u in [0, 1)^2. *weight is +-(integral of |f|) /
 * (integral of f), so that its expectation is 1 and the expectation of weight times radiance is the filtered image. */
SHARED_FUNCTION Vec2 pixel_filter_sample(const SceneView *scene, Vec2 u, float *weight)
{
    __global const PixelFilter *filter = &scene->frame->film.filter;
    float x, y;
    float sign = 1.0f;
    if (filter->kind == PIXEL_FILTER_BOX) {
        x = 2.0f * u.x - 1.0f;
        y = 2.0f * u.y - 1.0f;
    } else if (filter->kind == PIXEL_FILTER_TRIANGLE) {
        x = pixel_filter_triangle(u.x);
        y = pixel_filter_triangle(u.y);
    } else {
        x = pixel_filter_invert(scene, filter->table_x, u.x, &sign);
        y = pixel_filter_invert(scene, filter->table_y, u.y, &sign);
    }
    *weight = filter_sign_kept(&scene->frame->film, sign) * filter->weight;
    return vec2(x * filter->radius_x, y * filter->radius_y);
}

#endif
