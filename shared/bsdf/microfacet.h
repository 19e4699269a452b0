/* Anisotropic GGX (Trowbridge-Reitz) microfacets: density of normals, Smith masking, sampling of visible normals.
 *
 * All functions work in the frame in which the view direction w has w.z > 0, and take half vectors h of any length and
 * sign. With the "projected root" s(w) = sqrt(w.z^2 + (ax w.x)^2 + (ay w.y)^2), Smith's functions become
 *     G1(w) = 2 w.z / (w.z + s(w)),      G2(o, i) = 2 o.z i.z / (s(o) i.z + s(i) o.z)
 * (the latter is the height-correlated 1 / (1 + Lambda(o) + Lambda(i)), Heitz 2014, "Understanding the
 * Masking-Shadowing Function in Microfacet-Based BRDFs", eq. 72 and 99). Neither has a division by a cosine, so the
 * quotients that BSDFs need stay finite at grazing angles:
 *     G2 / (4 o.z i.z) = 1 / (2 (s(o) i.z + s(i) o.z)),   density of visible normals = 2 (o.m) D(m) / (o.z + s(o)). */
#ifndef TWINLIGHT_BSDF_MICROFACET_H
#define TWINLIGHT_BSDF_MICROFACET_H

#include "math/elementary.h"
#include "math/vec.h"

/* Lower bound of either alpha of a lobe that is not a delta (as in pbrt-v4), and an upper one that keeps the
 * arithmetic finite. */
#define ALPHA_MIN 1e-4f
#define ALPHA_MAX 16.0f

/* pbrt-v4's "remaproughness". */
SHARED_FUNCTION float roughness_to_alpha(float roughness)
{
    return float_sqrt(float_max(roughness, 0.0f));
}

/* s(w) of the head of this file. */
SHARED_FUNCTION float ggx_root(Vec3 w, float alpha_x, float alpha_y)
{
    float x = alpha_x * w.x;
    float y = alpha_y * w.y;
    return float_sqrt(w.z * w.z + x * x + y * y);
}

/* Fraction of reflections off visible normals that is not shadowed, G2 / G1(o), for cosines o_z, i_z > 0. */
SHARED_FUNCTION float ggx_density(Vec3 h, float alpha_x, float alpha_y)
{
    float x = h.x / alpha_x;
    float y = h.y / alpha_y;
    float ratio = vec3_length_squared(h) / (x * x + y * y + h.z * h.z);
    return ratio * ratio / (PI * alpha_x * alpha_y);
}

/* Fraction of the visible normals' reflections that is not shadowed, G2 / G1(o), for cosines o_z, i_z > 0. */
SHARED_FUNCTION float ggx_shadowing(float o_z, float root_o, float i_z, float root_i)
{
    return i_z * (o_z + root_o) / (root_o * i_z + root_i * o_z);
}

/* A normal (unit, z > 0) drawn from the density of normals visible from w (Dupuy and Benyoub 2023, "Sampling Visible
 * GGX Normals with Spherical Caps"): in the space where the surface is a hemisphere, reflections of w off it fill the
 * cap z > -w.z uniformly. The height of the cap's point is 1 - t, which keeps sqrt(1 - z^2) = sqrt(t (2 - t)) exact
 * where the point is close to the pole. */
SHARED_FUNCTION Vec3 ggx_sample_visible(Vec3 w, float alpha_x, float alpha_y, Vec2 u)
{
    Vec3 stretched = vec3_normalize(vec3(alpha_x * w.x, alpha_y * w.y, w.z));
    float t = u.y * (1.0f + stretched.z);
    float radius = float_sqrt(float_max(0.0f, t * (2.0f - t)));
    float sine, cosine;
    float_sincos(2.0f * PI * u.x, &sine, &cosine);
    float x = radius * cosine + stretched.x;
    float y = radius * sine + stretched.y;
    float z = float_max((1.0f - u.y) * (1.0f + stretched.z), 1e-7f);
    return vec3_normalize(vec3(alpha_x * x, alpha_y * y, z));
}

/* The u with which ggx_sample_visible draws h (of any length and sign). */
SHARED_FUNCTION Vec2 ggx_invert_visible(Vec3 w, Vec3 h, float alpha_x, float alpha_y)
{
    Vec3 stretched = vec3_normalize(vec3(alpha_x * w.x, alpha_y * w.y, w.z));
    Vec3 m = vec3_normalize(vec3(h.x / alpha_x, h.y / alpha_y, h.z));
    Vec3 c = vec3_mad(vec3_negate(stretched), 2.0f * vec3_dot(stretched, m), m); /* the point of the cap */
    float turn = float_atan2(c.y, c.x) * (0.5f * INV_PI);
    float t = c.z > 0.0f ? (c.x * c.x + c.y * c.y) / (1.0f + c.z) : 1.0f - c.z; /* 1 - c.z */
    return vec2(turn < 0.0f ? turn + 1.0f : turn, t / (1.0f + stretched.z));
}

#endif
