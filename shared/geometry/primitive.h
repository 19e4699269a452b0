/* The one test that decides whether a ray hits a primitive, for all callers: Embree's callbacks, the device's traversal
 * and the brute force of the tests. */
#ifndef TWINLIGHT_GEOMETRY_PRIMITIVE_H
#define TWINLIGHT_GEOMETRY_PRIMITIVE_H

#include "geometry/bilinear.h"
#include "geometry/box.h"
#include "geometry/curve.h"
#include "geometry/cylinder.h"
#include "geometry/disk.h"
#include "geometry/sphere.h"
#include "geometry/texture.h"
#include "geometry/triangle.h"
#include "layout/scene_view.h"

SHARED_FUNCTION PatchCorners patch_corners(const SceneView *scene, uint patch)
{
    PatchCorners corners;
    corners.p00 = scene->positions[scene->patches[patch].v[0]];
    corners.p10 = scene->positions[scene->patches[patch].v[1]];
    corners.p01 = scene->positions[scene->patches[patch].v[2]];
    corners.p11 = scene->positions[scene->patches[patch].v[3]];
    return corners;
}

/* Texture coordinates at barycentric weights u, v of a triangle's corners b, c; pbrt's default without them. */
SHARED_FUNCTION Vec2 triangle_uv(const SceneView *scene, const Shape *shape, const Primitive *primitive, float u,
                                 float v)
{
    if (!(shape->flags & SHAPE_HAS_UV))
        return vec2(u + v, v);
    uint first = shape->first_uv - shape->first_vertex;
    Vec2 a = scene->uvs[primitive->a + first], b = scene->uvs[primitive->b + first],
         c = scene->uvs[primitive->c + first];
    float w = 1.0f - u - v;
    return vec2(w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y);
}

/* Texture coordinates at (u, v) of a patch. */
SHARED_FUNCTION Vec2 patch_uv(const SceneView *scene, const Shape *shape, uint patch, float u, float v)
{
    if (!(shape->flags & SHAPE_HAS_UV))
        return vec2(u, v);
    uint first = shape->first_uv - shape->first_vertex;
    Vec2 corner[4];
    for (uint i = 0; i < 4u; ++i)
        corner[i] = scene->uvs[scene->patches[patch].v[i] + first];
    float w00 = (1.0f - u) * (1.0f - v), w10 = u * (1.0f - v), w01 = (1.0f - u) * v, w11 = u * v;
    return vec2(w00 * corner[0].x + w10 * corner[1].x + w01 * corner[2].x + w11 * corner[3].x,
                w00 * corner[0].y + w10 * corner[1].y + w01 * corner[2].y + w11 * corner[3].y);
}

/* False without a look at the primitive in scenes without cylinders. */
SHARED_FUNCTION bool primitive_is_cylinder(const SceneView *scene, const Primitive *primitive)
{
    return SCENE_HAS(scene, FEATURE_CYLINDER) &&
           primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_CYLINDER;
}

SHARED_FUNCTION bool primitive_is_curve(const SceneView *scene, const Primitive *primitive)
{
    return SCENE_HAS(scene, FEATURE_CURVE) && primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_CURVE;
}

/* The point of the quadric at o + t d, put back onto it, in object space; *world: in the space around. */
SHARED_FUNCTION Vec3 quadric_point(const SceneView *scene, const Primitive *primitive, Vec3 o, Vec3 d, float t,
                                   Vec3 *world)
{
    __global const Quadric *quadric = &scene->quadrics[primitive->a];
    if (primitive_is_cylinder(scene, primitive))
        return cylinder_point(quadric, o, d, t, world);
    return primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_SPHERE ? sphere_point(quadric, o, d, t, world)
                                                                                 : disk_point(quadric, o, d, t, world);
}

/* Texture coordinates of a point of a quadric in object space. Hits do not store them: on a sphere they take
 * four arc functions, and only textures need them. */
SHARED_FUNCTION Vec2 quadric_uv(const SceneView *scene, const Primitive *primitive, Vec3 p)
{
    __global const Quadric *quadric = &scene->quadrics[primitive->a];
    if (primitive_is_cylinder(scene, primitive))
        return cylinder_parameters(quadric, p);
    return primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_SPHERE ? sphere_parameters(quadric, p)
                                                                                 : disk_parameters(quadric, p);
}

/* Hashes of the far side of a sphere or cylinder use the primitive's number with this bit set. */
#define PRIMITIVE_FAR_SIDE 0x80000000u

