/* Rays: how they leave surfaces, and the form in which primitives test them.
 *
 * Two measures together keep a ray from hitting the surface that it leaves. Its origin is moved off the surface by a
 * few units in the last place of its largest coordinate (Waechter and Binder, "A Fast and Robust Method for Avoiding
 * Self-Intersection", Ray Tracing Gems, chapter 6, 2019), which exceeds the rounding error of the point itself. And
 * every primitive rejects an intersection whose tangent plane contains an end of the ray to within the rounding of its
 * own arithmetic. The offset cannot cover that error: a point near (0,0,0) may lie on a triangle whose corners are 10^4
 * away. */
#ifndef TWINLIGHT_GEOMETRY_RAY_H
#define TWINLIGHT_GEOMETRY_RAY_H

#include "layout/path_types.h"

/* 2^-23: the distance from 1 to the next float. */
#define FLOAT_EPSILON 1.1920928955078125e-7f

/* Offset of a ray's origin, in units of FLOAT_EPSILON times its largest coordinate. The interpolation of a point on a
 * triangle can leave it 3 units off the plane (0.7 at most in 10^7 tries), an instance's transform twice that. */
#define RAY_OFFSET_ULPS 8.0f

SHARED_FUNCTION Vec3 vec3_abs(Vec3 a)
{
    return vec3(float_abs(a.x), float_abs(a.y), float_abs(a.z));
}

SHARED_FUNCTION Vec3 vec3_max(Vec3 a, Vec3 b)
{
    return vec3(float_max(a.x, b.x), float_max(a.y, b.y), float_max(a.z, b.z));
}

SHARED_FUNCTION float vec3_max_abs(Vec3 a)
{
    return vec3_max_component(vec3_abs(a));
}

/* p moved off its surface along `normal` (unit; zero: not moved), rounded away from the surface. */
SHARED_FUNCTION Vec3 ray_offset(Vec3 p, Vec3 normal)
{
    float step = RAY_OFFSET_ULPS * FLOAT_EPSILON * vec3_max_abs(p);
    Vec3 moved = vec3_mad(p, step, normal);
    return vec3(float_step(moved.x, normal.x), float_step(moved.y, normal.y), float_step(moved.z, normal.z));
}

/* `normal` or its opposite, whichever is on the side of `direction`. */
SHARED_FUNCTION Vec3 ray_side(Vec3 normal, Vec3 direction)
{
    return vec3_dot(normal, direction) < 0.0f ? vec3_negate(normal) : normal;
}

/* The ray that leaves point p of a surface with geometric normal ng (zero: not on a surface) in direction wi. */
SHARED_FUNCTION Ray ray_spawn(Vec3 p, Vec3 ng, Vec3 wi)
{
    Ray ray;
    ray.o = ray_offset(p, ray_side(ng, wi));
    ray.d = wi;
    ray.t_max = FLOAT_MAX;
    return ray;
}

/* Largest component of origins and directions of rays. Larger ones overflow the tests of primitives, and Embree may end
 * the program over them. */
#define RAY_COMPONENT_MAX 1e18f

/* Whether a ray can be traced: every component of origin and direction is finite and in range. One that is not hits
 * nothing and is not occluded; kernels end its path. */
SHARED_FUNCTION bool ray_traceable(Vec3 o, Vec3 d)
{
    return float_abs(o.x) <= RAY_COMPONENT_MAX && float_abs(o.y) <= RAY_COMPONENT_MAX &&
           float_abs(o.z) <= RAY_COMPONENT_MAX && float_abs(d.x) <= RAY_COMPONENT_MAX &&
           float_abs(d.y) <= RAY_COMPONENT_MAX && float_abs(d.z) <= RAY_COMPONENT_MAX;
}

/* True when a comes before b, x first. */
SHARED_FUNCTION bool vec3_before(Vec3 a, Vec3 b)
{
    if (a.x != b.x)
        return a.x < b.x;
    if (a.y != b.y)
        return a.y < b.y;
    return a.z < b.z;
}

/* The open segment between p and q, points of surfaces with geometric normals ngp and ngq (zero: not on a surface). Its
 * direction does not depend on the order of the arguments, so that asking whether q sees p gives the bits of asking
 * whether p sees q. t_max is 1, or 0 (nothing to trace) if the ends coincide. */
SHARED_FUNCTION Ray ray_between(Vec3 p, Vec3 ngp, Vec3 q, Vec3 ngq)
{
    Vec3 w = vec3_sub(q, p);
    Vec3 from = ray_offset(p, ray_side(ngp, w));
    Vec3 to = ray_offset(q, ray_side(ngq, vec3_negate(w)));
    bool ordered = vec3_before(from, to);
    Ray ray;
    ray.o = ordered ? from : to;
    ray.d = ordered ? vec3_sub(to, from) : vec3_sub(from, to);
    ray.t_max = vec3_is_zero(w) || vec3_is_zero(ray.d) ? 0.0f : 1.0f;
    return ray;
}

