/* Surface areas of primitives in world space, in double. */
#ifndef TWINLIGHT_SCENE_PRIMITIVE_AREA_H
#define TWINLIGHT_SCENE_PRIMITIVE_AREA_H

#include "layout/scene_types.h"

double triangle_area(Vec3 a, Vec3 b, Vec3 c);

/* The kernels divide by squared lengths in float, so a triangle whose normal vanishes in float counts as degenerate. */
bool triangle_degenerate(Vec3 a, Vec3 b, Vec3 c);

/* Of a quadric of a PRIMITIVE_* kind, by the midpoint rule with so many points per parameter: exact if its transform is
 * a similarity. */
double quadric_area(const Quadric *quadric, uint kind, int steps);

/* Of a bilinear patch, by the midpoint rule over its Jacobian; exact for parallelograms. */
double patch_area(const Vec3 *positions, const Patch *patch);

/* Enough for the area of an emissive quadric. */
#define QUADRIC_STEPS 64

#endif
