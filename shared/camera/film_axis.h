/* The pixel filter along an axis of the film: where it is not zero, and which pixels it covers. */
#ifndef TWINLIGHT_CAMERA_FILM_AXIS_H
#define TWINLIGHT_CAMERA_FILM_AXIS_H

#include "layout/distribution.h"
#include "layout/frame_params.h"

/* An axis of the film: the filter along it, and the pixels begin <= i < end of the crop window. */
typedef struct FilmAxis {
    uint kind; /* PIXEL_FILTER_* */
    __global const float *table; /* of the filter, unless box or triangle (layout/scene_types.h) */
    float radius;
    uint begin, end;
} FilmAxis;

/* lookup: the scene's. */
SHARED_FUNCTION FilmAxis film_axis_x(const __global FilmParams *film, __global const float *lookup)
{
    FilmAxis axis = {film->filter.kind, lookup, film->filter.radius_x, film->crop_x0, film->crop_x1};
    if (film->filter.table_x != NONE)
        axis.table += film->filter.table_x;
    return axis;
}

SHARED_FUNCTION FilmAxis film_axis_y(const __global FilmParams *film, __global const float *lookup)
{
    FilmAxis axis = {film->filter.kind, lookup, film->filter.radius_y, film->crop_y0, film->crop_y1};
    if (film->filter.table_y != NONE)
        axis.table += film->filter.table_y;
    return axis;
}

/* |f| at `offset` (pixels from the pixel's centre), over the integral of |f|: the density of pixel_filter_sample along
 * the axis. *sign: of f. */
SHARED_FUNCTION float film_axis_density(const FilmAxis *axis, float offset, float *sign)
{
    float radius = axis->radius;
    *sign = 1.0f;
    if (axis->kind == PIXEL_FILTER_BOX)
        return 0.5f / radius;
    if (axis->kind == PIXEL_FILTER_TRIANGLE)
        return float_max(radius - float_abs(offset), 0.0f) / (radius * radius);
    uint cell = distribution_cell_of(0.5f * (offset / radius) + 0.5f, PIXEL_FILTER_CELLS);
    *sign = axis->table[PIXEL_FILTER_CELLS + 1u + cell];
    return (axis->table[cell + 1u] - axis->table[cell]) * ((0.5f * (float)PIXEL_FILTER_CELLS) / radius);
}

/* The pixels whose filter may cover `film`: *first ... *last. False if there are none. */
SHARED_FUNCTION bool film_axis_range(const FilmAxis *axis, float film, uint *first, uint *last)
{
    *first = *last = 0u;
    float low = float_max(float_floor(film - 0.5f - axis->radius) + 1.0f, (float)axis->begin);
    float high = float_min(float_floor(film - 0.5f + axis->radius), (float)axis->end - 1.0f);
    if (!(low <= high))
        return false;
    *first = (uint)low;
    *last = (uint)high;
    return true;
}

/* Coverage of `film` by the filters along the axis: the sum over pixels i of |f(film - i - 0.5)| / (integral of
 * |f|). */
SHARED_FUNCTION float film_axis_sum(const FilmAxis *axis, float film)
{
    uint first, last;
    float sum = 0.0f, sign;
    if (!film_axis_range(axis, film, &first, &last))
        return 0.0f;
    for (uint i = first; i <= last; ++i)
        sum += film_axis_density(axis, film - ((float)i + 0.5f), &sign);
    return sum;
}

#endif
