/* How far out rays of a scene usually start, for hierarchies whose boxes are as wide as the origins of rays are far
 * away (box_margin). */
#ifndef TWINLIGHT_BACKEND_RAY_REACH_H
#define TWINLIGHT_BACKEND_RAY_REACH_H

#include "layout/scene_view.h"

/* The largest coordinate of an origin for which boxes are to be widened: frame->ray_reach, unless that would make boxes
 * larger than most primitives. Then it covers the camera and 99 of 100 primitives and instances of the world. */
float ray_reach_inner(const SceneView *view, uint instance_count);

/* How many primitives and instances of the world, few of all, reach more than STRAY_FACTOR times as far from the origin
 * as all others, and how far those and the others do. 0: none. */
uint ray_reach_strays(const SceneView *view, uint instance_count, float *strays, float *others);

#define STRAY_FACTOR 1e4f

#endif
