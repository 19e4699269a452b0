/* Curves: cubic Bezier segments that look from everywhere like a band of their width which faces the ray, as pbrt-v4's
 * curves of the types flat and cylinder. Parameters: u along the segment, v across it, 0.5 on the axis.
 *
 * The test of a ray goes down a binary tree of intervals of u until the segment is almost straight there, seen along
 * the ray; a hit is where the axis comes closest to the ray, if that is within half the width (Nakamaru and Ohno, "Ray
 * tracing for curves primitive", WSCG 2002).
 *
 * A band that faces every ray has no normal. So paths that hit a curve go on from its axis, and what they need of a
 * normal is in surface.h. A ray does not hit a curve that contains one of its ends: where the axis comes closest, the
 * ends must be further from it than half the width. That holds for either direction of a ray, and keeps a ray from
 * hitting the curve that it leaves or goes to. */
#ifndef TWINLIGHT_GEOMETRY_CURVE_H
#define TWINLIGHT_GEOMETRY_CURVE_H

#include "geometry/ray.h"
#include "layout/scene_types.h"
#include "layout/scene_view.h"

/* Flatness of the intervals at which the subdivision stops, relative to the width, as in pbrt-v4. */
#define CURVE_FLATNESS 0.05f

/* Levels of the subdivision of one primitive. */
#define CURVE_DEPTH_MAX 8u

/* By how much an interval may be left at its ends, relative to half the width: neighbours overlap by that much, so that
 * no ray slips through between them by rounding. */
#define CURVE_OVERLAP 1e-3f

/* How far rays must start from the axis, relative to half the width, to hit the curve there. */
#define CURVE_CLEARANCE 1.01f

/* Rounding of points of a curve and of rays in its test, in units of FLOAT_EPSILON times their largest coordinate. */
#define CURVE_ULPS 32.0f

/* Control points. In the space of a ray: x and y across it, z the distance along it. */
typedef struct Bezier {
    Vec3 p[4];
} Bezier;

SHARED_FUNCTION Bezier curve_bezier(__global const Curve *curve)
{
    Bezier bezier;
    for (uint i = 0u; i < 4u; ++i)
        bezier.p[i] = curve->p[i];
    return bezier;
}

/* The polar form (blossom) of the segment: with equal arguments, its point there. */
SHARED_FUNCTION Vec3 bezier_blossom(const Bezier *b, float u0, float u1, float u2)
{
    Vec3 q0 = vec3_lerp(b->p[0], b->p[1], u0), q1 = vec3_lerp(b->p[1], b->p[2], u0),
         q2 = vec3_lerp(b->p[2], b->p[3], u0);
    return vec3_lerp(vec3_lerp(q0, q1, u1), vec3_lerp(q1, q2, u1), u2);
}

/* The part of the segment between two parameters. */
SHARED_FUNCTION Bezier bezier_part(const Bezier *b, float u0, float u1)
{
    Bezier part;
    part.p[0] = bezier_blossom(b, u0, u0, u0);
    part.p[1] = bezier_blossom(b, u0, u0, u1);
    part.p[2] = bezier_blossom(b, u0, u1, u1);
    part.p[3] = bezier_blossom(b, u1, u1, u1);
    return part;
}

/* The derivative; where it vanishes, as at a cusp, the chord. */
SHARED_FUNCTION Vec3 bezier_derivative(const Bezier *b, float u)
{
    Vec3 q0 = vec3_lerp(b->p[0], b->p[1], u), q1 = vec3_lerp(b->p[1], b->p[2], u), q2 = vec3_lerp(b->p[2], b->p[3], u);
    Vec3 d = vec3_sub(vec3_lerp(q1, q2, u), vec3_lerp(q0, q1, u));
    return vec3_length_squared(d) > 0.0f ? vec3_scale(d, 3.0f) : vec3_sub(b->p[3], b->p[0]);
}

SHARED_FUNCTION float curve_width(__global const Curve *curve, float u)
{
    return (1.0f - u) * curve->width[0] + u * curve->width[1];
}

/* The interval of u of a primitive (Primitive.b). */
SHARED_FUNCTION Vec2 curve_interval(uint piece)
{
    float step = 1.0f / (float)(1u << CURVE_LEVELS(piece)), first = (float)CURVE_INDEX(piece);
    return vec2(first * step, (first + 1.0f) * step);
}

/* ---- the ray's space --------------------------------------------------------------------------------------------- */

