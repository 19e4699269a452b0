/* Boxes around primitives, wide enough for any traversal. */
#ifndef TWINLIGHT_PRIMITIVE_BOUNDS_H
#define TWINLIGHT_PRIMITIVE_BOUNDS_H

#include "scene_view.h"

typedef struct Box {
    float low[3], high[3];
} Box;

Box box_empty(void);
void box_add(Box *box, Vec3 p);
void box_join(Box *box, const Box *other);

/* The box of `box`'s image under the map. */
Box box_transform(const Box *box, const Affine *map);

/* `box` with `margin` on every side. */
Box box_inflate(Box box, float margin);

/* What every box is widened by, where all coordinates, those of ray origins included, are at most `largest`. Neither
 * the traversal's slab test nor the primitive test is exact: both place a hit off by a few units in the last place of
 * the largest coordinate, and a box that is hit later than its primitive would make the closest hit depend on the
 * order of the walk. */
float box_margin(float largest);

/* Without margin. */
Box primitive_box(const SceneView *scene, uint primitive);

#endif
