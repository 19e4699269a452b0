/* The inverse of bsdf_sample_base: which numbers draw a given direction. */
#ifndef TWINLIGHT_BSDF_INVERT_H
#define TWINLIGHT_BSDF_INVERT_H

#include "bsdf/bsdf.h"

/* The numbers with which a lobe draws a direction, once the lobe is chosen, and their density: pdf_w is that of the
 * lobe alone, without the probability of choosing it. */
typedef struct BsdfInverse {
    Vec2 u; /* u of bsdf_sample_base, or its u_base if `base` */
    float pdf_w;
    bool base;
} BsdfInverse;

SHARED_FUNCTION bool cosine_invert(Vec3 wi, BsdfInverse *inverse)
{
    inverse->u = warp_disk_inverse(vec2(wi.x, wi.y));
    inverse->pdf_w = float_abs(wi.z) * INV_PI;
    inverse->base = true;
    return true;
}

/* Microfacet reflection from wo to wi, both with z > 0. */
SHARED_FUNCTION bool reflection_invert(const Bsdf *bsdf, Vec3 wo, Vec3 wi, BsdfInverse *inverse)
{
    Vec3 h = vec3_add(wo, wi);
    inverse->u = ggx_invert_visible(wo, h, bsdf->alpha_x, bsdf->alpha_y);
    inverse->pdf_w =
        0.5f * ggx_density(h, bsdf->alpha_x, bsdf->alpha_y) / (wo.z + ggx_root(wo, bsdf->alpha_x, bsdf->alpha_y));
    inverse->base = false;
    return true;
}

SHARED_FUNCTION bool coated_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                   BsdfInverse *inverse)
{
    float t_o;
    if (!(u_lobe < coated_specular(scene, bsdf, wo, &t_o)))
        return cosine_invert(wi, inverse);
    return coated_is_rough(scene, bsdf) && reflection_invert(bsdf, wo, wi, inverse);
}

/* Given u_lobe, exactly the microfacets whose reflectance exceeds u_lobe reflect, so no density contains the
 * probability of the choice. */
SHARED_FUNCTION bool dielectric_invert(const Bsdf *bsdf, float eta, Vec3 wo, Vec3 wi, float u_lobe,
                                       BsdfInverse *inverse)
{
    bool reflected = wi.z > 0.0f;
    Vec3 h = reflected ? vec3_add(wo, wi) : vec3_mad(wo, eta, wi);
    float length = vec3_length(h);
    if (!(length > 0.0f))
        return false;
    h = vec3_scale(h, (h.z < 0.0f ? -1.0f : 1.0f) / length);
    float cos_o = vec3_dot(wo, h), cos_i = vec3_dot(wi, h);
    float reflectance = fresnel_dielectric(cos_o, eta);
    if (!(cos_o > 0.0f) || (cos_i > 0.0f) != reflected || (u_lobe < reflectance) != reflected)
        return false;
    if (reflected)
        return reflection_invert(bsdf, wo, wi, inverse);
    inverse->u = ggx_invert_visible(wo, h, bsdf->alpha_x, bsdf->alpha_y);
    inverse->pdf_w = 2.0f * ggx_density(h, bsdf->alpha_x, bsdf->alpha_y) * cos_o * -cos_i * eta * eta /
                     (length * length * (wo.z + ggx_root(wo, bsdf->alpha_x, bsdf->alpha_y)));
    inverse->base = false;
    return true;
}

/* The point with which bsdf_sample_base draws wi in the lobe that u_lobe chooses. False: that lobe is a delta or cannot
 * draw wi. If several lobes can draw wi, it has other points as well. */
SHARED_FUNCTION bool bsdf_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                 BsdfInverse *inverse)
{
    if (!(float_abs(wo.z) > BSDF_COSINE_MIN && float_abs(wi.z) > BSDF_COSINE_MIN))
        return false;
    bool flip = wo.z<0.0f, same = wo.z * wi.z> 0.0f;
    Vec3 o = direction_flip(wo, flip), i = direction_flip(wi, flip);
    if (SCENE_HAS(scene, FEATURE_DIFFUSE) && bsdf->kind == MATERIAL_DIFFUSE)
        return same && cosine_invert(i, inverse);
    if (SCENE_HAS(scene, FEATURE_COATED_DIFFUSE) && bsdf->kind == MATERIAL_COATED_DIFFUSE)
        return same && coated_invert(scene, bsdf, o, i, u_lobe, inverse);
    if (SCENE_HAS(scene, FEATURE_DIFFUSE_TRANSMISSION) && bsdf->kind == MATERIAL_DIFFUSE_TRANSMISSION)
        return !diffuse_transmission_is_black(bsdf) &&
               (u_lobe < diffuse_transmission_reflect_probability(bsdf)) == same && cosine_invert(i, inverse);
    if (!SCENE_HAS(scene, FEATURE_ROUGH) || (bsdf->flags & BSDF_ROUGH) == 0u)
        return false;
    if (SCENE_HAS(scene, FEATURE_CONDUCTOR) && bsdf->kind == MATERIAL_CONDUCTOR)
        return same && reflection_invert(bsdf, o, i, inverse);
    if (SCENE_HAS(scene, FEATURE_DIELECTRIC) && bsdf->kind == MATERIAL_DIELECTRIC)
        return dielectric_invert(bsdf, dielectric_relative_eta(bsdf->eta, wo), o, i, u_lobe, inverse);
    return false;
}

#endif