/* Orthonormal, right-handed: n is the direction of the ray. */
typedef struct CurveRay {
    Frame axes;
    float length; /* of the ray's direction */
    float end; /* distance of the ray's end */
    float rounding; /* CURVE_ULPS at the end of the curve that is furthest from the ray's origin */
} CurveRay;

/* The space of the ray for a curve along `chord`, which has no x in it. */
SHARED_FUNCTION CurveRay curve_ray(const RayQuery *query, Vec3 chord)
{
    CurveRay ray;
    float size = vec3_max_abs(query->d);
    Vec3 d = vec3(query->d.x / size, query->d.y / size, query->d.z / size);
    float length = vec3_length(d);
    ray.length = length * size;
    ray.end = query->t_max * ray.length;
    ray.rounding = 0.0f;
    ray.axes.n = vec3_scale(d, 1.0f / length);
    float along = vec3_max_abs(chord);
    Vec3 c = along > 0.0f ? vec3(chord.x / along, chord.y / along, chord.z / along) : chord;
    Vec3 across = vec3_cross(ray.axes.n, c);
    ray.axes.t = vec3_length_squared(across) > 1e-12f ? vec3_normalize(across) : frame_from_normal(ray.axes.n).t;
    ray.axes.b = vec3_cross(ray.axes.n, ray.axes.t);
    return ray;
}

/* Takes control points to the ray's space. */
SHARED_FUNCTION void curve_ray_enter(CurveRay *ray, const RayQuery *query, Bezier *b)
{
    float reach = vec3_max_abs(query->o);
    for (uint i = 0u; i < 4u; ++i) {
        reach = float_max(reach, vec3_max_abs(b->p[i]));
        b->p[i] = frame_to_local(ray->axes, vec3_sub(b->p[i], query->o));
    }
    ray->rounding = CURVE_ULPS * (FLOAT_EPSILON * reach + vec3_max_abs(query->error));
}

/* Whether the ray, the positive z axis up to `end`, comes within `radius` of the box of the control points. */
SHARED_FUNCTION bool curve_near(const Bezier *b, float radius, float end)
{
    Vec3 low = b->p[0], high = b->p[0];
    for (uint i = 1u; i < 4u; ++i) {
        low = vec3(float_min(low.x, b->p[i].x), float_min(low.y, b->p[i].y), float_min(low.z, b->p[i].z));
        high = vec3_max(high, b->p[i]);
    }
    return low.x <= radius && high.x >= -radius && low.y <= radius && high.y >= -radius && high.z >= -radius &&
           low.z <= end + radius;
}

/* Levels of subdivision after which parts deviate from their chords by no more than CURVE_FLATNESS width, seen along
 * the ray (Wang 1984, as cited by pbrt-v4). */
SHARED_FUNCTION uint curve_depth(const Bezier *b, float width)
{
    float bend = 0.0f;
    for (uint i = 0u; i < 2u; ++i) {
        Vec3 second = vec3_add(vec3_sub(b->p[i], vec3_scale(b->p[i + 1u], 2.0f)), b->p[i + 2u]);
        bend = float_max(bend, float_max(float_abs(second.x), float_abs(second.y)));
    }
    float ratio = 1.06066017f * bend / (CURVE_FLATNESS * width); /* sqrt(2) 6 / 8 */
    if (!(ratio > 1.0f))
        return 0u;
    uint octaves = (float_bits(ratio) >> 23) - 127u; /* each level divides by four */
    return octaves / 2u + 1u < CURVE_DEPTH_MAX ? octaves / 2u + 1u : CURVE_DEPTH_MAX;
}

/* ---- hits -------------------------------------------------------------------------------------------------------- */

/* Whether the origin of the ray's space lies within the end of the part at `from`, whose tangent leads to `to`; it may
 * be outside by `overlap`. */
SHARED_FUNCTION bool curve_end_keeps(Vec3 from, Vec3 to, float overlap)
{
    float x = to.x - from.x, y = to.y - from.y, inward = -(from.x * x + from.y * y);
    return inward >= 0.0f || inward * inward <= overlap * overlap * (x * x + y * y);
}

/* The parameter where the part comes closest to the origin across the ray: a step by Newton's method from w, where its
 * chord does. */
SHARED_FUNCTION float curve_closest(const Bezier *b, float w)
{
    w = float_clamp(w, 0.0f, 1.0f);
    Vec3 p = bezier_blossom(b, w, w, w), d = bezier_derivative(b, w);
    float square = d.x * d.x + d.y * d.y;
    return square > 0.0f ? float_clamp(w - (p.x * d.x + p.y * d.y) / square, 0.0f, 1.0f) : w;
}