/* A number in [0, 1) that depends on the bits of the ray and on the primitive. */
SHARED_FUNCTION float ray_hash(const RayQuery *query, uint primitive)
{
    uint words[6];
    words[0] = float_bits(query->o.x);
    words[1] = float_bits(query->o.y);
    words[2] = float_bits(query->o.z);
    words[3] = float_bits(query->d.x);
    words[4] = float_bits(query->d.y);
    words[5] = float_bits(query->d.z);
    uint h = primitive * 0x9e3779b9u + 0x7f4a7c15u;
    for (uint i = 0; i < 6u; ++i) {
        /* Steps of MurmurHash3 (Appleby 2011, public domain), 32-bit finaliser. */
        h ^= words[i];
        h ^= h >> 16;
        h *= 0x85ebca6bu;
        h ^= h >> 13;
        h *= 0xc2b2ae35u;
        h ^= h >> 16;
    }
    return (float)(h >> 8) * (1.0f / 16777216.0f);
}

/* Whether the alpha texture of the primitive's shape lets the hit count. Partial transparency is decided by a hash of
 * the ray, so that the answer depends on the ray and not on the order of traversal. */
SHARED_FUNCTION bool primitive_alpha_keeps(const SceneView *scene, const RayQuery *query, uint id,
                                           const Primitive *primitive, const Hit *hit)
{
    Shape shape = scene->shapes[primitive->shape_and_kind & PRIMITIVE_SHAPE_MASK];
    uint kind = primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    TexturePoint point;
    point.p = vec3_mad(query->o, hit->t, query->d);
    point.n = vec3_splat(0.0f);
    if (kind == PRIMITIVE_TRIANGLE)
        point.uv = triangle_uv(scene, &shape, primitive, hit->u, hit->v);
    else if (kind == PRIMITIVE_BILINEAR)
        point.uv = patch_uv(scene, &shape, primitive->a, hit->u, hit->v);
    else if (primitive_is_curve(scene, primitive))
        point.uv = vec2(hit->u, hit->v);
    else {
        Vec3 world;
        Vec3 p = quadric_point(scene, primitive, query->o, query->d, hit->t, &world);
        point.uv = quadric_uv(scene, primitive, p);
    }
    float alpha = texture_eval_float(scene, shape.alpha, &point);
    if (alpha >= 1.0f)
        return true;
    return alpha > 0.0f && ray_hash(query, id) <= alpha;
}

/* Whether the primitive's alpha texture, if any, lets the hit count. asked: primitive number for the ray's hash. */
SHARED_FUNCTION bool primitive_keeps(const SceneView *scene, const RayQuery *query, uint id, uint asked, const Hit *hit)
{
    if (!SCENE_HAS(scene, FEATURE_ALPHA))
        return true;
    Primitive primitive = scene->primitives[id];
    return !(primitive.shape_and_kind & PRIMITIVE_ALPHA_BIT) ||
           primitive_alpha_keeps(scene, query, asked, &primitive, hit);
}

/* Whether a ray can hit the primitive twice and the second hit is looked for: spheres and cylinders. */
SHARED_FUNCTION bool primitive_has_far_side(const SceneView *scene, const Primitive *primitive)
{
    return primitive_is_cylinder(scene, primitive) ||
           (SCENE_HAS(scene, FEATURE_SPHERE) && primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_SPHERE);
}

/* The first intersection with a primitive other than a triangle, alpha textures ignored; for a sphere or cylinder, the
 * first beyond `after`. */
SHARED_FUNCTION bool primitive_curved_from(const SceneView *scene, const Primitive *primitive, const RayQuery *query,
                                           float after, Hit *hit)
{
    uint kind = primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    if (SCENE_HAS(scene, FEATURE_BILINEAR) && kind == PRIMITIVE_BILINEAR) {
        PatchCorners corners = patch_corners(scene, primitive->a);
        return patch_query(&corners, query, &hit->t, &hit->u, &hit->v);
    }
    if (primitive_is_curve(scene, primitive))
        return curve_query(&scene->curves[primitive->a], primitive->b, query, hit);
    if (!SCENE_HAS(scene, FEATURES_QUADRIC))
        return false;
    __global const Quadric *quadric = &scene->quadrics[primitive->a];
    if (primitive_is_cylinder(scene, primitive))
        return cylinder_query(quadric, query, after, &hit->t);
    return kind == PRIMITIVE_SPHERE ? sphere_query(quadric, query, after, &hit->t)
                                    : disk_query(quadric, query, &hit->t);
}

