/* Conductor: a mirror, or GGX microfacets with the reflectance of a metal. Both sides reflect. */
#ifndef TWINLIGHT_BSDF_CONDUCTOR_H
#define TWINLIGHT_BSDF_CONDUCTOR_H

#include "bsdf/lobe.h"
#include "bsdf/fresnel.h"

SHARED_FUNCTION Vec3 conductor_fresnel(const Bsdf *bsdf, float cos_i)
{
    if ((bsdf->flags & BSDF_REFLECTANCE) != 0u)
        return fresnel_conductor_reflectance(cos_i, bsdf->color0);
    return fresnel_conductor_rgb(cos_i, bsdf->color0, bsdf->color1);
}

SHARED_FUNCTION bool conductor_smooth_sample(const Bsdf *bsdf, Vec3 wo, BsdfSample *sample)
{
    Vec3 weight = conductor_fresnel(bsdf, float_abs(wo.z));
    bsdf_sample_set_delta(sample, vec3(-wo.x, -wo.y, wo.z), weight, 1.0f);
    return true;
}

/* Walter et al. 2007, eq. 20, times |cos wi|, in the form of bsdf/microfacet.h. For unit directions the half vector h =
 * wo + wi has wo.h / |h| = |h| / 2, which stays accurate where both are grazing. */
SHARED_FUNCTION BsdfValue conductor_rough_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    BsdfValue value = bsdf_value_zero();
    if (!(wo.z * wi.z > 0.0f))
        return value;
    float o_z = float_abs(wo.z);
    float i_z = float_abs(wi.z);
    Vec3 h = vec3_add(wo, wi);
    float density = ggx_density(h, bsdf->alpha_x, bsdf->alpha_y);
    float root_o = ggx_root(wo, bsdf->alpha_x, bsdf->alpha_y);
    float root_i = ggx_root(wi, bsdf->alpha_x, bsdf->alpha_y);
    float cos_h = float_min(0.5f * vec3_length(h), 1.0f);
    float scale = 0.5f * density * i_z / (root_o * i_z + root_i * o_z);
    value.f_cos = vec3_scale(conductor_fresnel(bsdf, cos_h), scale);
    value.pdf_w = 0.5f * density / (o_z + root_o);
    value.pdf_rev_w = 0.5f * density / (i_z + root_i);
    return value;
}

/* weight = F G2 / G1. */
SHARED_FUNCTION bool conductor_rough_sample(const Bsdf *bsdf, Vec3 wo, Vec2 u, BsdfSample *sample)
{
    bool flip = wo.z < 0.0f;
    Vec3 w = direction_flip(wo, flip);
    Vec3 m = ggx_sample_visible(w, bsdf->alpha_x, bsdf->alpha_y, u);
    Vec3 wi = vec3_mad(vec3_negate(w), 2.0f * vec3_dot(w, m), m);
    if (!(wi.z > BSDF_COSINE_MIN))
        return false;
    BsdfValue value = conductor_rough_eval(bsdf, w, wi);
    float cos_h = float_min(0.5f * vec3_length(vec3_add(w, wi)), 1.0f);
    float shadowing =
        ggx_shadowing(w.z, ggx_root(w, bsdf->alpha_x, bsdf->alpha_y), wi.z, ggx_root(wi, bsdf->alpha_x, bsdf->alpha_y));
    bsdf_sample_set(sample, direction_flip(wi, flip), vec3_scale(conductor_fresnel(bsdf, cos_h), shadowing), value);
    return true;
}

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

SHARED_FUNCTION BsdfValue bsdf_conductor_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                              uint transport)
{
    (void)transport;
    return bsdf_is_rough(scene, bsdf) ? conductor_rough_eval(bsdf, wo, wi) : bsdf_value_zero();
}

SHARED_FUNCTION bool bsdf_conductor_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                           BsdfSample *sample)
{
    return bsdf_is_rough(scene, bsdf) ? conductor_rough_sample(bsdf, wo, draw.u, sample)
                                      : conductor_smooth_sample(bsdf, wo, sample);
}

SHARED_FUNCTION bool bsdf_conductor_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                           BsdfInverse *inverse)
{
    (void)u_lobe;
    bool flip = wo.z < 0.0f;
    return wo.z * wi.z > 0.0f && bsdf_is_rough(scene, bsdf) &&
           reflection_invert(bsdf, direction_flip(wo, flip), direction_flip(wi, flip), inverse);
}

#endif
