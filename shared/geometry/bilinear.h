/* The bilinear patch p(u, v) = (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11, both sides hit. After Reshetov,
 * "Cool Patches: A Geometric Approach to Ray/Bilinear Patch Intersections", Ray Tracing Gems, chapter 8, 2019: u is
 * where the line p(u, .) meets the ray, a quadratic; v and t follow from the closest points of two lines. */
#ifndef TWINLIGHT_GEOMETRY_BILINEAR_H
#define TWINLIGHT_GEOMETRY_BILINEAR_H

#include "geometry/ray.h"

/* Corners of a patch. */
typedef struct PatchCorners {
    Vec3 p00, p10, p01, p11;
} PatchCorners;

/* How far outside [0, 1] a parameter may lie and still count, so that neighbours overlap rather than leak. */
#define PATCH_OVERLAP (16.0f * FLOAT_EPSILON)

SHARED_FUNCTION Vec3 patch_point(const PatchCorners *q, float u, float v)
{
    return vec3_lerp(vec3_lerp(q->p00, q->p01, v), vec3_lerp(q->p10, q->p11, v), u);
}

SHARED_FUNCTION Vec3 patch_dpdu(const PatchCorners *q, float v)
{
    return vec3_lerp(vec3_sub(q->p10, q->p00), vec3_sub(q->p11, q->p01), v);
}

SHARED_FUNCTION Vec3 patch_dpdv(const PatchCorners *q, float u)
{
    return vec3_lerp(vec3_sub(q->p01, q->p00), vec3_sub(q->p11, q->p10), u);
}

/* Real roots of a x^2 + b x + c = 0, without cancellation; returns their number. */
SHARED_FUNCTION uint quadratic_roots(float a, float b, float c, float *x0, float *x1)
{
    if (a == 0.0f) {
        *x0 = *x1 = -c / b;
        return b == 0.0f ? 0u : 1u;
    }
    float discriminant = b * b - 4.0f * a * c;
    if (!(discriminant >= 0.0f))
        return 0u;
    float root = float_sqrt(discriminant);
    float q = -0.5f * (b < 0.0f ? b - root : b + root);
    *x0 = q / a;
    *x1 = q == 0.0f ? *x0 : c / q;
    return 2u;
}

SHARED_FUNCTION float patch_size(const PatchCorners *q)
{
    return float_max(float_max(vec3_max_abs(q->p00), vec3_max_abs(q->p10)),
                     float_max(vec3_max_abs(q->p01), vec3_max_abs(q->p11)));
}

/* Where the ray meets the line p(u, .). */
SHARED_FUNCTION bool patch_query_line(const PatchCorners *q, const RayQuery *query, float u, float *t, float *v)
{
    if (!(u >= -PATCH_OVERLAP && u <= 1.0f + PATCH_OVERLAP))
        return false;
    Vec3 from = vec3_lerp(q->p00, q->p10, u);
    Vec3 along = vec3_sub(vec3_lerp(q->p01, q->p11, u), from);
    Vec3 delta = vec3_sub(from, query->o);
    Vec3 across = vec3_cross(query->d, along);
    float square = vec3_dot(across, across);
    *v = vec3_dot(delta, vec3_cross(query->d, across)) / square;
    *t = vec3_dot(delta, vec3_cross(along, across)) / square;
    if (!(*v >= -PATCH_OVERLAP && *v <= 1.0f + PATCH_OVERLAP && *t > 0.0f && *t < query->t_max))
        return false;
    Vec3 dpdu = patch_dpdu(q, *v), dpdv = patch_dpdv(q, u), normal = vec3_cross(dpdu, dpdv);
    float size = vec3_length(dpdu) * vec3_length(dpdv);
    float reach = ray_query_reach(query, *t) + patch_size(q);
    float tolerance = size * (12.0f * FLOAT_EPSILON * reach + vec3_max_abs(query->error));
    return ray_query_clear(query, *t, float_abs(vec3_dot(normal, query->d)), tolerance);
}

/* The first hit with 0 < t < t_max. */
SHARED_FUNCTION bool patch_query(const PatchCorners *q, const RayQuery *query, float *t, float *u, float *v)
{
    Vec3 d = query->d;
    float a = vec3_dot(vec3_cross(vec3_sub(q->p10, q->p00), vec3_sub(q->p01, q->p11)), d);
    float c = vec3_dot(vec3_cross(vec3_sub(q->p00, query->o), d), vec3_sub(q->p01, q->p00));
    float b = vec3_dot(vec3_cross(vec3_sub(q->p10, query->o), d), vec3_sub(q->p11, q->p10)) - (a + c);
    float roots[2] = {0.0f, 0.0f};
    uint count = quadratic_roots(a, b, c, &roots[0], &roots[1]);
    bool found = false;
    for (uint i = 0; i < count; ++i) {
        float t_line, v_line;
        if (!patch_query_line(q, query, roots[i], &t_line, &v_line) || (found && t_line >= *t))
            continue;
        found = true;
        *t = t_line;
        *u = float_clamp(roots[i], 0.0f, 1.0f);
        *v = float_clamp(v_line, 0.0f, 1.0f);
    }
    return found;
}

#endif
