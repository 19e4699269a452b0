/* The phase function of Henyey and Greenstein ("Diffuse radiation in the galaxy", 1941) as a Bsdf of kind
 * MATERIAL_PHASE: what scatters at a vertex in a medium. Its frame has the direction wo, from which the light is seen,
 * as z axis. With q = 1 - cos of the angle between wi and the foremost direction, which is -wo for g > 0 and wo for g <
 * 0, its density is (1 - g^2) / (4 pi ((1 - |g|)^2 + 2 |g| q)^(3/2)): nothing cancels, whatever g is. */
#ifndef TWINLIGHT_BSDF_PHASE_H
#define TWINLIGHT_BSDF_PHASE_H

#include "bsdf/lobe.h"

/* The kind of such a Bsdf, of which there is no material. */
#define MATERIAL_PHASE ((uint)MATERIAL_KINDS)

/* color0.x is g. */
SHARED_FUNCTION Bsdf phase_bsdf(float g)
{
    Bsdf bsdf = {0};
    bsdf.kind = MATERIAL_PHASE;
    bsdf.color0 = vec3(g, 0.0f, 0.0f);
    bsdf.eta = 1.0f;
    bsdf.coat_table = NONE;
    return bsdf;
}

SHARED_FUNCTION float phase_density(float g, float q)
{
    float a = float_abs(g), square = (1.0f - a) * (1.0f - a) + 2.0f * a * q;
    return INV_4PI * ((1.0f - a) * (1.0f + a)) / (square * float_sqrt(square));
}

/* 1 - cos of the angle between wi (unit) and the foremost direction; half the squared distance between the two, which
 * is precise for small angles, too. */
SHARED_FUNCTION float phase_versine(float g, Vec3 wi)
{
    float z = g > 0.0f ? wi.z + 1.0f : wi.z - 1.0f;
    return 0.5f * (wi.x * wi.x + wi.y * wi.y + z * z);
}

SHARED_FUNCTION_APART BsdfValue phase_eval(float g, Vec3 wi)
{
    BsdfValue value;
    value.pdf_w = phase_density(g, phase_versine(g, wi));
    value.pdf_rev_w = value.pdf_w;
    value.f_cos = vec3_splat(value.pdf_w);
    return value;
}

/* Draws wi by inverting the distribution of q, through a disk as warp_cone does: with r^2 uniform, q = r^2 m and
 * m = (1 - |g|)^2 (1 + |g| + d) / d^2, where d = 1 + |g| - 2 |g| r^2. */
SHARED_FUNCTION_APART BsdfSample phase_sample(float g, Vec2 u)
{
    float a = float_abs(g), r;
    Vec2 disk = warp_disk_polar(u, &r);
    float d = (1.0f - a) + 2.0f * a * ((1.0f - r) * (1.0f + r)), part = (1.0f - a) / d;
    float m = part * part * (1.0f + a + d), q = float_min(r * r * m, 2.0f), across = float_sqrt(m * (2.0f - q));
    Vec3 wi = vec3(disk.x * across, disk.y * across, g > 0.0f ? q - 1.0f : 1.0f - q);
    BsdfSample sample;
    BsdfValue value;
    value.pdf_w = phase_density(g, q);
    value.pdf_rev_w = value.pdf_w;
    value.f_cos = vec3_splat(value.pdf_w);
    bsdf_sample_set(&sample, wi, vec3_splat(1.0f), value);
    return sample;
}

#endif