/* Whether both ends of the ray are further than `radius` from the axis at p. end: its length. */
SHARED_FUNCTION bool curve_clear(Vec3 p, float square, float radius, float end)
{
    float left = end - p.z;
    return p.z > 0.0f && left > 0.0f && square + p.z * p.z > radius * radius && square + left * left > radius * radius;
}

/* Replaces *hit, at the distance *nearest, by the hit of the part b of the curve between u0 and u1, if that is
 * nearer. */
SHARED_FUNCTION void curve_part_hit(__global const Curve *curve, const CurveRay *ray, const Bezier *b, float u0,
                                    float u1, float *nearest, Hit *hit)
{
    float radius = 0.5f * float_max(curve->width[0], curve->width[1]);
    float overlap = CURVE_OVERLAP * radius + ray->rounding;
    float x = b->p[3].x - b->p[0].x, y = b->p[3].y - b->p[0].y, chord = x * x + y * y;
    if (!(chord > 0.0f) || !curve_end_keeps(b->p[0], b->p[1], overlap) || !curve_end_keeps(b->p[3], b->p[2], overlap))
        return;
    float w = curve_closest(b, -(b->p[0].x * x + b->p[0].y * y) / chord);
    float u = (1.0f - w) * u0 + w * u1, width = curve_width(curve, u);
    Vec3 p = bezier_blossom(b, w, w, w);
    float square = p.x * p.x + p.y * p.y;
    if (!(width > 0.0f && square <= 0.25f * width * width && p.z < *nearest) ||
        !curve_clear(p, square, CURVE_CLEARANCE * 0.5f * width + ray->rounding, ray->end))
        return;
    Vec3 tangent = bezier_derivative(b, w);
    float aside = float_sqrt(square) / width;
    *nearest = p.z;
    hit->u = u;
    hit->v = float_clamp(p.x * tangent.y - p.y * tangent.x > 0.0f ? 0.5f + aside : 0.5f - aside, 0.0f, 1.0f);
}

/* The first intersection of the ray with piece `piece` of the curve, with 0 < t < t_max. Sets t, u and v of *hit. */
SHARED_FUNCTION_APART bool curve_query(__global const Curve *curve, uint piece, const RayQuery *query, Hit *hit)
{
    Vec2 whole = curve_interval(piece);
    Bezier segment = curve_bezier(curve), b = bezier_part(&segment, whole.x, whole.y);
    CurveRay ray = curve_ray(query, vec3_sub(b.p[3], b.p[0]));
    curve_ray_enter(&ray, query, &b);
    float width = float_max(curve_width(curve, whole.x), curve_width(curve, whole.y));
    float nearest = ray.end, reach = 0.5f * width + ray.rounding;
    uint depth = curve_depth(&b, width), level = 0u, index = 0u;
    for (;;) {
        float step = 1.0f / (float)(1u << level), w0 = (float)index * step, w1 = w0 + step;
        Bezier part = level == 0u ? b : bezier_part(&b, w0, w1);
        bool near = curve_near(&part, reach, nearest);
        if (near && level < depth) {
            ++level;
            index *= 2u;
            continue;
        }
        if (near)
            curve_part_hit(curve, &ray, &part, (1.0f - w0) * whole.x + w0 * whole.y,
                           (1.0f - w1) * whole.x + w1 * whole.y, &nearest, hit);
        for (; level > 0u && (index & 1u) != 0u; --level)
            index >>= 1u;
        if (level == 0u)
            break;
        ++index;
    }
    hit->t = nearest / ray.length;
    return nearest < ray.end && hit->t > 0.0f && hit->t < query->t_max;
}

/* ---- normals of points on curves --------------------------------------------------------------------------------- */

/* A curve faces every ray. In place of the geometric normal its points have the tangent times this. */
#define FIBRE_NORMAL 2.0f

/* Whether the geometric normal is that of a point on a curve. */
SHARED_FUNCTION bool normal_is_fibre(const SceneView *scene, Vec3 ng)
{
    return SCENE_HAS(scene, FEATURE_CURVE) && vec3_length_squared(ng) > 2.0f;
}

/* |cosine| between the unit direction w and the normal of a curve that faces it. */
SHARED_FUNCTION float fibre_cosine(Vec3 w, Vec3 ng)
{
    float along = vec3_dot(w, ng) / FIBRE_NORMAL;
    return float_sqrt(float_max((1.0f - along) * (1.0f + along), 0.0f));
}

#endif
