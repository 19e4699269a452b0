/* Axis-aligned boxes around primitives: for the scene's bounds, and widened for hierarchies that any traversal may walk. */
#ifndef TWINLIGHT_BOX_H
#define TWINLIGHT_BOX_H

#include "ray.h"
#include "scene_view.h"

typedef struct Box {
    float low[3], high[3];
} Box;

/* Contains nothing: low is +infinity, high -infinity. */
SHARED_FUNCTION Box box_empty(void)
{
    Box box;
    for (int i = 0; i < 3; ++i) {
        box.low[i] = FLOAT_INFINITY;
        box.high[i] = -FLOAT_INFINITY;
    }
    return box;
}

SHARED_FUNCTION bool box_is_empty(const Box *box)
{
    return !(box->low[0] <= box->high[0]);
}

SHARED_FUNCTION void box_add(Box *box, Vec3 p)
{
    float c[3];
    c[0] = p.x;
    c[1] = p.y;
    c[2] = p.z;
    for (int i = 0; i < 3; ++i) {
        box->low[i] = float_min(box->low[i], c[i]);
        box->high[i] = float_max(box->high[i], c[i]);
    }
}

SHARED_FUNCTION void box_join(Box *box, const Box *other)
{
    for (int i = 0; i < 3; ++i) {
        box->low[i] = float_min(box->low[i], other->low[i]);
        box->high[i] = float_max(box->high[i], other->high[i]);
    }
}

/* The box of `box`'s image under the map; `box` must not be empty. */
SHARED_FUNCTION Box box_transform(const Box *box, Affine map)
{
    Box image = box_empty();
    for (int corner = 0; corner < 8; ++corner)
        box_add(&image, affine_point(map, vec3((corner & 1) != 0 ? box->high[0] : box->low[0],
                                               (corner & 2) != 0 ? box->high[1] : box->low[1],
                                               (corner & 4) != 0 ? box->high[2] : box->low[2])));
    return image;
}

/* `box` with `margin` on every side. */
SHARED_FUNCTION Box box_inflate(Box box, float margin)
{
    for (int i = 0; i < 3; ++i) {
        box.low[i] -= margin;
        box.high[i] += margin;
    }
    return box;
}

/* Traversal: a product, a difference and a reciprocal, each off by half a unit to one; primitive test: the shear, by
 * two units. That 4 suffices is measured: test_geometry_rays.c finds no difference to brute force, nor do 1.2 million
 * rays in a mesh of 1.28 million triangles under two groupings of the triangles. */
#define BOX_MARGIN_ULPS 4.0f

/* What every box is widened by, where all coordinates, those of ray origins included, are at most `largest`. Neither
 * the traversal's slab test nor the primitive test is exact: both place a hit off by a few units in the last place of
 * the largest coordinate, and a box that is hit later than its primitive would make the closest hit depend on the
 * order of the walk. */
SHARED_FUNCTION float box_margin(float largest)
{
    return BOX_MARGIN_ULPS * FLOAT_EPSILON * largest;
}

/* The largest coordinate that a ray's origin takes in the instance's object space, where all of the world lie within
 * `world`. An object's margin follows from the largest of its instances, and of `world`. */
SHARED_FUNCTION float instance_reach(__global const Instance *instance, float world)
{
    return vec3_max_abs(affine_magnitude(instance->object_from_world, vec3(world, world, world)));
}

/* Around an instance, with margin, in world space. `object`: the box of its object without; it must not be empty. */
SHARED_FUNCTION Box instance_box(__global const Instance *instance, Box object, float object_margin, float world_margin)
{
    Box inner = box_inflate(object, object_margin);
    return box_inflate(box_transform(&inner, instance->world_from_object), world_margin);
}

SHARED_FUNCTION Box quadric_box(__global const Quadric *quadric, uint kind)
{
    float r = quadric->radius, w = quadric->world_radius;
    Box box = box_empty();
    if (quadric->whole != 0u) {
        box_add(&box, vec3_sub(quadric->center, vec3_splat(w)));
        box_add(&box, vec3_add(quadric->center, vec3_splat(w)));
        return box;
    }
    box_add(&box, vec3(-r, -r, kind == PRIMITIVE_DISK ? quadric->z_min : float_max(-r, quadric->z_min)));
    box_add(&box, vec3(r, r, kind == PRIMITIVE_DISK ? quadric->z_min : float_min(r, quadric->z_max)));
    return box_transform(&box, quadric->world_from_object);
}

/* Around one primitive, without margin, in the space of its object. */
SHARED_FUNCTION Box primitive_box(const SceneView *scene, uint primitive)
{
    Primitive p = scene->primitives[primitive];
    uint kind = p.shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    Box box = box_empty();
    if (kind == PRIMITIVE_TRIANGLE) {
        box_add(&box, scene->positions[p.a]);
        box_add(&box, scene->positions[p.b]);
        box_add(&box, scene->positions[p.c]);
        return box;
    }
    if (kind != PRIMITIVE_BILINEAR)
        return quadric_box(&scene->quadrics[p.a], kind);
    for (int k = 0; k < 4; ++k)
        box_add(&box, scene->positions[scene->patches[p.a].v[k]]);
    return box;
}

#endif
