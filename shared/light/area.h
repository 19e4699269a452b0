/* Points on emitting surfaces: triangles, bilinear patches and quadrics, in world space. Only the world's own
 * geometry emits; object instances do not, as in pbrt.
 *
 * A full sphere seen from outside is sampled in the cone that it subtends, uniformly in solid angle. Everything else is
 * sampled on its surface with a density per area, which is converted to solid angle at the reference point. */
#ifndef TWINLIGHT_LIGHT_AREA_H
#define TWINLIGHT_LIGHT_AREA_H

#include "geometry/surface.h"
#include "math/warp.h"

/* A point on an area light. pdf: its density, per solid angle at the reference point if by_angle is 1, else per surface
 * area. */
typedef struct AreaPoint {
    Vec3 p;
    Vec3 ng; /* unit, on the side that emits */
    Vec2 uv; /* texture coordinates, for alpha */
    float pdf;
    uint by_angle;
} AreaPoint;

/* The geometric normal as surface_from_hit finds it; `normal` need not be a unit vector. */
SHARED_FUNCTION Vec3 area_light_normal(Vec3 normal, Vec3 vertex_normal, uint flags)
{
    Vec3 ng = vec3_direction(normal, vec3(0.0f, 0.0f, 1.0f));
    ng = (flags & SHAPE_FLIP_NORMAL) != 0u ? vec3_negate(ng) : ng;
    return vec3_face_forward(ng, vertex_normal);
}

/* ---- triangle ---------------------------------------------------------------------------------------------------- */

/* Uniform over the area. */
SHARED_FUNCTION AreaPoint triangle_light_sample(const SceneView *scene, const Primitive *triangle, float area, Vec2 u)
{
    Shape shape = scene->shapes[triangle->shape_and_kind & PRIMITIVE_SHAPE_MASK];
    Vec3 a = scene->positions[triangle->a], b = scene->positions[triangle->b], c = scene->positions[triangle->c];
    Vec2 weights = warp_triangle(u);
    Vec3 vertex_normal = vec3_splat(0.0f);
    if ((shape.flags & SHAPE_HAS_NORMALS) != 0u)
        vertex_normal = triangle_vertex_normal(scene, &shape, triangle, weights.x, weights.y);
    AreaPoint point;
    point.p = vec3_add(a, vec3_mad(vec3_scale(vec3_sub(b, a), weights.x), weights.y, vec3_sub(c, a)));
    point.ng = area_light_normal(triangle_normal(a, b, c), vertex_normal, shape.flags);
    point.uv = SCENE_HAS(scene, FEATURE_ALPHA) ? triangle_uv(scene, &shape, triangle, weights.x, weights.y) : weights;
    point.pdf = 1.0f / area;
    point.by_angle = 0u;
    return point;
}

/* ---- bilinear patch ---------------------------------------------------------------------------------------------- */

/* Density per area of a point drawn uniformly in (u, v): one over the area per unit of (u, v). */
SHARED_FUNCTION float patch_light_pdf(const PatchCorners *corners, float u, float v)
{
    return 1.0f / vec3_length(vec3_cross(patch_dpdu(corners, v), patch_dpdv(corners, u)));
}

/* Uniform in (u, v). */
SHARED_FUNCTION AreaPoint patch_light_sample(const SceneView *scene, const Primitive *primitive, Vec2 u)
{
    Shape shape = scene->shapes[primitive->shape_and_kind & PRIMITIVE_SHAPE_MASK];
    PatchCorners corners = patch_corners(scene, primitive->a);
    Vec3 vertex_normal = vec3_splat(0.0f);
    if ((shape.flags & SHAPE_HAS_NORMALS) != 0u)
        vertex_normal = patch_vertex_normal(scene, &shape, primitive->a, u.x, u.y);
    AreaPoint point;
    point.p = patch_point(&corners, u.x, u.y);
    point.ng = area_light_normal(patch_normal(&corners, patch_dpdu(&corners, u.y), patch_dpdv(&corners, u.x)),
                                 vertex_normal, shape.flags);
    point.uv = SCENE_HAS(scene, FEATURE_ALPHA) ? patch_uv(scene, &shape, primitive->a, u.x, u.y) : u;
    point.pdf = patch_light_pdf(&corners, u.x, u.y);
    point.by_angle = 0u;
    return point;
}

/* ---- quadrics ---------------------------------------------------------------------------------------------------- */

