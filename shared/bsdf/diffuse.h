/* Lambertian reflection on the side that light comes from. */
#ifndef TWINLIGHT_BSDF_DIFFUSE_H
#define TWINLIGHT_BSDF_DIFFUSE_H

#include "bsdf/lobe.h"

SHARED_FUNCTION BsdfValue diffuse_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    BsdfValue value = bsdf_value_zero();
    if (!(wo.z * wi.z > 0.0f))
        return value;
    value.pdf_w = float_abs(wi.z) * INV_PI;
    value.pdf_rev_w = float_abs(wo.z) * INV_PI;
    value.f_cos = vec3_scale(bsdf->color0, value.pdf_w);
    return value;
}

SHARED_FUNCTION bool diffuse_sample(const Bsdf *bsdf, Vec3 wo, Vec2 u, BsdfSample *sample)
{
    Vec3 wi = warp_cosine_hemisphere(u);
    if (!(wi.z > BSDF_COSINE_MIN))
        return false;
    wi = direction_flip(wi, wo.z < 0.0f);
    bsdf_sample_set(sample, wi, bsdf->color0, diffuse_eval(bsdf, wo, wi));
    return true;
}

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

SHARED_FUNCTION BsdfValue bsdf_diffuse_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, uint transport)
{
    (void)scene;
    (void)transport;
    return diffuse_eval(bsdf, wo, wi);
}

SHARED_FUNCTION bool bsdf_diffuse_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                         BsdfSample *sample)
{
    (void)scene;
    return diffuse_sample(bsdf, wo, draw.u_base, sample);
}

SHARED_FUNCTION bool bsdf_diffuse_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                         BsdfInverse *inverse)
{
    (void)scene;
    (void)bsdf;
    (void)u_lobe;
    bool flip = wo.z < 0.0f;
    return wo.z * wi.z > 0.0f && cosine_invert(direction_flip(wi, flip), inverse);
}

#endif
