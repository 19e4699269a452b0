/* Axis-aligned boxes around primitives: for the scene's bounds, as a condition on hits, and widened for hierarchies,
 * whatever the traversal. */
#ifndef TWINLIGHT_GEOMETRY_BOX_H
#define TWINLIGHT_GEOMETRY_BOX_H

#include "geometry/curve.h"
#include "geometry/ray.h"
#include "layout/scene_view.h"

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

SHARED_FUNCTION Vec3 box_center(const Box *box)
{
    return vec3(0.5f * (box->low[0] + box->high[0]), 0.5f * (box->low[1] + box->high[1]),
                0.5f * (box->low[2] + box->high[2]));
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

/* `box` enlarged by `margin` on every side. */
SHARED_FUNCTION Box box_inflate(Box box, float margin)
{
    for (int i = 0; i < 3; ++i) {
        box.low[i] -= margin;
        box.high[i] += margin;
    }
    return box;
}

/* The largest absolute coordinate; 0 for the empty box. */
SHARED_FUNCTION float box_largest(const Box *box)
{
    float largest = 0.0f;
    for (int i = 0; i < 3 && !box_is_empty(box); ++i)
        largest = float_max(largest, float_max(float_abs(box->low[i]), float_abs(box->high[i])));
    return largest;
}

/* ---- hits lie in boxes ------------------------------------------------------------------------------------------- */

/* The closest hit must not depend on the order of traversal, so a traversal has to reach every primitive whose test
 * accepts the ray, at the t that the test finds. Bounding the rounding errors of each primitive's test does not ensure
 * that: where a triangle is seen edge-on all three edge functions may round to zero, and a ray that passes it at any
 * distance is accepted; t of a grazing hit may be far off; bilinear patches overlap. So a hit counts only where the ray
 * is in the primitive's box, widened by hit_margin: box_admits_hit is part of the primitive's test. With u =
 * FLOAT_EPSILON / 2, and A = largest coordinate of the box + largest coordinate of the ray's origin:
 *
 *   - A line that meets a triangle is off it by at most 7 u A in the test's arithmetic: u |p - o| in the differences,
 *     4 u |s z| in the sheared offsets, u of the sheared coordinates, each at most A, 2 A for the last. HIT_ULPS, 6, is
 *     these 3.5 and the 1.5 that box_admits_hit rounds by, so no ray slips through between two triangles because of it.
 *   - A hit that counts is at most HIT_ULPS + 1.5 units of FLOAT_EPSILON A outside the box in exact arithmetic.
 *   - A traversal's planes are off by at most 3.5 units: BOX_ULPS.
 *
 * test_geometry's `adversary` searches for rays that break it. */
#define HIT_ULPS 6.0f

/* Margin of the boxes in a hierarchy: HIT_ULPS + 1.5, half a unit for the sum that widens the box, and the error of the
 * slab tests. Embree's, without FMA, makes t of a plane with three roundings and a reciprocal that is off by up to 5 u
 * (an estimate of 12 bits and one Newton step): 7 u A. With FMA it is (p r - o r): 3.3 u + u for each of A and o. The
 * device's, which does not rely on FMA: 3 u A, and u |o| for the error of the origin, which it adds itself. */
#define BOX_ULPS 12.0f

/* How far outside `box` a hit of the ray may lie. */
SHARED_FUNCTION float hit_margin(const Box *box, const RayQuery *query)
{
    return HIT_ULPS * FLOAT_EPSILON * (box_largest(box) + vec3_max_abs(query->o));
}

/* Narrows [*enter, *leave] to where o + t d lies between low and high; low and high are relative to the origin. */
SHARED_FUNCTION void slab_narrow(float low, float high, float d, float *enter, float *leave)
{
    if (d == 0.0f) {
        if (!(low <= 0.0f && high >= 0.0f))
            *leave = -1.0f;
        return;
    }
    float a = low / d, b = high / d;
    *enter = float_max(*enter, float_min(a, b));
    *leave = float_min(*leave, float_max(a, b));
}

/* Whether a hit at *t of the primitive in `box` may count. If the ray is within hit_margin of the box there, *t stays;
 * otherwise *t moves to the nearest t between 0 and t_max where it is. False if there is none. */
SHARED_FUNCTION bool box_admits_hit(const Box *box, const RayQuery *query, float *t)
{
    float margin = hit_margin(box, query), enter = 0.0f, leave = query->t_max;
    float low[3], high[3], o[3], d[3];
    bool inside = true;
    o[0] = query->o.x;
    o[1] = query->o.y;
    o[2] = query->o.z;
    d[0] = query->d.x;
    d[1] = query->d.y;
    d[2] = query->d.z;
    for (int i = 0; i < 3; ++i) {
        float along = *t * d[i];
        low[i] = (box->low[i] - o[i]) - margin;
        high[i] = (box->high[i] - o[i]) + margin;
        inside = inside && along >= low[i] && along <= high[i];
    }
    if (inside)
        return true;
    for (int i = 0; i < 3; ++i)
        slab_narrow(low[i], high[i], d[i], &enter, &leave);
    if (!(enter <= leave))
        return false;
    *t = float_clamp(*t, enter, leave);
    return *t > 0.0f && *t < query->t_max;
}

/* The margin, on every side, of a box in a hierarchy, for rays whose origins have no coordinate above `reach`. */
SHARED_FUNCTION float box_margin(const Box *box, float reach)
{
    return BOX_ULPS * FLOAT_EPSILON * (box_largest(box) + reach);
}

/* ---- primitives -------------------------------------------------------------------------------------------------- */

SHARED_FUNCTION Box quadric_box(__global const Quadric *quadric, uint kind)
{
    float r = quadric->radius, w = quadric->world_radius;
    Box box = box_empty();
    if (quadric->whole != 0u) {
        box_add(&box, vec3_sub(quadric->center, vec3_splat(w)));
        box_add(&box, vec3_add(quadric->center, vec3_splat(w)));
        return box;
    }
    box_add(&box, vec3(-r, -r, kind == PRIMITIVE_SPHERE ? float_max(-r, quadric->z_min) : quadric->z_min));
    float high = kind == PRIMITIVE_DISK ? quadric->z_min : quadric->z_max;
    box_add(&box, vec3(r, r, kind == PRIMITIVE_SPHERE ? float_min(r, high) : high));
    box = box_transform(&box, quadric->world_from_object);
    /* Rounding of the two transforms: of the box here, and of rays in the primitive's test. */
    return box_inflate(box, 4.0f * FLOAT_EPSILON * box_largest(&box));
}

SHARED_FUNCTION Box curve_box(__global const Curve *curve, uint piece)
{
    Vec2 interval = curve_interval(piece);
    Bezier segment = curve_bezier(curve), part = bezier_part(&segment, interval.x, interval.y);
    Box box = box_empty();
    for (uint i = 0u; i < 4u; ++i)
        box_add(&box, part.p[i]);
    float width = float_max(curve_width(curve, interval.x), curve_width(curve, interval.y));
    /* Rounding of the control points. */
    return box_inflate(box, 0.5f * width + 8.0f * FLOAT_EPSILON * box_largest(&box));
}

SHARED_FUNCTION Box triangle_box(Vec3 a, Vec3 b, Vec3 c)
{
    Box box = box_empty();
    box_add(&box, a);
    box_add(&box, b);
    box_add(&box, c);
    return box;
}

/* The box of one primitive, without margin, in the space of its object. */
SHARED_FUNCTION Box primitive_box(const SceneView *scene, uint primitive)
{
    Primitive p = scene->primitives[primitive];
    uint kind = p.shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    if (kind == PRIMITIVE_TRIANGLE)
        return triangle_box(scene->positions[p.a], scene->positions[p.b], scene->positions[p.c]);
    if (kind == PRIMITIVE_CURVE)
        return curve_box(&scene->curves[p.a], p.b);
    if (kind != PRIMITIVE_BILINEAR)
        return quadric_box(&scene->quadrics[p.a], kind);
    Box box = box_empty();
    for (int k = 0; k < 4; ++k)
        box_add(&box, scene->positions[scene->patches[p.a].v[k]]);
    return box;
}

#endif
