/* The triangle test: watertight without fused arithmetic, both sides hit.
 *
 * After Woop, Benthin and Wald 2013, the corners are sheared so that the ray becomes the z axis, once per corner and in
 * the same way for every triangle that shares it; then the origin of the plane is located by 2D edge functions p.x q.y
 * - p.y q.x. Rounding is monotone, so a computed edge function that is not zero has the sign of the exact one of the
 * sheared corners, and exchanging p and q negates it exactly. A point that the sheared triangle contains is therefore
 * never rejected, and since the sheared triangles of a mesh share their corners bit for bit, no ray passes through an
 * edge or a corner. (The paper evaluates again in double where an edge function is zero; here zero counts as inside for
 * both neighbours, and the smaller primitive number takes the hit.) */
#ifndef TWINLIGHT_GEOMETRY_TRIANGLE_H
#define TWINLIGHT_GEOMETRY_TRIANGLE_H

#include "geometry/ray.h"

/* Corners relative to the ray, after the shear. z is the corner's t if it lay on the ray. */
typedef struct ShearedCorner {
    float x, y, z;
} ShearedCorner;

/* Signed areas, times two, that the ray's point makes with the edges opposite to a, b, c. */
typedef struct TriangleEdges {
    float a, b, c;
} TriangleEdges;

SHARED_FUNCTION ShearedCorner triangle_shear(float px, float py, float pz, const RayQuery *query)
{
    ShearedCorner corner;
    float z = pz - query->oz;
    corner.x = (px - query->ox) - query->sx * z;
    corner.y = (py - query->oy) - query->sy * z;
    corner.z = query->sz * z;
    return corner;
}

SHARED_FUNCTION TriangleEdges triangle_edges(ShearedCorner a, ShearedCorner b, ShearedCorner c)
{
    TriangleEdges edges;
    edges.a = b.x * c.y - b.y * c.x;
    edges.b = c.x * a.y - c.y * a.x;
    edges.c = a.x * b.y - a.y * b.x;
    return edges;
}

/* Whether the ray's line passes through the triangle. */
SHARED_FUNCTION bool triangle_contains(TriangleEdges e)
{
    bool negative = e.a < 0.0f || e.b < 0.0f || e.c < 0.0f;
    bool positive = e.a > 0.0f || e.b > 0.0f || e.c > 0.0f;
    return !(negative && positive);
}

/* Not normalised; its direction follows the right-hand rule a, b, c. */
SHARED_FUNCTION Vec3 triangle_normal(Vec3 a, Vec3 b, Vec3 c)
{
    return vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
}

/* Bounds on the terms of the components of triangle_normal, for the rounding errors of what is made from it. */
SHARED_FUNCTION Vec3 triangle_normal_terms(Vec3 a, Vec3 b, Vec3 c)
{
    Vec3 e = vec3_abs(vec3_sub(b, a)), f = vec3_abs(vec3_sub(c, a));
    return vec3(e.y * f.z + e.z * f.y, e.z * f.x + e.x * f.z, e.x * f.y + e.y * f.x);
}

/* A triangle's plane with what bounds its rounding errors. */
typedef struct TrianglePlane {
    Vec3 a; /* a point of it */
    Vec3 normal; /* not normalised */
    Vec3 terms; /* triangle_normal_terms */
    Vec3 size; /* largest absolute coordinates of the corners */
} TrianglePlane;

/* Rounding of the distance from the plane, in units of FLOAT_EPSILON times the magnitude of its terms: by the
 * arithmetic here, and by the interpolation of a point on the triangle. 4 and 2 would bound the worst case; of 10^7
 * points on triangles of all shapes, none was off by more than half of what 2 and 1 allow. */
#define TRIANGLE_ULPS_AWAY 2.0f
#define TRIANGLE_ULPS_SIZE 1.0f

/* Which side of the plane p, an end of the query, is on: +1 (the side of the normal), -1, or 0 when rounding cannot
 * tell. Errors are bounded component by component, so that nothing is lost near a large floor that is parallel to an
 * axis. Only an error beyond the offset that ray_spawn gave to p makes the answer 0: a ray that starts in a corner,
 * nearer to the other wall than the offset, must still hit that wall. error: of each component of p. */
SHARED_FUNCTION int triangle_side(const TrianglePlane *plane, Vec3 p, Vec3 error, float offset)
{
    Vec3 away = vec3_sub(p, plane->a);
    Vec3 bound = vec3_mad(vec3_scale(vec3_abs(away), TRIANGLE_ULPS_AWAY), TRIANGLE_ULPS_SIZE, plane->size);
    bound = vec3_mad(error, FLOAT_EPSILON, bound);
    float distance = vec3_dot(plane->normal, away);
    Vec3 n = vec3_abs(plane->normal);
    float length = float_max(vec3_max_component(n), 0.57f * (n.x + n.y + n.z)); /* of the normal, or less */
    float tolerance = vec3_dot(plane->terms, bound) - offset * vec3_max_abs(p) * length;
    tolerance = float_max(tolerance, 0.0f);
    return distance > tolerance ? 1 : distance < -tolerance ? -1 : 0;
}

