/* The disk at a height on the z axis, whole, holed or a sector, under any affine map; pbrt's parametrisation:
 * phi = u phi_max, radius from the rim (v = 0) to the inner radius (v = 1). */
#ifndef TWINLIGHT_GEOMETRY_DISK_H
#define TWINLIGHT_GEOMETRY_DISK_H

#include "geometry/sphere.h"

/* (u, v) of a point of the disk in object space. */
SHARED_FUNCTION Vec2 disk_parameters(__global const Quadric *quadric, Vec3 p)
{
    float distance = float_sqrt(p.x * p.x + p.y * p.y);
    float u = quadric_phi(p) / quadric->phi_max;
    float v = (quadric->radius - distance) / (quadric->radius - quadric->inner_radius);
    return vec2(float_clamp(u, 0.0f, 1.0f), float_clamp(v, 0.0f, 1.0f));
}

/* The point of the disk at o + t d, put back onto it, in object space; *world: in the space around. */
SHARED_FUNCTION Vec3 disk_point(__global const Quadric *quadric, Vec3 o, Vec3 d, float t, Vec3 *world)
{
    Vec3 p = vec3_mad(affine_point(quadric->object_from_world, o), t, affine_vector(quadric->object_from_world, d));
    p.z = quadric->z_min;
    *world = affine_point(quadric->world_from_object, p);
    return p;
}

/* The intersection with 0 < t < t_max. */
SHARED_FUNCTION bool disk_query(__global const Quadric *quadric, const RayQuery *query, float *t)
{
    RayQuery inner = ray_query_transform(quadric->object_from_world, query);
    float height = quadric->z_min;
    if (inner.d.z == 0.0f)
        return false;
    *t = (height - inner.o.z) / inner.d.z;
    if (!(*t > 0.0f && *t < query->t_max))
        return false;
    float error = inner.error.z + 2.0f * FLOAT_EPSILON * (float_abs(inner.o.z) + *t * float_abs(inner.d.z));
    if (!ray_query_clear(&inner, *t, float_abs(inner.d.z), error))
        return false;
    Vec3 p = vec3_mad(inner.o, *t, inner.d);
    p.z = height;
    float distance_squared = p.x * p.x + p.y * p.y;
    if (!(distance_squared <= quadric->radius * quadric->radius) ||
        distance_squared < quadric->inner_radius * quadric->inner_radius)
        return false;
    return quadric->phi_max >= 2.0f * PI || quadric_phi(p) <= quadric->phi_max;
}

#endif
