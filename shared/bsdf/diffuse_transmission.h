/* Lambertian reflection (color0) and Lambertian transmission (color1), as pbrt-v4's diffusetransmission. */
#ifndef TWINLIGHT_BSDF_DIFFUSE_TRANSMISSION_H
#define TWINLIGHT_BSDF_DIFFUSE_TRANSMISSION_H

#include "bsdf/lobe.h"

/* Probability of sampling reflection, by the largest components. The two colours must not both be black. */
SHARED_FUNCTION float diffuse_transmission_reflect_probability(const Bsdf *bsdf)
{
    float reflected = vec3_max_component(bsdf->color0);
    float transmitted = vec3_max_component(bsdf->color1);
    return reflected / (reflected + transmitted);
}

SHARED_FUNCTION bool diffuse_transmission_is_black(const Bsdf *bsdf)
{
    return !(vec3_max_component(bsdf->color0) + vec3_max_component(bsdf->color1) > 0.0f);
}

SHARED_FUNCTION BsdfValue diffuse_transmission_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    BsdfValue value = bsdf_value_zero();
    if (diffuse_transmission_is_black(bsdf))
        return value;
    bool reflected = wo.z * wi.z > 0.0f;
    float reflect_probability = diffuse_transmission_reflect_probability(bsdf);
    float probability = reflected ? reflect_probability : 1.0f - reflect_probability;
    Vec3 color = reflected ? bsdf->color0 : bsdf->color1;
    value.f_cos = vec3_scale(color, float_abs(wi.z) * INV_PI);
    value.pdf_w = probability * float_abs(wi.z) * INV_PI;
    value.pdf_rev_w = probability * float_abs(wo.z) * INV_PI;
    return value;
}

SHARED_FUNCTION bool diffuse_transmission_sample(const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u, BsdfSample *sample)
{
    if (diffuse_transmission_is_black(bsdf))
        return false;
    Vec3 wi = warp_cosine_hemisphere(u);
    if (!(wi.z > BSDF_COSINE_MIN))
        return false;
    float reflect_probability = diffuse_transmission_reflect_probability(bsdf);
    bool reflected = u_lobe < reflect_probability;
    float probability = reflected ? reflect_probability : 1.0f - reflect_probability;
    Vec3 color = reflected ? bsdf->color0 : bsdf->color1;
    wi = direction_flip(wi, (wo.z < 0.0f) == reflected);
    bsdf_sample_set(sample, wi, vec3_scale(color, 1.0f / probability), diffuse_transmission_eval(bsdf, wo, wi));
    sample->transmitted = reflected ? 0u : 1u;
    return true;
}

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

SHARED_FUNCTION BsdfValue bsdf_diffuse_transmission_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                         uint transport)
{
    (void)scene;
    (void)transport;
    return diffuse_transmission_eval(bsdf, wo, wi);
}

SHARED_FUNCTION bool bsdf_diffuse_transmission_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                                      BsdfSample *sample)
{
    (void)scene;
    return diffuse_transmission_sample(bsdf, wo, draw.u_lobe, draw.u_base, sample);
}

SHARED_FUNCTION bool bsdf_diffuse_transmission_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                      float u_lobe, BsdfInverse *inverse)
{
    (void)scene;
    bool flip = wo.z<0.0f, same = wo.z * wi.z> 0.0f;
    return !diffuse_transmission_is_black(bsdf) && (u_lobe < diffuse_transmission_reflect_probability(bsdf)) == same &&
           cosine_invert(direction_flip(wi, flip), inverse);
}

#endif
