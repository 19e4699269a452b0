/* Maps that take uniform points of the unit square to the stated densities on disks, triangles and directions, and the
 * two image parametrisations of the sphere. Directions are unit vectors in a frame with z up.
 *
 * The disk, the triangle, cones narrower than the whole sphere and the octahedral map are continuous with bounded
 * distortion: a small step in the square is a small step in the target, as mutations of Markov chains require. The
 * cosine hemisphere is continuous, but steep at its rim; warp_sphere and the equirectangular map have a seam and
 * poles. */
#ifndef TWINLIGHT_MATH_WARP_H
#define TWINLIGHT_MATH_WARP_H

#include "math/elementary.h"
#include "math/vec.h"

/* A uniform point of the unit disk, density 1/pi (Shirley and Chiu, "A low distortion map between disk and square",
 * 1997). *radius: its distance from the centre, free of the rounding errors of the coordinates. */
SHARED_FUNCTION Vec2 warp_disk_polar(Vec2 u, float *radius)
{
    float a = 2.0f * u.x - 1.0f;
    float b = 2.0f * u.y - 1.0f;
    bool wide = float_abs(a) > float_abs(b);
    float r = wide ? a : b;
    float ratio = r == 0.0f ? 0.0f : (wide ? b : a) / r;
    float s, c;
    float_sincos(PI_OVER_4 * ratio, &s, &c);
    *radius = float_abs(r);
    return wide ? vec2(r * c, r * s) : vec2(r * s, r * c);
}

/* A uniform point of the unit disk; density 1/pi. */
SHARED_FUNCTION Vec2 warp_disk_concentric(Vec2 u)
{
    float radius;
    return warp_disk_polar(u, &radius);
}

/* The inverse of warp_disk_polar: the point of the square that maps to d, which may lie outside the disk by rounding;
 * the middle for d = 0. */
SHARED_FUNCTION Vec2 warp_disk_inverse(Vec2 d)
{
    bool wide = float_abs(d.x) > float_abs(d.y);
    float along = wide ? d.x : d.y, across = wide ? d.y : d.x;
    float r = float_copy_sign(float_min(float_sqrt(d.x * d.x + d.y * d.y), 1.0f), along);
    float angle = r == 0.0f ? 0.0f : float_atan2(float_copy_sign(1.0f, along) * across, float_abs(along));
    float other = r * (angle * (4.0f * INV_PI));
    return vec2(0.5f * ((wide ? r : other) + 1.0f), 0.5f * ((wide ? other : r) + 1.0f));
}

/* A direction with density cos(theta)/pi (Malley). cos(theta) > 0 for u from random_float. */
SHARED_FUNCTION Vec3 warp_cosine_hemisphere(Vec2 u)
{
    float r;
    Vec2 d = warp_disk_polar(u, &r);
    return vec3(d.x, d.y, float_sqrt((1.0f - r) * (1.0f + r)));
}

SHARED_FUNCTION float warp_cosine_hemisphere_pdf(float cos_theta)
{
    return float_max(cos_theta, 0.0f) * INV_PI;
}

/* A uniform direction; density INV_4PI. */
SHARED_FUNCTION Vec3 warp_sphere(Vec2 u)
{
    float r = 2.0f * float_sqrt(u.x * (1.0f - u.x));
    float s, c;
    float_sincos(2.0f * PI * u.y, &s, &c);
    return vec3(r * c, r * s, 1.0f - 2.0f * u.x);
}

/* A direction uniform in solid angle in the cone around +z with 1 - cos(theta) <= one_minus_cos_max; the whole sphere
 * for 2. Mapped through the disk, whose areas are proportional to 1 - cos: z = 1 - r^2 (1 - cos_max). Nothing cancels,
 * so cones of any size keep their full precision. */
SHARED_FUNCTION Vec3 warp_cone(Vec2 u, float one_minus_cos_max)
{
    float r;
    Vec2 d = warp_disk_polar(u, &r);
    float one_minus_cos = r * r * one_minus_cos_max;
    float scale = float_sqrt(one_minus_cos_max * (2.0f - one_minus_cos));
    return vec3(d.x * scale, d.y * scale, 1.0f - one_minus_cos);
}

