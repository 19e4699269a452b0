/* What lies at a hit: position, normals, tangents and texture coordinates. Orientation follows pbrt-v4:
 * - the geometric normal of a triangle a, b, c is (b-a) x (c-a), that of patches and quadrics dp/du x dp/dv, negated
 *   by SHAPE_FLIP_NORMAL (in the shape's own space: an instance only transforms it);
 * - where a mesh has vertex normals, these decide, and the geometric normal is turned to their side;
 * - the point at a hit of a curve is on its axis, and has FIBRE_NORMAL times the unit tangent in place of a geometric
 *   normal (geometry/curve.h). Its shading normal is as in pbrt-v4. */
#ifndef TWINLIGHT_GEOMETRY_SURFACE_H
#define TWINLIGHT_GEOMETRY_SURFACE_H

#include "geometry/primitive.h"

/* Unit vector along a; `otherwise` if a is zero or not finite. a may be so short or long that its squared length is no
 * normal float. */
SHARED_FUNCTION Vec3 vec3_direction(Vec3 a, Vec3 otherwise)
{
    float square = vec3_length_squared(a);
    if (square > 1e-30f && square < 1e30f)
        return vec3_scale(a, 1.0f / float_sqrt(square));
    float size = vec3_max_abs(a);
    if (!(size > 0.0f && size <= FLOAT_MAX))
        return otherwise;
    return vec3_normalize(vec3(a.x / size, a.y / size, a.z / size));
}

/* `a` or its opposite, on the side of `reference`. */
SHARED_FUNCTION Vec3 vec3_face_forward(Vec3 a, Vec3 reference)
{
    return vec3_dot(a, reference) < 0.0f ? vec3_negate(a) : a;
}

SHARED_FUNCTION void surface_tangents_from_normal(Surface *surface)
{
    Frame frame = frame_from_normal(surface->ns);
    surface->dpdu = frame.t;
    surface->dpdv = frame.b;
}

/* Turns dpdu and dpdv into tangents orthogonal to ns, with dpdu as close as possible to what it was. */
SHARED_FUNCTION void surface_tangents_around_ns(Surface *surface)
{
    Vec3 across = vec3_cross(surface->ns, surface->dpdu);
    if (!(vec3_length_squared(across) > 0.0f)) {
        surface_tangents_from_normal(surface);
        return;
    }
    surface->dpdu = vec3_cross(across, surface->ns);
    surface->dpdv = across;
}

/* Both normals, given the unnormalised geometric one and the interpolated vertex normal (used by SHAPE_HAS_NORMALS). */
SHARED_FUNCTION void surface_normals_set(Surface *surface, Vec3 normal, Vec3 vertex_normal, uint flags)
{
    Vec3 ng = vec3_direction(normal, vec3(0.0f, 0.0f, 1.0f));
    surface->ng = surface->ns = (flags & SHAPE_FLIP_NORMAL) ? vec3_negate(ng) : ng;
    if (flags & SHAPE_HAS_NORMALS) {
        surface->ns = vec3_direction(vertex_normal, surface->ng);
        surface->ng = vec3_face_forward(surface->ng, surface->ns);
    }
}

/* ---- triangles ------------------------------------------------------------------------------------------------- */

SHARED_FUNCTION Vec3 triangle_vertex_normal(const SceneView *scene, const Shape *shape, const Primitive *primitive,
                                            float u, float v)
{
    uint first = shape->first_normal - shape->first_vertex;
    Vec3 n = vec3_scale(scene->normals[primitive->a + first], 1.0f - u - v);
    n = vec3_mad(n, u, scene->normals[primitive->b + first]);
    return vec3_mad(n, v, scene->normals[primitive->c + first]);
}

/* dp/du and dp/dv, by inverting the map from edges to differences of texture coordinates; false if it has no
 * inverse. */
SHARED_FUNCTION bool triangle_tangents(const SceneView *scene, const Shape *shape, const Primitive *primitive,
                                       Surface *surface)
{
    Vec3 a = scene->positions[primitive->a];
    Vec3 e = vec3_sub(scene->positions[primitive->b], a), f = vec3_sub(scene->positions[primitive->c], a);
    Vec2 ta = triangle_uv(scene, shape, primitive, 0.0f, 0.0f);
    Vec2 tb = triangle_uv(scene, shape, primitive, 1.0f, 0.0f);
    Vec2 tc = triangle_uv(scene, shape, primitive, 0.0f, 1.0f);
    Vec2 de = vec2(tb.x - ta.x, tb.y - ta.y), df = vec2(tc.x - ta.x, tc.y - ta.y);
    float determinant = de.x * df.y - de.y * df.x;
    if (!(float_abs(determinant) >= 1e-9f))
        return false;
    float inverse = 1.0f / determinant;
    surface->dpdu = vec3_scale(vec3_sub(vec3_scale(e, df.y), vec3_scale(f, de.y)), inverse);
    surface->dpdv = vec3_scale(vec3_sub(vec3_scale(f, de.x), vec3_scale(e, df.x)), inverse);
    return vec3_length_squared(vec3_cross(surface->dpdu, surface->dpdv)) > 0.0f;
}

