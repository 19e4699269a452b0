/* Polygons to triangles. */
#ifndef TWINLIGHT_PBRT_POLYGON_H
#define TWINLIGHT_PBRT_POLYGON_H

#include "math/platform.h"

#include <stdbool.h>
#include <stddef.h>

/* Corners that a polygon may have unless it is a fan from its first corner: clipping ears takes time in the square of
 * their number. */
#define POLYGON_CONCAVE_MAX 4096u

/* Divides the polygon with the corners corner[0 ... count - 1], indices into `positions` (3 floats each), count >= 3,
 * into count - 2 triangles of the same orientation: a fan from the first corner if that covers it, as for every convex
 * polygon, else by clipping ears. Where corners do not lie in a plane, what counts is how they look along their mean
 * normal. One that crosses itself gets some triangles. triangles: room for 3 (count - 2) indices; scratch: for 3 count
 * numbers. False if it is no fan and has more than POLYGON_CONCAVE_MAX corners. */
bool polygon_triangulate(const float *positions, const uint *corner, size_t count, uint *triangles, uint *scratch);

#endif