/* Whether a hit at hit->t counts: it must lie in the primitive's box (hit->t may be moved into it) and be kept by the
 * alpha texture. asked: primitive number for the ray's hash. */
SHARED_FUNCTION bool primitive_curved_counts(const SceneView *scene, uint id, uint asked, const RayQuery *query,
                                             Hit *hit)
{
    Box box = primitive_box(scene, id);
    return box_admits_hit(&box, query, &hit->t) && primitive_keeps(scene, query, id, asked, hit);
}

/* primitive_query for all but triangles. A hole in the near side of a sphere or cylinder shows its far side; otherwise
 * rays from inside would escape where rays from outside hit nothing. Each side has a hash of its own. */
SHARED_FUNCTION bool primitive_query_curved(const SceneView *scene, uint id, const RayQuery *query, Hit *hit)
{
    Primitive primitive = scene->primitives[id];
    if (!primitive_curved_from(scene, &primitive, query, 0.0f, hit))
        return false;
    float first = hit->t;
    if (primitive_curved_counts(scene, id, id, query, hit))
        return true;
    return SCENE_HAS(scene, FEATURE_ALPHA) && primitive_has_far_side(scene, &primitive) &&
           primitive_curved_from(scene, &primitive, query, first, hit) &&
           primitive_curved_counts(scene, id, id ^ PRIMITIVE_FAR_SIDE, query, hit);
}

/* Whether a hit of a triangle with the corners a, b, c, found by triangle_query, counts: its box and its alpha texture
 * decide. */
SHARED_FUNCTION bool primitive_triangle_counts(const SceneView *scene, uint id, Vec3 a, Vec3 b, Vec3 c,
                                               const RayQuery *query, Hit *hit)
{
    Box box = triangle_box(a, b, c);
    return box_admits_hit(&box, query, &hit->t) && primitive_keeps(scene, query, id, id, hit);
}

/* The first intersection of the ray with the primitive, with 0 < t < t_max. Sets hit->t and, except for quadrics, u and
 * v. Depends on nothing but ray and primitive. */
SHARED_FUNCTION bool primitive_query(const SceneView *scene, uint id, const RayQuery *query, Hit *hit)
{
    Primitive primitive = scene->primitives[id];
    if (primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT != PRIMITIVE_TRIANGLE)
        return primitive_query_curved(scene, id, query, hit);
    Vec3 a = scene->positions[primitive.a], b = scene->positions[primitive.b], c = scene->positions[primitive.c];
    return triangle_query(a, b, c, query, hit) && primitive_triangle_counts(scene, id, a, b, c, query, hit);
}

/* Whether a comes before b in the order that makes the closest hit unique: t, instance, primitive. */
SHARED_FUNCTION bool hit_before(const Hit *a, const Hit *b)
{
    if (a->t != b->t)
        return a->t < b->t;
    return a->instance != b->instance ? a->instance < b->instance : a->primitive < b->primitive;
}

/* The hit of a ray that has hit nothing yet. */
SHARED_FUNCTION Hit hit_none(float t_max)
{
    Hit hit;
    hit.t = t_max;
    hit.primitive = NONE;
    hit.instance = NONE;
    hit.u = 0.0f;
    hit.v = 0.0f;
    return hit;
}

/* Replaces *best by `hit` on the primitive if that comes before it; returns whether it did. */
SHARED_FUNCTION bool hit_improve(Hit *best, Hit hit, uint instance, uint primitive)
{
    hit.primitive = primitive;
    hit.instance = instance;
    if (!hit_before(&hit, best))
        return false;
    *best = hit;
    return true;
}

/* Replaces *best if the ray hits the primitive before it. instance: whose space the query is in; NONE: the world's. */
SHARED_FUNCTION bool primitive_intersect(const SceneView *scene, uint primitive, uint instance, const RayQuery *query,
                                         Hit *best)
{
    Hit hit = hit_none(query->t_max);
    return primitive_query(scene, primitive, query, &hit) && hit_improve(best, hit, instance, primitive);
}

/* Whether the primitive is hit between the ends of the ray. */
SHARED_FUNCTION bool primitive_occludes(const SceneView *scene, uint primitive, const RayQuery *query)
{
    Hit hit = hit_none(query->t_max);
    return primitive_query(scene, primitive, query, &hit);
}

#endif