/* +1 when d runs to the side of the normal, -1, or 0 when rounding cannot tell. */
SHARED_FUNCTION int triangle_slope(const TrianglePlane *plane, Vec3 d)
{
    float slope = vec3_dot(plane->normal, d);
    float tolerance = 3.0f * FLOAT_EPSILON * vec3_dot(plane->terms, vec3_abs(d));
    return slope > tolerance ? 1 : slope < -tolerance ? -1 : 0;
}

/* The rounding error of o + t_max d. */
SHARED_FUNCTION Vec3 triangle_end_error(const RayQuery *query)
{
    Vec3 size = vec3_add(vec3_abs(query->o), vec3_scale(vec3_abs(query->d), query->t_max));
    return vec3_add(vec3_scale(size, FLOAT_EPSILON), query->error);
}

/* The triangle that an end of the ray lies on must not be hit there, and the rounded t cannot tell. So where t is
 * within its error of 0 or t_max, the decision is made by the sides of the plane that the ends are on. near, far: which
 * ends to check. */
SHARED_FUNCTION bool triangle_between_ends(Vec3 a, Vec3 b, Vec3 c, Vec3 normal, const RayQuery *query, bool near,
                                           bool far)
{
    TrianglePlane plane;
    plane.a = a;
    plane.normal = normal;
    plane.terms = triangle_normal_terms(a, b, c);
    plane.size = vec3_max(vec3_abs(a), vec3_max(vec3_abs(b), vec3_abs(c)));
    int slope = triangle_slope(&plane, query->d);
    if (near) {
        int side = triangle_side(&plane, query->o, query->error, query->offset);
        if (side == 0 || side * slope > 0)
            return false;
    }
    if (far) {
        Vec3 end = vec3_mad(query->o, query->t_max, query->d);
        int side = triangle_side(&plane, end, triangle_end_error(query), query->offset);
        if (side == 0 || side * slope < 0)
            return false;
    }
    return true;
}

SHARED_FUNCTION float corner_extent(ShearedCorner a)
{
    return float_max(float_abs(a.x), float_abs(a.y));
}

/* Bound on the rounding error of t times area, from the shear, the edge functions, and an origin that is off the
 * triangle. */
#define TRIANGLE_ULPS_T 32.0f

SHARED_FUNCTION float triangle_t_error(ShearedCorner a, ShearedCorner b, ShearedCorner c, const RayQuery *query)
{
    float extent = float_max(corner_extent(a), float_max(corner_extent(b), corner_extent(c)));
    float depth = float_max(float_abs(a.z), float_max(float_abs(b.z), float_abs(c.z)));
    float reach = depth + float_abs(query->sz) * (vec3_max_abs(query->o) + vec3_max_abs(query->error));
    return TRIANGLE_ULPS_T * FLOAT_EPSILON * extent * extent * reach;
}

/* Completes the test of a triangle that the ray's line passes through (triangle_contains, area not zero): the hit with
 * 0 < t < t_max. sa, sb, sc, e: its sheared corners and their edge functions. */
SHARED_FUNCTION bool triangle_finish(Vec3 a, Vec3 b, Vec3 c, ShearedCorner sa, ShearedCorner sb, ShearedCorner sc,
                                     TriangleEdges e, const RayQuery *query, float *t, float *u, float *v)
{
    float area = e.a + e.b + e.c;
    float volume = e.a * sa.z + e.b * sb.z + e.c * sc.z;
    *t = volume / area;
    if (!(*t > 0.0f && *t < query->t_max))
        return false;
    Vec3 normal = triangle_normal(a, b, c);
    if (vec3_is_zero(normal))
        return false;
    float error = triangle_t_error(sa, sb, sc, query);
    bool near = float_abs(volume) <= error;
    bool far = (query->t_max - *t) * float_abs(area) <= error;
    if ((near || far) && !triangle_between_ends(a, b, c, normal, query, near, far))
        return false;
    *u = e.b / area;
    *v = e.c / area;
    return true;
}

/* The hit of the triangle a, b, c with 0 < t < t_max; u and v are the barycentric weights of b and c. Triangles whose
 * normal computes to zero, and NaNs anywhere, give no hit. The result depends on nothing but the arguments. */
SHARED_FUNCTION bool triangle_query(Vec3 a, Vec3 b, Vec3 c, const RayQuery *query, float *t, float *u, float *v)
{
    uint kx = query->kx, ky = query->ky, kz = query->kz;
    ShearedCorner sa = triangle_shear(vec3_component(a, kx), vec3_component(a, ky), vec3_component(a, kz), query);
    ShearedCorner sb = triangle_shear(vec3_component(b, kx), vec3_component(b, ky), vec3_component(b, kz), query);
    ShearedCorner sc = triangle_shear(vec3_component(c, kx), vec3_component(c, ky), vec3_component(c, kz), query);
    TriangleEdges e = triangle_edges(sa, sb, sc);
    float area = e.a + e.b + e.c;
    if (!triangle_contains(e) || !(area > 0.0f || area < 0.0f))
        return false;
    return triangle_finish(a, b, c, sa, sb, sc, e, query, t, u, v);
}

#endif
