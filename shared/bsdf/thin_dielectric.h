/* A thin slab of dielectric, both interfaces and all reflections between them at once; the light goes straight on. */
#ifndef TWINLIGHT_BSDF_THIN_DIELECTRIC_H
#define TWINLIGHT_BSDF_THIN_DIELECTRIC_H

#include "bsdf/lobe.h"
#include "bsdf/fresnel.h"

/* R + T^2 R + T^2 R^3 + ... = 2 R / (1 + R) with T = 1 - R (Stokes 1862; the sum that pbrt-v4 uses). */
SHARED_FUNCTION bool thin_dielectric_sample(const Bsdf *bsdf, Vec3 wo, float u_lobe, BsdfSample *sample)
{
    float interface = fresnel_dielectric(float_abs(wo.z), bsdf->eta);
    float reflectance = 2.0f * interface / (1.0f + interface);
    if (u_lobe < reflectance) {
        bsdf_sample_set_delta(sample, vec3(-wo.x, -wo.y, wo.z), vec3_splat(1.0f), reflectance);
        return true;
    }
    float transmittance = (1.0f - interface) / (1.0f + interface);
    if (!(transmittance > 0.0f))
        return false;
    bsdf_sample_set_delta(sample, vec3_negate(wo), vec3_splat(1.0f), transmittance);
    sample->transmitted = 1u;
    return true;
}

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

SHARED_FUNCTION BsdfValue bsdf_thin_dielectric_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                    uint transport)
{
    (void)scene;
    (void)bsdf;
    (void)wo;
    (void)wi;
    (void)transport;
    return bsdf_value_zero();
}

SHARED_FUNCTION bool bsdf_thin_dielectric_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                                 BsdfSample *sample)
{
    (void)scene;
    return thin_dielectric_sample(bsdf, wo, draw.u_lobe, sample);
}

SHARED_FUNCTION bool bsdf_thin_dielectric_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                 float u_lobe, BsdfInverse *inverse)
{
    (void)scene;
    (void)bsdf;
    (void)wo;
    (void)wi;
    (void)u_lobe;
    (void)inverse;
    return false;
}

#endif
