/* The sphere, whole or clipped, under any affine map; pbrt's parametrisation: phi = u phi_max about the z axis from x,
 * theta from z_min (v = 0) to z_max (v = 1). */
#ifndef TWINLIGHT_GEOMETRY_SPHERE_H
#define TWINLIGHT_GEOMETRY_SPHERE_H

#include "geometry/ray.h"
#include "layout/scene_types.h"
#include "math/elementary.h"

/* phi in [0, 2 pi) of a point around the z axis; 0 on the axis. */
SHARED_FUNCTION float quadric_phi(Vec3 p)
{
    if (p.x == 0.0f && p.y == 0.0f)
        return 0.0f;
    float phi = float_atan2(p.y, p.x);
    return phi < 0.0f ? phi + 2.0f * PI : phi;
}

/* Angle from the +z axis; accurate at the poles, where an arc cosine is not. */
SHARED_FUNCTION float sphere_theta(Vec3 p)
{
    return float_atan2(float_sqrt(p.x * p.x + p.y * p.y), p.z);
}

SHARED_FUNCTION float sphere_theta_of_height(__global const Quadric *quadric, float z)
{
    return float_acos(float_clamp(z / quadric->radius, -1.0f, 1.0f));
}

/* (u, v) of a point on the sphere in object space. */
SHARED_FUNCTION Vec2 sphere_parameters(__global const Quadric *quadric, Vec3 p)
{
    float first = sphere_theta_of_height(quadric, quadric->z_min);
    float last = sphere_theta_of_height(quadric, quadric->z_max);
    float u = quadric_phi(p) / quadric->phi_max;
    float v = (sphere_theta(p) - first) / (last - first);
    return vec2(float_clamp(u, 0.0f, 1.0f), float_clamp(v, 0.0f, 1.0f));
}

/* The point of the sphere around (0,0,0) on the line from there through p. */
SHARED_FUNCTION Vec3 sphere_project(Vec3 p, float radius)
{
    float length = vec3_length(p);
    return length > 0.0f ? vec3_scale(p, radius / length) : vec3(radius, 0.0f, 0.0f);
}

/* Whether a point of the sphere, in object space, belongs to the clipped part. */
SHARED_FUNCTION bool sphere_keeps(__global const Quadric *quadric, Vec3 p)
{
    if (quadric->z_min > -quadric->radius && p.z < quadric->z_min)
        return false;
    if (quadric->z_max < quadric->radius && p.z > quadric->z_max)
        return false;
    return quadric->phi_max >= 2.0f * PI || quadric_phi(p) <= quadric->phi_max;
}

SHARED_FUNCTION bool sphere_is_clipped(__global const Quadric *quadric)
{
    return quadric->z_min > -quadric->radius || quadric->z_max < quadric->radius || quadric->phi_max < 2.0f * PI;
}

/* t of both intersections of the line f + t d with the sphere of radius r around (0,0,0), in increasing order, and
 * *root = r |d| cosine at either, which is (d.n) with n the unit normal, times r. In the form of Haines et al.,
 * "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, chapter 7, 2019: the discriminant from the
 * line's distance to the centre, and no difference of nearly equal numbers in the roots. */
SHARED_FUNCTION bool sphere_roots(Vec3 f, Vec3 d, float r, float *t_near, float *t_far, float *root)
{
    float dd = vec3_dot(d, d);
    float b = -vec3_dot(f, d);
    Vec3 closest = vec3_mad(f, b / dd, d);
    float distance = vec3_length(closest);
    float discriminant = (r + distance) * (r - distance);
    if (!(discriminant >= 0.0f))
        return false;
    *root = float_sqrt(dd * discriminant);
    float q = b < 0.0f ? b - *root : b + *root;
    float length = vec3_length(f);
    float c = (length + r) * (length - r);
    float t0 = q == 0.0f ? 0.0f : c / q, t1 = q / dd;
    *t_near = float_min(t0, t1);
    *t_far = float_max(t0, t1);
    return true;
}

/* The point of the sphere at o + t d, put back onto it, in object space; *world: in the space around. */
SHARED_FUNCTION Vec3 sphere_point(__global const Quadric *quadric, Vec3 o, Vec3 d, float t, Vec3 *world)
{
    if (quadric->whole) {
        Vec3 f = vec3_mad(vec3_sub(o, quadric->center), t, d);
        Vec3 outward = sphere_project(f, quadric->world_radius);
        *world = vec3_add(quadric->center, outward);
        return sphere_project(affine_vector(quadric->object_from_world, outward), quadric->radius);
    }
    Vec3 p = vec3_mad(affine_point(quadric->object_from_world, o), t, affine_vector(quadric->object_from_world, d));
    p = sphere_project(p, quadric->radius);
    *world = affine_point(quadric->world_from_object, p);
    return p;
}

/* The first intersection with after < t < t_max, after >= 0. */
SHARED_FUNCTION bool sphere_query(__global const Quadric *quadric, const RayQuery *query, float after, float *t)
{
    RayQuery inner = *query;
    Vec3 center = vec3_splat(0.0f);
    float radius = quadric->radius;
    if (quadric->whole) {
        center = quadric->center;
        radius = quadric->world_radius;
    } else
        inner = ray_query_transform(quadric->object_from_world, query);
    Vec3 f = vec3_sub(inner.o, center);
    float roots[2], root;
    if (!sphere_roots(f, inner.d, radius, &roots[0], &roots[1], &root))
        return false;
    for (uint i = 0; i < 2u; ++i) {
        float reach = ray_query_reach(&inner, roots[i]) + vec3_max_abs(center) + radius;
        float tolerance = radius * (4.0f * FLOAT_EPSILON * reach + vec3_max_abs(inner.error));
        if (!(roots[i] > after && roots[i] < query->t_max && ray_query_clear(&inner, roots[i], root, tolerance)))
            continue;
        *t = roots[i];
        if (!sphere_is_clipped(quadric) ||
            sphere_keeps(quadric, sphere_project(vec3_mad(f, roots[i], inner.d), radius)))
            return true;
    }
    return false;
}

#endif
