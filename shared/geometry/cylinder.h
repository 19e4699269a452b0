/* The cylinder around the z axis, open at both ends, whole or a part of the way around, under any affine map; pbrt's
 * parametrisation: phi = u phi_max about the z axis from x, z from z_min (v = 0) to z_max (v = 1). */
#ifndef TWINLIGHT_GEOMETRY_CYLINDER_H
#define TWINLIGHT_GEOMETRY_CYLINDER_H

#include "geometry/sphere.h"

/* (u, v) of a point of the cylinder in object space. */
SHARED_FUNCTION Vec2 cylinder_parameters(__global const Quadric *quadric, Vec3 p)
{
    float u = quadric_phi(p) / quadric->phi_max;
    float v = (p.z - quadric->z_min) / (quadric->z_max - quadric->z_min);
    return vec2(float_clamp(u, 0.0f, 1.0f), float_clamp(v, 0.0f, 1.0f));
}

/* The point at the height of p at the distance `radius` from the z axis, in the direction of p. */
SHARED_FUNCTION Vec3 cylinder_project(Vec3 p, float radius)
{
    Vec3 rim = sphere_project(vec3(p.x, p.y, 0.0f), radius);
    return vec3(rim.x, rim.y, p.z);
}

/* Whether a point at the distance of the radius from the z axis belongs to the clipped part. */
SHARED_FUNCTION bool cylinder_keeps(__global const Quadric *quadric, Vec3 p)
{
    return p.z >= quadric->z_min && p.z <= quadric->z_max &&
           (quadric->phi_max >= 2.0f * PI || quadric_phi(p) <= quadric->phi_max);
}

/* The point of the cylinder at o + t d, put back onto it, in object space; *world: in the space around. */
SHARED_FUNCTION_APART Vec3 cylinder_point(__global const Quadric *quadric, Vec3 o, Vec3 d, float t, Vec3 *world)
{
    Vec3 p = vec3_mad(affine_point(quadric->object_from_world, o), t, affine_vector(quadric->object_from_world, d));
    p = cylinder_project(p, quadric->radius);
    *world = affine_point(quadric->world_from_object, p);
    return p;
}

/* The first intersection with after < t < t_max, after >= 0: in the plane z = 0, the cylinder is a circle. A ray along
 * the axis hits nothing. */
SHARED_FUNCTION_APART bool cylinder_query(__global const Quadric *quadric, const RayQuery *query, float after, float *t)
{
    RayQuery inner = ray_query_transform(quadric->object_from_world, query);
    float radius = quadric->radius, roots[2], root;
    Vec3 o = vec3(inner.o.x, inner.o.y, 0.0f), d = vec3(inner.d.x, inner.d.y, 0.0f);
    if (!sphere_roots(o, d, radius, &roots[0], &roots[1], &root))
        return false;
    for (uint i = 0; i < 2u; ++i) {
        float reach = vec3_max_abs(o) + roots[i] * vec3_max_abs(inner.d) + radius;
        float error = 4.0f * FLOAT_EPSILON * reach + float_max(inner.error.x, inner.error.y);
        if (!(roots[i] > after && roots[i] < query->t_max && ray_query_clear(&inner, roots[i], root, radius * error)))
            continue;
        *t = roots[i];
        if (cylinder_keeps(quadric, cylinder_project(vec3_mad(inner.o, roots[i], inner.d), radius)))
            return true;
    }
    return false;
}

#endif
