/* Points on the surfaces that emit: triangles, bilinear patches, spheres, disks; in world space, of the world's own
 * geometry (an object instance does not emit, as in pbrt).
 *
 * A full sphere seen from outside is sampled in the cone that it subtends, in solid angle. Everything else is sampled
 * on its surface with a density per area, converted to solid angle at the reference point. */
#ifndef TWINLIGHT_LIGHT_AREA_H
#define TWINLIGHT_LIGHT_AREA_H

#include "elementary.h"
#include "path_types.h"
#include "scene_view.h"
#include "warp.h"

/* A point on an area light. pdf: of having drawn it; per solid angle at the reference point when by_angle is 1, else
 * per surface area. */
typedef struct AreaPoint {
    Vec3 p;
    Vec3 ng; /* unit, the side that emits */
    float pdf;
    uint by_angle;
} AreaPoint;

/* The vertex normals' side, where a mesh has them; else ReverseOrientation and the transform's handedness (pbrt's
 * rule, the same as surface.h's). `n`: unit normal by the order of the vertices. `ns`: interpolated vertex normal. */
SHARED_FUNCTION Vec3 area_orient_mesh(uint flags, Vec3 n, Vec3 ns)
{
    bool flip = (flags & SHAPE_HAS_NORMALS) != 0u ? vec3_dot(n, ns) < 0.0f : (flags & SHAPE_FLIP_NORMAL) != 0u;
    return flip ? vec3_negate(n) : n;
}

SHARED_FUNCTION Vec3 area_vertex_normal(const SceneView *scene, const Shape *shape, uint vertex)
{
    return scene->normals[vertex - shape->first_vertex + shape->first_normal];
}

/* ---- triangle ---------------------------------------------------------------------------------------------------- */

/* Uniform over the area. */
SHARED_FUNCTION AreaPoint triangle_light_sample(const SceneView *scene, Primitive triangle, float area, Vec2 u)
{
    Shape shape = scene->shapes[triangle.shape_and_kind & PRIMITIVE_SHAPE_MASK];
    Vec3 a = scene->positions[triangle.a];
    Vec3 ab = vec3_sub(scene->positions[triangle.b], a);
    Vec3 ac = vec3_sub(scene->positions[triangle.c], a);
    Vec2 b = warp_triangle(u);
    Vec3 ns = vec3_splat(0.0f);
    if ((shape.flags & SHAPE_HAS_NORMALS) != 0u) {
        ns = vec3_scale(area_vertex_normal(scene, &shape, triangle.a), 1.0f - b.x - b.y);
        ns = vec3_mad(ns, b.x, area_vertex_normal(scene, &shape, triangle.b));
        ns = vec3_mad(ns, b.y, area_vertex_normal(scene, &shape, triangle.c));
    }
    AreaPoint point;
    point.p = vec3_mad(vec3_mad(a, b.x, ab), b.y, ac);
    point.ng = area_orient_mesh(shape.flags, vec3_normalize(vec3_cross(ab, ac)), ns);
    point.pdf = 1.0f / area;
    point.by_angle = 0u;
    return point;
}

/* ---- bilinear patch ---------------------------------------------------------------------------------------------- */

/* dp/du x dp/dv at (u, v); its length is the area per unit of (u, v). */
SHARED_FUNCTION Vec3 patch_light_normal(Vec3 p00, Vec3 p10, Vec3 p01, Vec3 p11, float u, float v)
{
    Vec3 dpdu = vec3_lerp(vec3_sub(p10, p00), vec3_sub(p11, p01), v);
    Vec3 dpdv = vec3_lerp(vec3_sub(p01, p00), vec3_sub(p11, p10), u);
    return vec3_cross(dpdu, dpdv);
}

