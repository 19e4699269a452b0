/* Dielectric interface: smooth, or GGX microfacets that reflect and refract (Walter et al. 2007, "Microfacet Models for
 * Refraction through Rough Surfaces").
 *
 * Every function turns the surface so that wo.z > 0; eta is then the index of the other side over that of wo's side. */
#ifndef TWINLIGHT_BSDF_DIELECTRIC_H
#define TWINLIGHT_BSDF_DIELECTRIC_H

#include "bsdf/lobe.h"
#include "bsdf/fresnel.h"

SHARED_FUNCTION float dielectric_relative_eta(float eta, Vec3 wo)
{
    return wo.z > 0.0f ? eta : 1.0f / eta;
}

/* Radiance is scaled by eta^2 when it enters a medium of relative index eta. That which goes from wi to wo comes out of
 * that medium, so its factor is 1 / eta^2 (Veach 1997, section 5.2). Importance is not scaled. */
SHARED_FUNCTION float refraction_scale(float eta, uint transport)
{
    return transport == TRANSPORT_RADIANCE ? 1.0f / (eta * eta) : 1.0f;
}

SHARED_FUNCTION bool dielectric_smooth_sample(const Bsdf *bsdf, Vec3 wo, float u_lobe, uint transport,
                                              BsdfSample *sample)
{
    float eta = dielectric_relative_eta(bsdf->eta, wo);
    float cos_o = float_abs(wo.z);
    float reflectance = fresnel_dielectric(cos_o, eta);
    if (u_lobe < reflectance) {
        bsdf_sample_set_delta(sample, vec3(-wo.x, -wo.y, wo.z), vec3_splat(1.0f), reflectance);
        return true;
    }
    float cos_t = refraction_cosine(cos_o, eta);
    if (!(cos_t > BSDF_COSINE_MIN))
        return false;
    Vec3 wi = vec3_normalize(vec3(-wo.x / eta, -wo.y / eta, wo.z > 0.0f ? -cos_t : cos_t));
    bsdf_sample_set_delta(sample, wi, vec3_splat(refraction_scale(eta, transport)), 1.0f - reflectance);
    sample->transmitted = 1u;
    sample->eta = eta;
    return true;
}

/* Reflection by the microfacets of an interface, for o.z, i.z > 0. Reflection is chosen with probability F, so both
 * densities contain F too. */
SHARED_FUNCTION BsdfValue dielectric_reflection_eval(float alpha_x, float alpha_y, float eta, Vec3 o, Vec3 i)
{
    Vec3 h = vec3_add(o, i);
    float reflectance = fresnel_dielectric(float_min(0.5f * vec3_length(h), 1.0f), eta);
    float density = 0.5f * reflectance * ggx_density(h, alpha_x, alpha_y);
    float root_o = ggx_root(o, alpha_x, alpha_y);
    float root_i = ggx_root(i, alpha_x, alpha_y);
    BsdfValue value;
    value.f_cos = vec3_splat(density * i.z / (root_o * i.z + root_i * o.z));
    value.pdf_w = density / (o.z + root_o);
    value.pdf_rev_w = density / (i.z + root_i);
    return value;
}

/* Refraction for o.z > 0 > i.z (Walter et al. 2007, eq. 17 and 21). The half vector h = o + eta i is parallel to the
 * microfacet's normal m, and o.m + eta i.m = -+|h|, so the Jacobian is eta^2 |i.m| / |h|^2. Without the factor eta^2
 * the expression is that of radiance. */
SHARED_FUNCTION BsdfValue dielectric_refraction_eval(float alpha_x, float alpha_y, float eta, Vec3 o, Vec3 i,
                                                     uint transport)
{
    BsdfValue value = bsdf_value_zero();
    Vec3 h = vec3_mad(o, eta, i);
    float length_squared = vec3_length_squared(h);
    if (!(length_squared > 0.0f))
        return value;
    float to_m = (h.z < 0.0f ? -1.0f : 1.0f) / float_sqrt(length_squared);
    float cos_o = vec3_dot(o, h) * to_m;
    float cos_i = -vec3_dot(i, h) * to_m;
    if (!(cos_o > 0.0f && cos_i > 0.0f && h.z != 0.0f))
        return value; /* one of the directions lies behind the microfacet */
    float transmittance = 1.0f - fresnel_from_cosines(cos_o, cos_i, eta);
    float density = 2.0f * transmittance * ggx_density(h, alpha_x, alpha_y) * cos_o * cos_i / length_squared;
    float root_o = ggx_root(o, alpha_x, alpha_y);
    float root_i = ggx_root(i, alpha_x, alpha_y);
    float eta2 = eta * eta;
    value.pdf_w = density * eta2 / (o.z + root_o);
    value.pdf_rev_w = density / (root_i - i.z);
    if (transport == TRANSPORT_IMPORTANCE)
        density *= eta2;
    value.f_cos = vec3_splat(density * -i.z / (root_i * o.z - root_o * i.z));
    return value;
}