/* Density per world area, at the unit world-space normal `ng`, of a point drawn uniformly in object space from a
 * quadric with area `object_area` there: an affine map M with n' = M^-T n / |M^-T n| scales areas by |det M| |M^-T n| =
 * |det M| / |M^T n'|. */
SHARED_FUNCTION float quadric_light_pdf(__global const Quadric *quadric, float object_area, Vec3 ng)
{
    Affine m = quadric->world_from_object;
    Vec3 x = vec3(m.m[0], m.m[4], m.m[8]), y = vec3(m.m[1], m.m[5], m.m[9]), z = vec3(m.m[2], m.m[6], m.m[10]);
    float determinant = float_abs(vec3_dot(x, vec3_cross(y, z)));
    return vec3_length(vec3(vec3_dot(x, ng), vec3_dot(y, ng), vec3_dot(z, ng))) / (determinant * object_area);
}

/* The heights at which a sphere is clipped. */
SHARED_FUNCTION float sphere_low(__global const Quadric *quadric)
{
    return float_max(quadric->z_min, -quadric->radius);
}

SHARED_FUNCTION float sphere_high(__global const Quadric *quadric)
{
    return float_min(quadric->z_max, quadric->radius);
}

/* Area in object space. */
SHARED_FUNCTION float sphere_object_area(__global const Quadric *quadric)
{
    return quadric->phi_max * quadric->radius * (sphere_high(quadric) - sphere_low(quadric));
}

SHARED_FUNCTION float disk_object_area(__global const Quadric *quadric)
{
    return 0.5f * quadric->phi_max * (quadric->radius - quadric->inner_radius) *
           (quadric->radius + quadric->inner_radius);
}

SHARED_FUNCTION float cylinder_object_area(__global const Quadric *quadric)
{
    return quadric->phi_max * quadric->radius * (quadric->z_max - quadric->z_min);
}