/* Uniform in (u, v). */
SHARED_FUNCTION AreaPoint patch_light_sample(const SceneView *scene, Primitive primitive, Vec2 u)
{
    Shape shape = scene->shapes[primitive.shape_and_kind & PRIMITIVE_SHAPE_MASK];
    Patch patch = scene->patches[primitive.a];
    Vec3 p00 = scene->positions[patch.v[0]], p10 = scene->positions[patch.v[1]];
    Vec3 p01 = scene->positions[patch.v[2]], p11 = scene->positions[patch.v[3]];
    Vec3 n = patch_light_normal(p00, p10, p01, p11, u.x, u.y);
    Vec3 ns = vec3_splat(0.0f);
    if ((shape.flags & SHAPE_HAS_NORMALS) != 0u)
        ns = vec3_lerp(vec3_lerp(area_vertex_normal(scene, &shape, patch.v[0]),
                                 area_vertex_normal(scene, &shape, patch.v[1]), u.x),
                       vec3_lerp(area_vertex_normal(scene, &shape, patch.v[2]),
                                 area_vertex_normal(scene, &shape, patch.v[3]), u.x),
                       u.y);
    float jacobian = vec3_length(n);
    AreaPoint point;
    point.p = vec3_lerp(vec3_lerp(p00, p10, u.x), vec3_lerp(p01, p11, u.x), u.y);
    point.ng = area_orient_mesh(shape.flags, vec3_scale(n, 1.0f / jacobian), ns);
    point.pdf = 1.0f / jacobian;
    point.by_angle = 0u;
    return point;
}

SHARED_FUNCTION float patch_light_pdf(const SceneView *scene, Primitive primitive, float u, float v)
{
    Patch patch = scene->patches[primitive.a];
    Vec3 n = patch_light_normal(scene->positions[patch.v[0]], scene->positions[patch.v[1]],
                                scene->positions[patch.v[2]], scene->positions[patch.v[3]], u, v);
    return 1.0f / vec3_length(n);
}

/* ---- sphere and disk ---------------------------------------------------------------------------------------------- */

/* Density per world area of a point drawn uniformly on a quadric of `object_area` in its object space, where the unit
 * normal in world space is `ng`: an affine map M with n' = M^-T n / |M^-T n| scales areas by |det M| |M^-T n| =
 * |det M| / |M^T n'|. */
SHARED_FUNCTION float quadric_light_pdf(__global const Quadric *quadric, float object_area, Vec3 ng)
{
    Affine m = quadric->world_from_object;
    Vec3 x = vec3(m.m[0], m.m[4], m.m[8]), y = vec3(m.m[1], m.m[5], m.m[9]), z = vec3(m.m[2], m.m[6], m.m[10]);
    float determinant = float_abs(vec3_dot(x, vec3_cross(y, z)));
    return vec3_length(vec3(vec3_dot(x, ng), vec3_dot(y, ng), vec3_dot(z, ng))) / (determinant * object_area);
}

SHARED_FUNCTION float sphere_object_area(__global const Quadric *quadric)
{
    return quadric->phi_max * quadric->radius * (quadric->z_max - quadric->z_min);
}

SHARED_FUNCTION float disk_object_area(__global const Quadric *quadric)
{
    return 0.5f * quadric->phi_max * (quadric->radius - quadric->inner_radius) *
           (quadric->radius + quadric->inner_radius);
}

