/* Vec2, Vec3 and orthonormal frames. Vec3 is three packed floats (12 bytes) in both languages, unlike float3. */
#ifndef TWINLIGHT_MATH_VEC_H
#define TWINLIGHT_MATH_VEC_H

#include "math/platform.h"

typedef struct Vec2 {
    float x, y;
} Vec2;

typedef struct Vec3 {
    float x, y, z;
} Vec3;

/* Orthonormal, right-handed: t x b = n. Local coordinates have n as z. */
typedef struct Frame {
    Vec3 t, b, n;
} Frame;

/* Affine map, rows of a 3x4 matrix: p' = (m[0..2].p + m[3], m[4..6].p + m[7], m[8..10].p + m[11]). */
typedef struct Affine {
    float m[12];
} Affine;

SHARED_FUNCTION Vec2 vec2(float x, float y)
{
    Vec2 v;
    v.x = x;
    v.y = y;
    return v;
}

SHARED_FUNCTION Vec3 vec3(float x, float y, float z)
{
    Vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

SHARED_FUNCTION Vec3 vec3_splat(float x)
{
    return vec3(x, x, x);
}

SHARED_FUNCTION Vec3 vec3_add(Vec3 a, Vec3 b)
{
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}

SHARED_FUNCTION Vec3 vec3_sub(Vec3 a, Vec3 b)
{
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}

SHARED_FUNCTION Vec3 vec3_mul(Vec3 a, Vec3 b)
{
    return vec3(a.x * b.x, a.y * b.y, a.z * b.z);
}

SHARED_FUNCTION Vec3 vec3_scale(Vec3 a, float s)
{
    return vec3(a.x * s, a.y * s, a.z * s);
}

/* a + s b */
SHARED_FUNCTION Vec3 vec3_mad(Vec3 a, float s, Vec3 b)
{
    return vec3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

SHARED_FUNCTION Vec3 vec3_negate(Vec3 a)
{
    return vec3(-a.x, -a.y, -a.z);
}

SHARED_FUNCTION float vec3_dot(Vec3 a, Vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

SHARED_FUNCTION Vec3 vec3_cross(Vec3 a, Vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

SHARED_FUNCTION float vec3_length_squared(Vec3 a)
{
    return vec3_dot(a, a);
}

SHARED_FUNCTION float vec3_length(Vec3 a)
{
    return float_sqrt(vec3_dot(a, a));
}

/* `a` must not be zero. */
SHARED_FUNCTION Vec3 vec3_normalize(Vec3 a)
{
    return vec3_scale(a, 1.0f / vec3_length(a));
}

SHARED_FUNCTION Vec3 vec3_lerp(Vec3 a, Vec3 b, float t)
{
    return vec3((1.0f - t) * a.x + t * b.x, (1.0f - t) * a.y + t * b.y, (1.0f - t) * a.z + t * b.z);
}

SHARED_FUNCTION float vec3_max_component(Vec3 a)
{
    return float_max(a.x, float_max(a.y, a.z));
}

SHARED_FUNCTION float vec3_mean(Vec3 a)
{
    return (a.x + a.y + a.z) * (1.0f / 3.0f);
}

SHARED_FUNCTION bool vec3_is_zero(Vec3 a)
{
    return a.x == 0.0f && a.y == 0.0f && a.z == 0.0f;
}

SHARED_FUNCTION bool vec3_finite(Vec3 a)
{
    return float_finite(a.x) && float_finite(a.y) && float_finite(a.z);
}

/* Rec. 709 luminance of linear sRGB. */
SHARED_FUNCTION float rgb_luminance(Vec3 c)
{
    return 0.212671f * c.x + 0.715160f * c.y + 0.072169f * c.z;
}

/* A frame around the unit vector n: a function of n alone, continuous except where n.z changes sign (Duff et al.,
 * "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017). */
SHARED_FUNCTION Frame frame_from_normal(Vec3 n)
{
    float sign = n.z < 0.0f ? -1.0f : 1.0f;
    float a = -1.0f / (sign + n.z);
    float b = n.x * n.y * a;
    Frame frame;
    frame.t = vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    frame.b = vec3(b, sign + n.y * n.y * a, -n.y);
    frame.n = n;
    return frame;
}

SHARED_FUNCTION Vec3 frame_to_local(Frame f, Vec3 v)
{
    return vec3(vec3_dot(v, f.t), vec3_dot(v, f.b), vec3_dot(v, f.n));
}

SHARED_FUNCTION Vec3 frame_to_world(Frame f, Vec3 v)
{
    return vec3(f.t.x * v.x + f.b.x * v.y + f.n.x * v.z, f.t.y * v.x + f.b.y * v.y + f.n.y * v.z,
                f.t.z * v.x + f.b.z * v.y + f.n.z * v.z);
}

SHARED_FUNCTION Vec3 affine_point(Affine a, Vec3 p)
{
    return vec3(a.m[0] * p.x + a.m[1] * p.y + a.m[2] * p.z + a.m[3],
                a.m[4] * p.x + a.m[5] * p.y + a.m[6] * p.z + a.m[7],
                a.m[8] * p.x + a.m[9] * p.y + a.m[10] * p.z + a.m[11]);
}

SHARED_FUNCTION Vec3 affine_vector(Affine a, Vec3 v)
{
    return vec3(a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[4] * v.x + a.m[5] * v.y + a.m[6] * v.z,
                a.m[8] * v.x + a.m[9] * v.y + a.m[10] * v.z);
}

/* Transforms a normal by the *inverse* of the map that transforms points: n' = inverse^T n. Not normalised. */
SHARED_FUNCTION Vec3 affine_normal(Affine inverse, Vec3 n)
{
    return vec3(inverse.m[0] * n.x + inverse.m[4] * n.y + inverse.m[8] * n.z,
                inverse.m[1] * n.x + inverse.m[5] * n.y + inverse.m[9] * n.z,
                inverse.m[2] * n.x + inverse.m[6] * n.y + inverse.m[10] * n.z);
}

#endif
