/* The frame in which openings are rectangles perpendicular to axes. */
#ifndef TWINLIGHT_RENDER_OPENING_FRAME_H
#define TWINLIGHT_RENDER_OPENING_FRAME_H

#include "math/vec.h"

#include <stddef.h>

/* Axes to which most surfaces are perpendicular, in the order and with the signs that are nearest to the world's: those
 * of the world exactly if they are as good as equal. normals: `count` unit vectors, of surfaces seen from anywhere; may
 * be zero, which count for nothing. */
Frame opening_frame(const Vec3 *normals, size_t count);

#endif
