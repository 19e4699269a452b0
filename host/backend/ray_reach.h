/* How far from the origin rays usually start, for hierarchies whose boxes are inflated in proportion to that distance
 * (box_margin). */
#ifndef TWINLIGHT_BACKEND_RAY_REACH_H
#define TWINLIGHT_BACKEND_RAY_REACH_H

#include "layout/scene_view.h"

/* Largest coordinate of ray origins for which boxes should be inflated: frame->scene.ray_reach, unless boxes would
 * become larger than most primitives; then a smaller value that covers the camera and 99 % of the world's primitives
 * and instances. */
float ray_reach_inner(const SceneView *view, uint instance_count);

/* Number of outliers: primitives and instances of the world that extend more than STRAY_FACTOR times as far from the
 * origin as all others, if they are few; else 0. *strays and *others: largest coordinates of both groups, set only if
 * the result is not 0. */
uint ray_reach_strays(const SceneView *view, uint instance_count, float *strays, float *others);

#define STRAY_FACTOR 1e4f

#endif