SHARED_FUNCTION BsdfValue dielectric_rough_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi, uint transport)
{
    bool flip = wo.z < 0.0f;
    float eta = dielectric_relative_eta(bsdf->eta, wo);
    Vec3 o = direction_flip(wo, flip);
    Vec3 i = direction_flip(wi, flip);
    if (i.z > 0.0f)
        return dielectric_reflection_eval(bsdf->alpha_x, bsdf->alpha_y, eta, o, i);
    return dielectric_refraction_eval(bsdf->alpha_x, bsdf->alpha_y, eta, o, i, transport);
}

/* Draws a microfacet visible from o (o.z > 0) and scatters there: reflects if u_lobe is below its reflectance, else
 * refracts. False if *i lies on the wrong side of the surface. */
SHARED_FUNCTION bool dielectric_scatter(float alpha_x, float alpha_y, float eta, Vec3 o, float u_lobe, Vec2 u, Vec3 *i)
{
    Vec3 m = ggx_sample_visible(o, alpha_x, alpha_y, u);
    float cos_o = vec3_dot(o, m);
    if (!(cos_o > 0.0f))
        return false;
    float cos_t = refraction_cosine(cos_o, eta);
    float reflectance = cos_t < 0.0f ? 1.0f : fresnel_from_cosines(cos_o, cos_t, eta);
    if (u_lobe < reflectance) {
        *i = vec3_mad(vec3_negate(o), 2.0f * cos_o, m);
        return i->z > BSDF_COSINE_MIN;
    }
    if (cos_t < 0.0f)
        return false;
    *i = vec3_normalize(vec3_mad(vec3_scale(o, -1.0f / eta), cos_o / eta - cos_t, m));
    return i->z < -BSDF_COSINE_MIN;
}

/* weight = G2 / G1: F cancels against the probability of the choice. */
SHARED_FUNCTION bool dielectric_rough_sample(const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u, uint transport,
                                             BsdfSample *sample)
{
    bool flip = wo.z < 0.0f;
    float eta = dielectric_relative_eta(bsdf->eta, wo);
    Vec3 o = direction_flip(wo, flip);
    Vec3 i;
    if (!dielectric_scatter(bsdf->alpha_x, bsdf->alpha_y, eta, o, u_lobe, u, &i))
        return false;
    bool refracted = i.z < 0.0f;
    BsdfValue value = dielectric_rough_eval(bsdf, wo, direction_flip(i, flip), transport);
    if (!(value.pdf_w > 0.0f))
        return false; /* rounding moved the half vector across a boundary */
    float weight = ggx_shadowing(o.z, ggx_root(o, bsdf->alpha_x, bsdf->alpha_y), float_abs(i.z),
                                 ggx_root(i, bsdf->alpha_x, bsdf->alpha_y));
    if (refracted)
        weight *= refraction_scale(eta, transport);
    bsdf_sample_set(sample, direction_flip(i, flip), vec3_splat(weight), value);
    if (refracted) {
        sample->transmitted = 1u;
        sample->eta = eta;
    }
    return true;
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

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

SHARED_FUNCTION BsdfValue bsdf_dielectric_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                               uint transport)
{
    return bsdf_is_rough(scene, bsdf) ? dielectric_rough_eval(bsdf, wo, wi, transport) : bsdf_value_zero();
}

SHARED_FUNCTION bool bsdf_dielectric_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u,
                                            Vec2 u_base, uint transport, BsdfSample *sample)
{
    (void)u_base;
    return bsdf_is_rough(scene, bsdf) ? dielectric_rough_sample(bsdf, wo, u_lobe, u, transport, sample)
                                      : dielectric_smooth_sample(bsdf, wo, u_lobe, transport, sample);
}

SHARED_FUNCTION bool bsdf_dielectric_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                            BsdfInverse *inverse)
{
    bool flip = wo.z < 0.0f;
    return bsdf_is_rough(scene, bsdf) &&
           dielectric_invert(bsdf, dielectric_relative_eta(bsdf->eta, wo), direction_flip(wo, flip),
                             direction_flip(wi, flip), u_lobe, inverse);
}

#endif