SHARED_FUNCTION void surface_from_triangle(const SceneView *scene, const Shape *shape, const Primitive *primitive,
                                           const Hit *hit, Surface *surface)
{
    Vec3 a = scene->positions[primitive->a], b = scene->positions[primitive->b], c = scene->positions[primitive->c];
    Vec3 vertex_normal = vec3_splat(0.0f);
    /* Along the edges: the rounding errors lie in the plane, except for those of the last additions. */
    Vec3 inside = vec3_mad(vec3_scale(vec3_sub(b, a), hit->u), hit->v, vec3_sub(c, a));
    surface->p = vec3_add(a, inside);
    surface->uv = triangle_uv(scene, shape, primitive, hit->u, hit->v);
    if (shape->flags & SHAPE_HAS_NORMALS)
        vertex_normal = triangle_vertex_normal(scene, shape, primitive, hit->u, hit->v);
    surface_normals_set(surface, triangle_normal(a, b, c), vertex_normal, shape->flags);
    surface->dpdu = surface->dpdv = vec3_splat(0.0f);
    if (!SCENE_HAS(scene, FEATURE_TANGENTS))
        return;
    if (!triangle_tangents(scene, shape, primitive, surface))
        surface_tangents_from_normal(surface);
    if (shape->flags & SHAPE_HAS_NORMALS)
        surface_tangents_around_ns(surface);
}

/* ---- bilinear patches ------------------------------------------------------------------------------------------ */

/* Replaces dp/du and dp/dv of the patch's own parameters by those of its texture coordinates, as pbrt does. */
SHARED_FUNCTION void patch_tangents(const SceneView *scene, const Shape *shape, uint patch, const Hit *hit,
                                    Surface *surface)
{
    Vec2 u0 = patch_uv(scene, shape, patch, 0.0f, hit->v), u1 = patch_uv(scene, shape, patch, 1.0f, hit->v);
    Vec2 v0 = patch_uv(scene, shape, patch, hit->u, 0.0f), v1 = patch_uv(scene, shape, patch, hit->u, 1.0f);
    float dsdu = u1.x - u0.x, dtdu = u1.y - u0.y, dsdv = v1.x - v0.x, dtdv = v1.y - v0.y;
    float duds = float_abs(dsdu) < 1e-8f ? 0.0f : 1.0f / dsdu, dudt = float_abs(dtdu) < 1e-8f ? 0.0f : 1.0f / dtdu;
    float dvds = float_abs(dsdv) < 1e-8f ? 0.0f : 1.0f / dsdv, dvdt = float_abs(dtdv) < 1e-8f ? 0.0f : 1.0f / dtdv;
    Vec3 dpds = vec3_mad(vec3_scale(surface->dpdu, duds), dvds, surface->dpdv);
    Vec3 dpdt = vec3_mad(vec3_scale(surface->dpdu, dudt), dvdt, surface->dpdv);
    Vec3 normal = vec3_cross(dpds, dpdt);
    if (vec3_is_zero(normal))
        return;
    if (vec3_dot(vec3_cross(surface->dpdu, surface->dpdv), normal) < 0.0f)
        dpdt = vec3_negate(dpdt);
    surface->dpdu = dpds;
    surface->dpdv = dpdt;
}

SHARED_FUNCTION Vec3 patch_vertex_normal(const SceneView *scene, const Shape *shape, uint patch, float u, float v)
{
    uint first = shape->first_normal - shape->first_vertex;
    PatchCorners n;
    n.p00 = scene->normals[scene->patches[patch].v[0] + first];
    n.p10 = scene->normals[scene->patches[patch].v[1] + first];
    n.p01 = scene->normals[scene->patches[patch].v[2] + first];
    n.p11 = scene->normals[scene->patches[patch].v[3] + first];
    return patch_point(&n, u, v);
}

/* The normal; where the derivatives at (u, v) are parallel or vanish, as at the tip of a patch with two equal corners,
 * the cross product of the diagonals. */
SHARED_FUNCTION Vec3 patch_normal(const PatchCorners *q, Vec3 dpdu, Vec3 dpdv)
{
    Vec3 normal = vec3_cross(dpdu, dpdv);
    return vec3_is_zero(normal) ? vec3_cross(vec3_sub(q->p11, q->p00), vec3_sub(q->p01, q->p10)) : normal;
}