/* The point and normal of a quadric that are p and n in its object space. */
SHARED_FUNCTION AreaPoint quadric_light_point(const SceneView *scene, Primitive primitive, Vec3 p, Vec3 n,
                                              float object_area)
{
    __global const Quadric *quadric = scene->quadrics + primitive.a;
    Affine world_from_object = quadric->world_from_object, object_from_world = quadric->object_from_world;
    uint flags = scene->shapes[primitive.shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
    AreaPoint point;
    point.p = affine_point(world_from_object, p);
    point.ng = vec3_normalize(affine_normal(object_from_world, n));
    if ((flags & SHAPE_FLIP_NORMAL) != 0u)
        point.ng = vec3_negate(point.ng);
    point.pdf = quadric_light_pdf(quadric, object_area, point.ng);
    point.by_angle = 0u;
    return point;
}

/* Uniform in object space over the part of the disk between the radii and angles. */
SHARED_FUNCTION AreaPoint disk_light_sample(const SceneView *scene, Primitive primitive, Vec2 u)
{
    __global const Quadric *quadric = scene->quadrics + primitive.a;
    float inner = quadric->inner_radius, outer = quadric->radius;
    float r = float_sqrt((1.0f - u.x) * inner * inner + u.x * outer * outer);
    float sin_phi, cos_phi;
    float_sincos(u.y * quadric->phi_max, &sin_phi, &cos_phi);
    return quadric_light_point(scene, primitive, vec3(r * cos_phi, r * sin_phi, quadric->z_min), vec3(0.0f, 0.0f, 1.0f),
                               disk_object_area(quadric));
}

/* Uniform in object space over the part of the sphere between the heights and angles (Archimedes: equal heights have
 * equal areas). */
SHARED_FUNCTION AreaPoint sphere_light_sample_area(const SceneView *scene, Primitive primitive, Vec2 u)
{
    __global const Quadric *quadric = scene->quadrics + primitive.a;
    float z = (1.0f - u.x) * quadric->z_min + u.x * quadric->z_max;
    float r = float_sqrt(float_max((quadric->radius - z) * (quadric->radius + z), 0.0f));
    float sin_phi, cos_phi;
    float_sincos(u.y * quadric->phi_max, &sin_phi, &cos_phi);
    Vec3 p = vec3(r * cos_phi, r * sin_phi, z);
    return quadric_light_point(scene, primitive, p, vec3_scale(p, 1.0f / quadric->radius), sphere_object_area(quadric));
}

/* The cone that a whole sphere subtends at a point outside: square of the sine of its half-angle, 0 when `ref` is not
 * outside or the sphere is not whole. */
SHARED_FUNCTION float sphere_light_sin2(__global const Quadric *quadric, Vec3 ref)
{
    float distance2 = vec3_length_squared(vec3_sub(quadric->center, ref));
    float radius2 = quadric->world_radius * quadric->world_radius;
    return quadric->whole != 0u && distance2 > radius2 ? radius2 / distance2 : 0.0f;
}

/* 1 - cos of the half-angle, without the cancellation that makes it 0 below 2e-4 radians. */
SHARED_FUNCTION float sphere_light_versine(float sin2)
{
    return sin2 / (1.0f + float_sqrt(1.0f - sin2));
}

/* Uniform over the directions to a whole sphere, from outside; u goes through the disk, as in warp_cone. The point is
 * found from angles at the sphere's centre rather than along the ray, so that it lies on the sphere however small that
 * is: with theta the angle at `ref` between axis and ray, the sine of the angle between ray and normal is s =
 * sin(theta) / sin(theta_max), and the angle at the centre is asin(s) - theta. Sines are kept divided by the radius r
 * in the disk, which is zero on the axis. */
SHARED_FUNCTION AreaPoint sphere_light_sample_cone(const SceneView *scene, Primitive primitive, float sin2, Vec3 ref,
                                                   Vec2 u)
{
    __global const Quadric *quadric = scene->quadrics + primitive.a;
    float r;
    Vec2 d = warp_disk_polar(u, &r);
    float cos_max = float_sqrt(1.0f - sin2);
    float versine_max = sphere_light_versine(sin2);
    float versine = r * r * versine_max;
    float cos_theta = 1.0f - versine;
    float sin_theta = float_sqrt(versine_max * (2.0f - versine));
    float s = float_sqrt((2.0f - versine) / (1.0f + cos_max));
    float c = float_sqrt(float_max(1.0f - r * r * s * s, 0.0f));
    float sin_alpha = s * cos_theta - c * sin_theta;
    float cos_alpha = c * cos_theta + r * r * s * sin_theta;
    Vec3 axis = vec3_normalize(vec3_sub(quadric->center, ref));
    Vec3 n = frame_to_world(frame_from_normal(axis), vec3(sin_alpha * d.x, sin_alpha * d.y, -cos_alpha));
    uint flags = scene->shapes[primitive.shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
    AreaPoint point;
    point.p = vec3_mad(quadric->center, quadric->world_radius, n);
    point.ng = (flags & SHAPE_FLIP_NORMAL) != 0u ? vec3_negate(n) : n;
    point.pdf = warp_cone_pdf(versine_max);
    point.by_angle = 1u;
    return point;
}

SHARED_FUNCTION AreaPoint sphere_light_sample(const SceneView *scene, Primitive primitive, Vec3 ref, Vec2 u)
{
    float sin2 = sphere_light_sin2(scene->quadrics + primitive.a, ref);
    if (sin2 > 0.0f)
        return sphere_light_sample_cone(scene, primitive, sin2, ref, u);
    return sphere_light_sample_area(scene, primitive, u);
}

/* ---- area lights --------------------------------------------------------------------------------------------------- */

/* Radiance that leaves the area light `light` towards `w` (unit, away from the surface) at a point with the geometric
 * normal `ng`: on the side of ng, or on both. */
SHARED_FUNCTION Vec3 light_emitted(const SceneView *scene, uint light, Vec3 ng, Vec3 w)
{
    __global const Light *emitter = scene->lights + light;
    if ((emitter->flags & LIGHT_TWO_SIDED) == 0u && !(vec3_dot(ng, w) > 0.0f))
        return vec3_splat(0.0f);
    return emitter->emission;
}

/* Density per solid angle at `ref` from one per area; 0 where the direction lies in the surface. */
SHARED_FUNCTION float area_pdf_to_w(float pdf_a, float distance2, float cosine)
{
    float projected = float_abs(cosine);
    return projected > 0.0f ? pdf_a * (distance2 / projected) : 0.0f;
}

SHARED_FUNCTION AreaPoint area_light_point(const SceneView *scene, uint light, Vec3 ref, Vec2 u)
{
    Primitive primitive = scene->primitives[scene->lights[light].primitive];
    uint kind = primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    if (SCENE_HAS(scene, FEATURE_BILINEAR) && kind == PRIMITIVE_BILINEAR)
        return patch_light_sample(scene, primitive, u);
    if (SCENE_HAS(scene, FEATURE_SPHERE) && kind == PRIMITIVE_SPHERE)
        return sphere_light_sample(scene, primitive, ref, u);
    if (SCENE_HAS(scene, FEATURE_DISK) && kind == PRIMITIVE_DISK)
        return disk_light_sample(scene, primitive, u);
    return triangle_light_sample(scene, primitive, scene->lights[light].area, u);
}

SHARED_FUNCTION bool area_light_sample(const SceneView *scene, uint light, Vec3 ref, Vec2 u, LightSample *sample)
{
    AreaPoint point = area_light_point(scene, light, ref, u);
    Vec3 d = vec3_sub(point.p, ref);
    float distance2 = vec3_length_squared(d);
    if (!(distance2 > 0.0f))
        return false;
    sample->wi = vec3_scale(d, 1.0f / float_sqrt(distance2));
    sample->p = point.p;
    sample->ng = point.ng;
    sample->radiance = light_emitted(scene, light, point.ng, vec3_negate(sample->wi));
    sample->pdf_w =
        point.by_angle != 0u ? point.pdf : area_pdf_to_w(point.pdf, distance2, vec3_dot(point.ng, sample->wi));
    sample->delta = 0u;
    sample->infinite = 0u;
    return sample->pdf_w > 0.0f && float_finite(sample->pdf_w) && !vec3_is_zero(sample->radiance);
}

/* Cone sampling only finds the near side of a sphere. The far side shows through the holes of an alpha texture. */
SHARED_FUNCTION bool sphere_light_hidden(Primitive primitive, uint flags, Vec3 ng, Vec3 wi)
{
    if ((primitive.shape_and_kind & PRIMITIVE_ALPHA_BIT) == 0u)
        return false;
    float cosine = vec3_dot(ng, wi);
    return ((flags & SHAPE_FLIP_NORMAL) != 0u ? -cosine : cosine) > 0.0f;
}

SHARED_FUNCTION float area_light_pdf_w(const SceneView *scene, uint light, Vec3 ref, Vec3 wi, const Surface *hit)
{
    Primitive primitive = scene->primitives[scene->lights[light].primitive];
    uint kind = primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    float pdf_a = 0.0f;
    if (SCENE_HAS(scene, FEATURE_BILINEAR) && kind == PRIMITIVE_BILINEAR) {
        pdf_a = patch_light_pdf(scene, primitive, hit->u, hit->v);
    } else if (SCENE_HAS(scene, FEATURE_SPHERE) && kind == PRIMITIVE_SPHERE) {
        __global const Quadric *quadric = scene->quadrics + primitive.a;
        float sin2 = sphere_light_sin2(quadric, ref);
        uint flags = scene->shapes[primitive.shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
        if (sin2 > 0.0f)
            return sphere_light_hidden(primitive, flags, hit->ng, wi)
                       ? 0.0f
                       : warp_cone_pdf(sphere_light_versine(sin2));
        pdf_a = quadric_light_pdf(quadric, sphere_object_area(quadric), hit->ng);
    } else if (SCENE_HAS(scene, FEATURE_DISK) && kind == PRIMITIVE_DISK) {
        pdf_a = quadric_light_pdf(scene->quadrics + primitive.a, disk_object_area(scene->quadrics + primitive.a),
                                  hit->ng);
    } else {
        pdf_a = 1.0f / scene->lights[light].area;
    }
    return area_pdf_to_w(pdf_a, vec3_length_squared(vec3_sub(hit->p, ref)), vec3_dot(hit->ng, wi));
}

#endif