/* The same, from p to q in this order: media are counted from p on. */
SHARED_FUNCTION_APART Ray ray_from_to(Vec3 p, Vec3 ngp, Vec3 q, Vec3 ngq)
{
    Vec3 w = vec3_sub(q, p);
    Ray ray;
    ray.o = ray_offset(p, ray_side(ngp, w));
    ray.d = vec3_sub(ray_offset(q, ray_side(ngq, vec3_negate(w))), ray.o);
    ray.t_max = vec3_is_zero(w) || vec3_is_zero(ray.d) ? 0.0f : 1.0f;
    return ray;
}

/* ---- the ray in tests of primitives ---------------------------------------------------------------------------- */

/* A ray with what every primitive's test needs. kz is the axis along which d is largest, kx and ky the two others; the
 * shear (sx, sy, sz) maps the ray to the positive z axis with z = t (Woop, Benthin and Wald, "Watertight Ray/Triangle
 * Intersection", JCGT 2(1), 2013). */
typedef struct RayQuery {
    Vec3 o;
    Vec3 d;
    float t_max;
    Vec3 error; /* bound on the error of each component of o from a transform's rounding */
    float offset; /* by how much, relative to its largest coordinate, ray_offset moved each end; 0: unknown */
    uint kx, ky, kz;
    float ox, oy, oz; /* o along kx, ky, kz */
    float sx, sy, sz;
} RayQuery;

SHARED_FUNCTION float vec3_component(Vec3 a, uint k)
{
    float xy = float_select(k == 0u, a.x, a.y);
    return float_select(k == 2u, a.z, xy);
}

SHARED_FUNCTION RayQuery ray_query_shear(Vec3 o, Vec3 d, float t_max, Vec3 error, float offset)
{
    RayQuery query;
    Vec3 size = vec3_abs(d);
    query.o = o;
    query.d = d;
    query.t_max = t_max;
    query.error = error;
    query.offset = offset;
    uint larger = size.x > size.y ? 0u : 1u;
    query.kz = size.z >= float_max(size.x, size.y) ? 2u : larger;
    query.kx = query.kz == 2u ? 0u : query.kz + 1u;
    query.ky = query.kx == 2u ? 0u : query.kx + 1u;
    query.ox = vec3_component(o, query.kx);
    query.oy = vec3_component(o, query.ky);
    query.oz = vec3_component(o, query.kz);
    query.sz = 1.0f / vec3_component(d, query.kz);
    query.sx = vec3_component(d, query.kx) * query.sz;
    query.sy = vec3_component(d, query.ky) * query.sz;
    return query;
}

SHARED_FUNCTION RayQuery ray_query(Ray ray)
{
    return ray_query_shear(ray.o, ray.d, ray.t_max, vec3_splat(0.0f), RAY_OFFSET_ULPS * FLOAT_EPSILON);
}

/* |M| |p| + |translation|: what bounds the rounding of affine_point. */
SHARED_FUNCTION Vec3 affine_magnitude(Affine a, Vec3 p)
{
    Affine b;
    for (uint i = 0; i < 12u; ++i)
        b.m[i] = float_abs(a.m[i]);
    return affine_point(b, vec3_abs(p));
}

/* The ray in the space of an instance or quadric. d is not normalised, so t stays the same. */
SHARED_FUNCTION RayQuery ray_query_transform(Affine object_from_world, const RayQuery *world)
{
    Vec3 o = affine_point(object_from_world, world->o);
    Vec3 d = affine_vector(object_from_world, world->d);
    Vec3 error = vec3_scale(affine_magnitude(object_from_world, world->o), 4.0f * FLOAT_EPSILON);
    return ray_query_shear(o, d, world->t_max, error, 0.0f);
}

/* Whether a hit at t may count: neither end of the ray may lie within `tolerance` of the tangent plane of the hit,
 * whose normal has the component `cosine` (absolute, times the length of d) along the ray. */
SHARED_FUNCTION bool ray_query_clear(const RayQuery *query, float t, float cosine, float tolerance)
{
    return t * cosine > tolerance && (query->t_max - t) * cosine > tolerance;
}

/* Bound on the coordinates of the ray from its origin to t, for the tolerance of primitives. */
SHARED_FUNCTION float ray_query_reach(const RayQuery *query, float t)
{
    return vec3_max_abs(query->o) + t * vec3_max_abs(query->d);
}

#endif