SHARED_FUNCTION float warp_cone_pdf(float one_minus_cos_max)
{
    return INV_2PI / one_minus_cos_max;
}

/* Barycentric weights (b1, b2) of the second and third vertex, uniform in the triangle; density 1 / area
 * (Heitz, "A low-distortion map between triangle and square", 2019). */
SHARED_FUNCTION Vec2 warp_triangle(Vec2 u)
{
    if (u.y > u.x) {
        float b1 = 0.5f * u.x;
        return vec2(b1, u.y - b1);
    }
    float b2 = 0.5f * u.y;
    return vec2(u.x - b2, b2);
}

/* ---- the sphere as a square: pbrt-v4's equal-area octahedral map ----------------------------------------------- */

/* Uniform uv gives uniform directions; density over solid angle INV_4PI. +z is the middle of the square, -z its
 * corners, +x the middle of the edge u = 1 (Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD", JGT
 * 13(3), 2008). */
SHARED_FUNCTION Vec3 octahedral_to_sphere(Vec2 uv)
{
    float u = 2.0f * uv.x - 1.0f;
    float v = 2.0f * uv.y - 1.0f;
    float au = float_abs(u), av = float_abs(v);
    float distance = 1.0f - (au + av); /* from the inner diamond, which is the equator */
    float r = 1.0f - float_abs(distance);
    float ratio = r == 0.0f ? 0.0f : (av - au) / r;
    float s, c;
    float_sincos(PI_OVER_4 * (ratio + 1.0f), &s, &c);
    float horizontal = r * float_sqrt(2.0f - r * r);
    return vec3(float_copy_sign(horizontal * c, u), float_copy_sign(horizontal * s, v),
                float_copy_sign(1.0f - r * r, distance));
}

/* The inverse; d must be a unit vector. 1 - |z| is computed from x and y, which keeps the poles precise. */
SHARED_FUNCTION Vec2 sphere_to_octahedral(Vec3 d)
{
    float ax = float_abs(d.x), ay = float_abs(d.y), az = float_abs(d.z);
    float r = float_min(float_sqrt((ax * ax + ay * ay) / (1.0f + az)), 1.0f);
    float v = r * (float_atan2(ay, ax) * (2.0f * INV_PI));
    float u = r - v;
    if (d.z < 0.0f) {
        float swap = u;
        u = 1.0f - v;
        v = 1.0f - swap;
    }
    return vec2(0.5f * (1.0f + float_copy_sign(u, d.x)), 0.5f * (1.0f + float_copy_sign(v, d.y)));
}

/* ---- the sphere as a latitude-longitude image ------------------------------------------------------------------ */

/* u = phi / (2 pi) with phi in [0, 2 pi) from +x towards +y, v = theta / pi with theta from +z: v = 0 is up.
 * d need not be a unit vector. */
SHARED_FUNCTION Vec2 sphere_to_equirectangular(Vec3 d)
{
    float u = float_atan2(d.y, d.x) * INV_2PI;
    u = u < 0.0f ? u + 1.0f : u;
    float v = float_atan2(float_sqrt(d.x * d.x + d.y * d.y), d.z) * INV_PI;
    return vec2(u < 1.0f ? u : 0.0f, v);
}

SHARED_FUNCTION Vec3 equirectangular_to_sphere(Vec2 uv)
{
    float sin_theta, cos_theta, sin_phi, cos_phi;
    float_sincos(PI * uv.y, &sin_theta, &cos_theta);
    float_sincos(2.0f * PI * uv.x, &sin_phi, &cos_phi);
    return vec3(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta);
}

/* Solid-angle density of the direction that a uniform uv maps to: the factor that turns a density over the square into
 * one over solid angle. Infinite at the poles of the map; callers treat a non-finite density as 0. d must be a unit
 * vector. */
SHARED_FUNCTION float equirectangular_pdf(Vec3 d)
{
    return 0.5f * INV_PI * INV_PI / float_sqrt(d.x * d.x + d.y * d.y);
}

#endif
