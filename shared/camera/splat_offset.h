/* The film position of a splat relative to the pixel that it names, in one word: the offset from the pixel's centre
 * along x and y, as parts of the filter's radius in 2^16 steps. */
#ifndef TWINLIGHT_CAMERA_SPLAT_OFFSET_H
#define TWINLIGHT_CAMERA_SPLAT_OFFSET_H

#include "layout/frame_params.h"

#define SPLAT_OFFSET_STEPS 65536.0f

/* offset: pixels, in [-radius, radius]. */
SHARED_FUNCTION uint splat_offset_axis(float offset, float radius)
{
    return (uint)float_clamp((0.5f * (offset / radius) + 0.5f) * SPLAT_OFFSET_STEPS, 0.0f, SPLAT_OFFSET_STEPS - 1.0f);
}

/* The word for a splat at film position `film` whose pixel is `pixel`. */
SHARED_FUNCTION uint splat_offset(__global const FilmParams *params, uint pixel, Vec2 film)
{
    uint column = pixel % params->width, row = pixel / params->width;
    float x = film.x - ((float)column + 0.5f), y = film.y - ((float)row + 0.5f);
    return splat_offset_axis(x, params->filter.radius_x) | splat_offset_axis(y, params->filter.radius_y) << 16;
}

/* The middle of a step, pixels. */
SHARED_FUNCTION float splat_offset_of(uint step, float radius)
{
    return (((float)step + 0.5f) * (2.0f / SPLAT_OFFSET_STEPS) - 1.0f) * radius;
}

#endif
