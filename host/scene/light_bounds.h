/* Bounds of lights, of which the tree is built by which a light is chosen for a point (scene/light_tree.c). */
#ifndef TWINLIGHT_SCENE_LIGHT_BOUNDS_H
#define TWINLIGHT_SCENE_LIGHT_BOUNDS_H

#include "geometry/box.h"
#include "layout/scene_view.h"

#include <stdbool.h>

/* Directions within `angle` of the axis; of none: angle < 0. */
typedef struct Cone {
    Vec3 axis;
    double angle;
} Cone;

/* A light, or several together. */
typedef struct LightBounds {
    Box box;
    Cone normals; /* of beams (spots, projections): all directions in which light leaves */
    double emission; /* light leaves this far from the normals: pi / 2; of beams 0 */
    double intensity; /* sum of the largest in any direction: intensity / distance^2 is what arrives */
    bool two_sided;
    bool infinite; /* no place; intensity: irradiance */
} LightBounds;

/* Those of no light. */
LightBounds light_bounds_empty(void);
void light_bounds_join(LightBounds *a, const LightBounds *b);

/* Bounds of one light. power: luminance of its flux; of a light at infinity without a portal, of the irradiance of a
 * surface that faces it. */
LightBounds light_bounds(const SceneView *view, uint light, double power);

/* Distance from a point to the farthest corner of a box. */
double box_reach(const Box *box, Vec3 from);

/* Whether nothing but the intensity distinguishes them, as the two triangles of a square. */
bool light_bounds_alike(const LightBounds *a, const LightBounds *b);

#endif