/* The point of a quadric whose position and normal in object space are p and n. The caller sets uv. */
SHARED_FUNCTION AreaPoint quadric_light_point(const SceneView *scene, const Primitive *primitive, Vec3 p, Vec3 n,
                                              float object_area)
{
    __global const Quadric *quadric = scene->quadrics + primitive->a;
    uint flags = scene->shapes[primitive->shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
    AreaPoint point;
    point.p = affine_point(quadric->world_from_object, p);
    point.ng = area_light_normal(affine_normal(quadric->object_from_world, n), vec3_splat(0.0f), flags);
    point.uv = vec2(0.0f, 0.0f);
    point.pdf = quadric_light_pdf(quadric, object_area, point.ng);
    point.by_angle = 0u;
    return point;
}

/* Uniform in object space over the part of the disk between the radii and angles. */
SHARED_FUNCTION AreaPoint disk_light_sample(const SceneView *scene, const Primitive *primitive, Vec2 u)
{
    __global const Quadric *quadric = scene->quadrics + primitive->a;
    float inner = quadric->inner_radius, outer = quadric->radius;
    float r = float_sqrt((1.0f - u.x) * inner * inner + u.x * outer * outer);
    float sin_phi, cos_phi;
    float_sincos(u.y * quadric->phi_max, &sin_phi, &cos_phi);
    Vec3 p = vec3(r * cos_phi, r * sin_phi, quadric->z_min);
    AreaPoint point = quadric_light_point(scene, primitive, p, vec3(0.0f, 0.0f, 1.0f), disk_object_area(quadric));
    if (SCENE_HAS(scene, FEATURE_ALPHA))
        point.uv = disk_parameters(quadric, p);
    return point;
}

/* Uniform in object space over the part of the cylinder between the heights and angles. */
SHARED_FUNCTION_APART AreaPoint cylinder_light_sample(const SceneView *scene, const Primitive *primitive, Vec2 u)
{
    __global const Quadric *quadric = scene->quadrics + primitive->a;
    float sin_phi, cos_phi;
    float_sincos(u.y * quadric->phi_max, &sin_phi, &cos_phi);
    float r = quadric->radius;
    Vec3 p = vec3(r * cos_phi, r * sin_phi, (1.0f - u.x) * quadric->z_min + u.x * quadric->z_max);
    Vec3 n = vec3(cos_phi, sin_phi, 0.0f);
    AreaPoint point = quadric_light_point(scene, primitive, p, n, cylinder_object_area(quadric));
    if (SCENE_HAS(scene, FEATURE_ALPHA))
        point.uv = cylinder_parameters(quadric, p);
    return point;
}

/* Uniform in object space over the part of the sphere between the heights and angles (Archimedes: equal heights have
 * equal areas). */
SHARED_FUNCTION AreaPoint sphere_light_sample_area(const SceneView *scene, const Primitive *primitive, Vec2 u)
{
    __global const Quadric *quadric = scene->quadrics + primitive->a;
    float z = (1.0f - u.x) * sphere_low(quadric) + u.x * sphere_high(quadric);
    float r = float_sqrt(float_max((quadric->radius - z) * (quadric->radius + z), 0.0f));
    float sin_phi, cos_phi;
    float_sincos(u.y * quadric->phi_max, &sin_phi, &cos_phi);
    Vec3 p = vec3(r * cos_phi, r * sin_phi, z);
    AreaPoint point = quadric_light_point(scene, primitive, p, p, sphere_object_area(quadric));
    if (SCENE_HAS(scene, FEATURE_ALPHA))
        point.uv = sphere_parameters(quadric, p);
    return point;
}

/* Squared distance from the centre, in squared radii, beyond which a point counts as outside. A point on the sphere
 * itself, which can see the rest of the sphere from inside, must not fall outside by rounding; sampling by area is
 * right on both sides. */
#define SPHERE_OUTSIDE 1.0001f

/* Squared sine of the half-angle of the cone that a whole sphere subtends at `ref`; 0 if `ref` is not outside or the
 * sphere is not whole. */
SHARED_FUNCTION float sphere_light_sin2(__global const Quadric *quadric, Vec3 ref)
{
    float distance2 = vec3_length_squared(vec3_sub(quadric->center, ref));
    float radius2 = quadric->world_radius * quadric->world_radius;
    return quadric->whole != 0u && distance2 > SPHERE_OUTSIDE * radius2 ? radius2 / distance2 : 0.0f;
}

/* 1 - cos of the half-angle, without the cancellation that gives 0 below 2e-4 radians. */
SHARED_FUNCTION float sphere_light_versine(float sin2)
{
    return sin2 / (1.0f + float_sqrt(1.0f - sin2));
}

/* The unit vector from the centre to a point of the near side, such that the directions to a whole sphere from outside
 * are uniform; u is mapped through the disk, as in warp_cone. It is computed from angles at the sphere's centre rather
 * than along the ray, so that the point lies on the sphere however small that is: with theta the angle at `ref` between
 * axis and ray, the sine of the angle between ray and normal is s = sin(theta) / sin(theta_max), and the angle at the
 * centre is asin(s) - theta. Sines are kept divided by the radius r in the disk, which is zero on the axis. */
SHARED_FUNCTION Vec3 sphere_light_cone(Vec3 axis, float sin2, Vec2 u)
{
    float r;
    Vec2 d = warp_disk_polar(u, &r);
    float versine_max = sphere_light_versine(sin2);
    float versine = r * r * versine_max;
    float cos_theta = 1.0f - versine;
    float sin_theta = float_sqrt(versine_max * (2.0f - versine));
    float s = float_sqrt((2.0f - versine) / (1.0f + float_sqrt(1.0f - sin2)));
    float c = float_sqrt(float_max(1.0f - r * r * s * s, 0.0f));
    float sin_alpha = s * cos_theta - c * sin_theta;
    float cos_alpha = c * cos_theta + r * r * s * sin_theta;
    return frame_to_world(frame_from_normal(axis), vec3(sin_alpha * d.x, sin_alpha * d.y, -cos_alpha));
}

SHARED_FUNCTION AreaPoint sphere_light_sample(const SceneView *scene, const Primitive *primitive, Vec3 ref, Vec2 u)
{
    __global const Quadric *quadric = scene->quadrics + primitive->a;
    float sin2 = sphere_light_sin2(quadric, ref);
    if (!(sin2 > 0.0f))
        return sphere_light_sample_area(scene, primitive, u);
    uint flags = scene->shapes[primitive->shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
    Vec3 n = sphere_light_cone(vec3_normalize(vec3_sub(quadric->center, ref)), sin2, u);
    AreaPoint point;
    point.p = vec3_mad(quadric->center, quadric->world_radius, n);
    point.ng = (flags & SHAPE_FLIP_NORMAL) != 0u ? vec3_negate(n) : n;
    point.uv = vec2(0.0f, 0.0f);
    if (SCENE_HAS(scene, FEATURE_ALPHA))
        point.uv =
            sphere_parameters(quadric, sphere_project(affine_vector(quadric->object_from_world, n), quadric->radius));
    point.pdf = warp_cone_pdf(sphere_light_versine(sin2));
    point.by_angle = 1u;
    return point;
}

/* Cone sampling only finds the near side of a sphere; the far side shows through the holes of an alpha texture. Decided
 * by the position of p, since the normal may be that of either side. */
SHARED_FUNCTION bool sphere_light_hidden(const SceneView *scene, const Primitive *primitive, Vec3 p, Vec3 wi)
{
    if ((primitive->shape_and_kind & PRIMITIVE_ALPHA_BIT) == 0u)
        return false;
    return vec3_dot(vec3_sub(p, scene->quadrics[primitive->a].center), wi) > 0.0f;
}

/* ---- area lights ------------------------------------------------------------------------------------------------- */

/* Radiance that the area light `light` emits towards `w` (unit, away from the surface) at a point with the geometric
 * normal `ng`: on the side of ng, or on both. */
SHARED_FUNCTION Vec3 light_emitted(const SceneView *scene, uint light, Vec3 ng, Vec3 w)
{
    __global const Light *emitter = scene->lights + light;
    if ((emitter->flags & LIGHT_TWO_SIDED) == 0u && !(vec3_dot(ng, w) > 0.0f))
        return vec3_splat(0.0f);
    return emitter->emission;
}

/* Whether `light` is an area light of alpha 0, which emits but is hit by no ray. */
SHARED_FUNCTION bool light_is_invisible(const SceneView *scene, uint light)
{
    return SCENE_HAS(scene, FEATURE_ALPHA) && (scene->lights[light].flags & LIGHT_INVISIBLE) != 0u;
}

/* Solid-angle density from area density; 0 if the direction lies in the surface. */
SHARED_FUNCTION float area_light_pdf_from_area(float pdf_a, float distance2, float cosine)
{
    float pdf_w = pdf_a * (distance2 / float_abs(cosine));
    return cosine != 0.0f && float_finite(pdf_w) ? pdf_w : 0.0f;
}

/* Opacity at the point p with texture coordinates uv: the probability with which a ray that hits it is kept
 * (primitive_alpha_keeps). */
SHARED_FUNCTION float area_light_alpha(const SceneView *scene, const Primitive *primitive, Vec3 p, Vec2 uv)
{
    if (!SCENE_HAS(scene, FEATURE_ALPHA) || (primitive->shape_and_kind & PRIMITIVE_ALPHA_BIT) == 0u)
        return 1.0f;
    TexturePoint at;
    at.p = p;
    at.n = vec3_splat(0.0f);
    at.uv = uv;
    uint alpha = scene->shapes[primitive->shape_and_kind & PRIMITIVE_SHAPE_MASK].alpha;
    return float_clamp(texture_eval_float(scene, alpha, &at), 0.0f, 1.0f);
}

/* The same where a path has hit the light (p and uv are read). A hit happens with that probability and brings the whole
 * emission; a point that is drawn brings that part of the emission. */
SHARED_FUNCTION float light_hit_alpha(const SceneView *scene, uint light, const Surface *hit)
{
    if (!SCENE_HAS(scene, FEATURE_ALPHA))
        return 1.0f;
    Primitive primitive = scene->primitives[scene->lights[light].primitive];
    return area_light_alpha(scene, &primitive, hit->p, hit->uv);
}

/* Draws a point by area, independently of any reference point. */
SHARED_FUNCTION AreaPoint area_light_point(const SceneView *scene, uint light, const Primitive *primitive, Vec2 u)
{
    uint kind = primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    if (SCENE_HAS(scene, FEATURE_BILINEAR) && kind == PRIMITIVE_BILINEAR)
        return patch_light_sample(scene, primitive, u);
    if (SCENE_HAS(scene, FEATURE_SPHERE) && kind == PRIMITIVE_SPHERE)
        return sphere_light_sample_area(scene, primitive, u);
    if (SCENE_HAS(scene, FEATURE_DISK) && kind == PRIMITIVE_DISK)
        return disk_light_sample(scene, primitive, u);
    if (primitive_is_cylinder(scene, primitive))
        return cylinder_light_sample(scene, primitive, u);
    return triangle_light_sample(scene, primitive, scene->lights[light].area, u);
}

/* Density per area with which area_light_point draws `hit` (ng, u, v are read). */
SHARED_FUNCTION float area_light_pdf_a(const SceneView *scene, uint light, const Primitive *primitive,
                                       const Surface *hit)
{
    uint kind = primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    if (SCENE_HAS(scene, FEATURE_BILINEAR) && kind == PRIMITIVE_BILINEAR) {
        PatchCorners corners = patch_corners(scene, primitive->a);
        return patch_light_pdf(&corners, hit->u, hit->v);
    }
    if (SCENE_HAS(scene, FEATURE_SPHERE) && kind == PRIMITIVE_SPHERE) {
        __global const Quadric *sphere = scene->quadrics + primitive->a;
        return quadric_light_pdf(sphere, sphere_object_area(sphere), hit->ng);
    }
    if (SCENE_HAS(scene, FEATURE_DISK) && kind == PRIMITIVE_DISK) {
        __global const Quadric *disk = scene->quadrics + primitive->a;
        return quadric_light_pdf(disk, disk_object_area(disk), hit->ng);
    }
    if (primitive_is_cylinder(scene, primitive)) {
        __global const Quadric *cylinder = scene->quadrics + primitive->a;
        return quadric_light_pdf(cylinder, cylinder_object_area(cylinder), hit->ng);
    }
    return 1.0f / scene->lights[light].area;
}

/* Draws a point as seen from `ref`. */
SHARED_FUNCTION AreaPoint area_light_point_from(const SceneView *scene, uint light, const Primitive *primitive,
                                                Vec3 ref, Vec2 u)
{
    if (SCENE_HAS(scene, FEATURE_SPHERE) && primitive->shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_SPHERE)
        return sphere_light_sample(scene, primitive, ref, u);
    return area_light_point(scene, light, primitive, u);
}

SHARED_FUNCTION bool area_light_sample(const SceneView *scene, uint light, Vec3 ref, Vec2 u, LightSample *sample)
{
    Primitive primitive = scene->primitives[scene->lights[light].primitive];
    AreaPoint point = area_light_point_from(scene, light, &primitive, ref, u);
    Vec3 d = vec3_sub(point.p, ref);
    float distance2 = vec3_length_squared(d);
    if (!(distance2 > 0.0f))
        return false;
    sample->wi = vec3_scale(d, 1.0f / float_sqrt(distance2));
    sample->p = point.p;
    sample->ng = point.ng;
    sample->radiance = light_emitted(scene, light, point.ng, vec3_negate(sample->wi));
    sample->pdf_w = point.pdf;
    if (point.by_angle == 0u)
        sample->pdf_w = area_light_pdf_from_area(point.pdf, distance2, vec3_dot(point.ng, sample->wi));
    sample->pdf_emit = point.pdf;
    if (SCENE_HAS(scene, FEATURE_SPHERE) && point.by_angle != 0u) {
        Surface hit = {0}; /* spheres read the normal alone */
        hit.ng = point.ng;
        sample->pdf_emit = area_light_pdf_a(scene, light, &primitive, &hit);
    }
    sample->delta = light_is_invisible(scene, light) ? 1u : 0u;
    sample->infinite = 0u;
    if (!(sample->pdf_w > 0.0f && float_finite(sample->pdf_w)) || vec3_is_zero(sample->radiance))
        return false;
    if (sample->delta == 0u)
        sample->radiance = vec3_scale(sample->radiance, area_light_alpha(scene, &primitive, point.p, point.uv));
    return !vec3_is_zero(sample->radiance);
}

SHARED_FUNCTION float area_light_pdf_w(const SceneView *scene, uint light, Vec3 ref, Vec3 wi, const Surface *hit)
{
    Primitive primitive = scene->primitives[scene->lights[light].primitive];
    if (SCENE_HAS(scene, FEATURE_SPHERE) && primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_SPHERE) {
        float sin2 = sphere_light_sin2(scene->quadrics + primitive.a, ref);
        if (sin2 > 0.0f)
            return sphere_light_hidden(scene, &primitive, hit->p, wi) ? 0.0f
                                                                      : warp_cone_pdf(sphere_light_versine(sin2));
    }
    float pdf_a = area_light_pdf_a(scene, light, &primitive, hit);
    return area_light_pdf_from_area(pdf_a, vec3_length_squared(vec3_sub(hit->p, ref)), vec3_dot(hit->ng, wi));
}

#endif