SHARED_FUNCTION void surface_from_patch(const SceneView *scene, const Shape *shape, const Primitive *primitive,
                                        const Hit *hit, Surface *surface)
{
    PatchCorners q = patch_corners(scene, primitive->a);
    Vec3 vertex_normal = vec3_splat(0.0f);
    surface->p = patch_point(&q, hit->u, hit->v);
    surface->dpdu = patch_dpdu(&q, hit->v);
    surface->dpdv = patch_dpdv(&q, hit->u);
    surface->uv = patch_uv(scene, shape, primitive->a, hit->u, hit->v);
    if (shape->flags & SHAPE_HAS_NORMALS)
        vertex_normal = patch_vertex_normal(scene, shape, primitive->a, hit->u, hit->v);
    surface_normals_set(surface, patch_normal(&q, surface->dpdu, surface->dpdv), vertex_normal, shape->flags);
    if (shape->flags & SHAPE_HAS_UV)
        patch_tangents(scene, shape, primitive->a, hit, surface);
    if (shape->flags & SHAPE_HAS_NORMALS)
        surface_tangents_around_ns(surface);
}

/* ---- quadrics -------------------------------------------------------------------------------------------------- */

/* dp/du and dp/dv of the sphere at a point in object space; at a pole, of the meridian phi = 0. */
SHARED_FUNCTION void sphere_tangents(__global const Quadric *quadric, Vec3 p, Vec3 *dpdu, Vec3 *dpdv)
{
    float range = sphere_theta_of_height(quadric, quadric->z_max) - sphere_theta_of_height(quadric, quadric->z_min);
    float distance = float_sqrt(p.x * p.x + p.y * p.y);
    float x = distance > 0.0f ? p.x / distance : 1.0f, y = distance > 0.0f ? p.y / distance : 0.0f;
    float around = quadric->phi_max * (distance > 0.0f ? distance : 1e-5f * quadric->radius);
    *dpdu = vec3(-around * y, around * x, 0.0f);
    *dpdv = vec3_scale(vec3(p.z * x, p.z * y, -distance), range);
}

SHARED_FUNCTION void disk_tangents(__global const Quadric *quadric, Vec3 p, Vec3 *dpdu, Vec3 *dpdv)
{
    float distance = float_sqrt(p.x * p.x + p.y * p.y);
    float x = distance > 0.0f ? p.x / distance : 1.0f, y = distance > 0.0f ? p.y / distance : 0.0f;
    float around = quadric->phi_max * (distance > 0.0f ? distance : 1e-5f * quadric->radius);
    *dpdu = vec3(-around * y, around * x, 0.0f);
    *dpdv = vec3_scale(vec3(x, y, 0.0f), quadric->inner_radius - quadric->radius);
}

SHARED_FUNCTION void cylinder_tangents(__global const Quadric *quadric, Vec3 p, Vec3 *dpdu, Vec3 *dpdv)
{
    *dpdu = vec3(-quadric->phi_max * p.y, quadric->phi_max * p.x, 0.0f);
    *dpdv = vec3(0.0f, 0.0f, quadric->z_max - quadric->z_min);
}

/* o, d: the ray in the space that world_from_object leads to. */
SHARED_FUNCTION void surface_from_quadric(const SceneView *scene, const Shape *shape, const Primitive *primitive,
                                          Vec3 o, Vec3 d, const Hit *hit, Surface *surface)
{
    __global const Quadric *quadric = &scene->quadrics[primitive->a];
    bool sphere = (primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT) == PRIMITIVE_SPHERE;
    bool cylinder = primitive_is_cylinder(scene, primitive);
    Vec3 p = quadric_point(scene, primitive, o, d, hit->t, &surface->p);
    /* the direction of dp/du x dp/dv, which itself loses it near a sphere's poles */
    Vec3 normal = sphere ? p : cylinder ? vec3(p.x, p.y, 0.0f) : vec3(0.0f, 0.0f, 1.0f);
    surface_normals_set(surface, affine_normal(quadric->object_from_world, normal), vec3_splat(0.0f), shape->flags);
    surface->uv = SCENE_HAS(scene, FEATURE_TEXTURE | FEATURE_HAIR) ? quadric_uv(scene, primitive, p) : vec2(0.0f, 0.0f);
    surface->dpdu = surface->dpdv = vec3_splat(0.0f);
    if (!SCENE_HAS(scene, FEATURE_TANGENTS))
        return;
    Vec3 dpdu, dpdv;
    if (sphere)
        sphere_tangents(quadric, p, &dpdu, &dpdv);
    else if (cylinder)
        cylinder_tangents(quadric, p, &dpdu, &dpdv);
    else
        disk_tangents(quadric, p, &dpdu, &dpdv);
    surface->dpdu = affine_vector(quadric->world_from_object, dpdu);
    surface->dpdv = affine_vector(quadric->world_from_object, dpdv);
}

