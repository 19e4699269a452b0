/* Where a scene has smooth specular surfaces: the boxes of their primitives. Light subpaths are aimed at them, since of
 * a light in a wide world hardly any that is drawn from it meets one. */
#ifndef TWINLIGHT_SCENE_SMOOTH_BOXES_H
#define TWINLIGHT_SCENE_SMOOTH_BOXES_H

#include "geometry/box.h"
#include "scene/scene.h"

typedef struct SmoothBoxes {
    Box *each; /* of a primitive, in world space */
    double *sums; /* of the surfaces of boxes up to each */
    size_t count; /* 0: the scene has none */
    Box all; /* around them */
} SmoothBoxes;

/* Call smooth_boxes_destroy even on failure. */
bool smooth_boxes_init(SmoothBoxes *boxes, const Scene *scene, const SceneView *view, Error *error);
void smooth_boxes_destroy(SmoothBoxes *boxes);

/* A point in one of the boxes, of which there must be one. u: uniform in [0, 1). */
Vec3 smooth_boxes_point(const SmoothBoxes *boxes, const double u[4]);

/* Center of all boxes, and half their diagonal. */
Vec3 smooth_boxes_center(const SmoothBoxes *boxes);
double smooth_boxes_radius(const SmoothBoxes *boxes);

#endif