/* ---- curves ---------------------------------------------------------------------------------------------------- */

/* d: the ray's direction. The shading normal is the part of d across the tangent; on a round curve it is turned about
 * the tangent by up to a quarter of a turn, towards either side. */
SHARED_FUNCTION void surface_from_curve(const SceneView *scene, const Shape *shape, const Primitive *primitive, Vec3 d,
                                        const Hit *hit, Surface *surface)
{
    __global const Curve *curve = &scene->curves[primitive->a];
    Bezier bezier = curve_bezier(curve);
    surface->p = bezier_blossom(&bezier, hit->u, hit->u, hit->u);
    surface->uv = vec2(hit->u, hit->v);
    surface->dpdu = bezier_derivative(&bezier, hit->u);
    Vec3 tangent = vec3_direction(surface->dpdu, vec3(0.0f, 0.0f, 1.0f));
    Vec3 across = vec3_direction(vec3_cross(d, tangent), frame_from_normal(tangent).t);
    Vec3 normal = vec3_cross(tangent, across);
    if (primitive->c == CURVE_ROUND) {
        float s, c;
        Vec3 aside = across;
        float_sincos(PI * (hit->v - 0.5f), &s, &c);
        across = vec3_sub(vec3_scale(aside, c), vec3_scale(normal, s));
        normal = vec3_mad(vec3_scale(normal, c), s, aside);
    }
    surface->dpdv = vec3_scale(across, curve_width(curve, hit->u));
    surface->ns = (shape->flags & SHAPE_FLIP_NORMAL) != 0u ? vec3_negate(normal) : normal;
    surface->ng = vec3_scale(tangent, FIBRE_NORMAL);
}

/* ---- all ------------------------------------------------------------------------------------------------------- */

SHARED_FUNCTION void surface_transform(const SceneView *scene, Surface *surface, __global const Instance *instance)
{
    surface->p = affine_point(instance->world_from_object, surface->p);
    surface->dpdu = affine_vector(instance->world_from_object, surface->dpdu);
    surface->dpdv = affine_vector(instance->world_from_object, surface->dpdv);
    if (normal_is_fibre(scene, surface->ng)) {
        Vec3 tangent = vec3_direction(surface->dpdu, vec3(0.0f, 0.0f, 1.0f));
        surface->ns = vec3_direction(affine_normal(instance->object_from_world, surface->ns), surface->ns);
        surface->ng = vec3_scale(tangent, FIBRE_NORMAL);
        return;
    }
    surface->ng = vec3_direction(affine_normal(instance->object_from_world, surface->ng), surface->ng);
    surface->ns = vec3_direction(affine_normal(instance->object_from_world, surface->ns), surface->ng);
    surface->ns = vec3_face_forward(surface->ns, surface->ng);
}

/* The surface at a hit of the world-space ray. Positions come from the hit's parameters (triangles, patches) or are put
 * back onto the surface (quadrics), so they are off it by rounding alone, however far the ray has travelled. */
SHARED_FUNCTION Surface surface_from_hit(const SceneView *scene, const Ray *ray, Hit hit)
{
    Primitive primitive = scene->primitives[hit.primitive];
    Shape shape = scene->shapes[primitive.shape_and_kind & PRIMITIVE_SHAPE_MASK];
    uint kind = primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    Vec3 o = ray->o, d = ray->d;
    Surface surface;
    surface.shape = primitive.shape_and_kind & PRIMITIVE_SHAPE_MASK;
    surface.u = hit.u;
    surface.v = hit.v;
    bool instanced = SCENE_HAS(scene, FEATURE_INSTANCE) && hit.instance != NONE;
    if (instanced) {
        o = affine_point(scene->instances[hit.instance].object_from_world, ray->o);
        d = affine_vector(scene->instances[hit.instance].object_from_world, ray->d);
    }
    if (kind == PRIMITIVE_TRIANGLE)
        surface_from_triangle(scene, &shape, &primitive, &hit, &surface);
    else if (kind == PRIMITIVE_BILINEAR)
        surface_from_patch(scene, &shape, &primitive, &hit, &surface);
    else if (primitive_is_curve(scene, &primitive))
        surface_from_curve(scene, &shape, &primitive, d, &hit, &surface);
    else
        surface_from_quadric(scene, &shape, &primitive, o, d, &hit, &surface);
    if (instanced)
        surface_transform(scene, &surface, &scene->instances[hit.instance]);
    return surface;
}

#endif
