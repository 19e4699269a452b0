/* A dielectric coat, smooth or rough, over a Lambertian base (pbrt-v4's coateddiffuse, its medium absorbing only), in
 * closed form. Light that meets the coat from below is treated like light from above, as pbrt does.
 *
 * Derivation. Let E be irradiance from direction wi. T(wi) E passes the coat. The base reflects it with albedo rho into
 * a radiance L that is the same in all directions, because a Lambertian base forgets where light came from; of the
 * radiosity pi L the coat returns the fraction R_i to the base, which reflects it again:
 *     pi L = rho (T(wi) E + R_i pi L)   =>   L = rho T(wi) E / (pi (1 - rho R_i)).
 * Seen from outside in direction wo, radiance L inside appears as T(wo) L / eta^2: T is reciprocal, and radiance is
 * diluted by eta^2 as it leaves. With the coat's own reflection f_s,
 *     f = f_s + T(wi) T(wo) rho / (pi eta^2 (1 - rho R_i)).
 * No interreflection is left out, so this is what pbrt's random walk estimates for a smooth coat. Energy: for rho = 1
 * the second term's albedo is T(wo) T_mean / (eta^2 (1 - R_i)), and bsdf/coat.h sets 1 - R_i = T_mean / eta^2, so it is
 * T(wo): nothing is gained or lost below the coat. For a rough coat, light that single-scattering microfacets lose on
 * the inside is thus returned to the base; pbrt loses it, so its rough coats over bright bases are darker
 * (tests/bsdf/test_bsdf_coated.c prints by how much).
 *
 * Absorption in the coat (color1.x > 0) multiplies T on the way in and out and R_i by the transmittances of
 * bsdf/coat.h. */
#ifndef TWINLIGHT_BSDF_COATED_H
#define TWINLIGHT_BSDF_COATED_H

#include "bsdf/coat.h"
#include "bsdf/dielectric.h"
#include "bsdf/lobe.h"

/* T of direction w (w.z > 0); *escape: 1 - R_i, which is the same for every direction. */
SHARED_FUNCTION float coated_transmission(const SceneView *scene, const Bsdf *bsdf, Vec3 w, float *escape)
{
    if (bsdf_is_rough(scene, bsdf) && bsdf->coat_table != NONE)
        return coat_table_lookup(scene->lookup + bsdf->coat_table, bsdf->alpha_x, bsdf->alpha_y, w, escape);
    *escape = coat_smooth_escape(bsdf->eta);
    return 1.0f - fresnel_dielectric(w.z, bsdf->eta);
}

/* rho / (eta^2 (1 - rho R_i)): albedo of the base between the two crossings of the coat; R_i includes absorption. */
SHARED_FUNCTION float coated_base_channel(float rho, float eta, float escape)
{
    return rho / (eta * eta * ((1.0f - rho) + rho * escape));
}

SHARED_FUNCTION Vec3 coated_base(const Bsdf *bsdf, float interface_escape)
{
    float round_trip = bsdf->color1.x > 0.0f ? bsdf->color1.y : 1.0f;
    float escape = 1.0f - (1.0f - interface_escape) * round_trip;
    return vec3(coated_base_channel(bsdf->color0.x, bsdf->eta, escape),
                coated_base_channel(bsdf->color0.y, bsdf->eta, escape),
                coated_base_channel(bsdf->color0.z, bsdf->eta, escape));
}

/* Probability of sampling the coat's reflection from a direction with transmission `t`: its share of the albedo, (1 -
 * T) : T base T_mean, with T_mean = escape eta^2. */
SHARED_FUNCTION float coated_specular_probability(float t, float base_max, float escape_eta2)
{
    float specular = 1.0f - t;
    float diffuse = t * base_max * escape_eta2;
    float sum = specular + diffuse;
    return sum > 0.0f ? specular / sum : 1.0f;
}

/* Value for o.z, i.z > 0. */
SHARED_FUNCTION BsdfValue coated_eval_above(const SceneView *scene, const Bsdf *bsdf, Vec3 o, Vec3 i)
{
    float escape;
    float t_o = coated_transmission(scene, bsdf, o, &escape);
    float t_i = coated_transmission(scene, bsdf, i, &escape);
    Vec3 base = coated_base(bsdf, escape);
    float base_max = vec3_max_component(base);
    float escape_eta2 = escape * bsdf->eta * bsdf->eta;
    float specular_o = coated_specular_probability(t_o, base_max, escape_eta2);
    float specular_i = coated_specular_probability(t_i, base_max, escape_eta2);
    BsdfValue value;
    float absorbed = coat_absorption(bsdf->color1.x, bsdf->eta, o.z) * coat_absorption(bsdf->color1.x, bsdf->eta, i.z);
    value.f_cos = vec3_scale(base, absorbed * t_o * t_i * i.z * INV_PI);
    value.pdf_w = (1.0f - specular_o) * i.z * INV_PI;
    value.pdf_rev_w = (1.0f - specular_i) * o.z * INV_PI;
    if (bsdf_is_rough(scene, bsdf))
        coat_reflection_add(bsdf, o, i, specular_o, specular_i, &value);
    return value;
}

SHARED_FUNCTION BsdfValue coated_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    if (!(wo.z * wi.z > 0.0f))
        return bsdf_value_zero();
    bool flip = wo.z < 0.0f;
    return coated_eval_above(scene, bsdf, direction_flip(wo, flip), direction_flip(wi, flip));
}

/* coated_specular_probability of direction o, o.z > 0; *t_o: its T. */
SHARED_FUNCTION float coated_specular(const SceneView *scene, const Bsdf *bsdf, Vec3 o, float *t_o)
{
    float escape;
    *t_o = coated_transmission(scene, bsdf, o, &escape);
    float base_max = vec3_max_component(coated_base(bsdf, escape));
    return coated_specular_probability(*t_o, base_max, escape * bsdf->eta * bsdf->eta);
}

/* Draws a direction from the mixture of both lobes: u in the coat's, u_base in the base's. The delta reflection of a
 * smooth coat is no part of the mixture's density. */
SHARED_FUNCTION bool coated_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u, Vec2 u_base,
                                   BsdfSample *sample)
{
    bool flip = wo.z < 0.0f;
    Vec3 o = direction_flip(wo, flip);
    bool rough = bsdf_is_rough(scene, bsdf);
    float t_o, specular = coated_specular(scene, bsdf, o, &t_o);
    Vec3 i;
    if (!(u_lobe < specular)) {
        i = warp_cosine_hemisphere(u_base);
    } else if (rough) {
        Vec3 m = ggx_sample_visible(o, bsdf->alpha_x, bsdf->alpha_y, u);
        i = vec3_mad(vec3_negate(o), 2.0f * vec3_dot(o, m), m);
    } else {
        bsdf_sample_set_delta(sample, vec3(-wo.x, -wo.y, wo.z), vec3_splat((1.0f - t_o) / specular), specular);
        return true;
    }
    if (!(i.z > BSDF_COSINE_MIN))
        return false;
    BsdfValue value = coated_eval_above(scene, bsdf, o, i);
    if (!(value.pdf_w > 0.0f))
        return false;
    bsdf_sample_set(sample, direction_flip(i, flip), vec3_scale(value.f_cos, 1.0f / value.pdf_w), value);
    return true;
}

SHARED_FUNCTION bool coated_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                   BsdfInverse *inverse)
{
    float t_o;
    if (!(u_lobe < coated_specular(scene, bsdf, wo, &t_o)))
        return cosine_invert(wi, inverse);
    return bsdf_is_rough(scene, bsdf) && reflection_invert(bsdf, wo, wi, inverse);
}

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

SHARED_FUNCTION BsdfValue bsdf_coated_diffuse_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                   uint transport)
{
    (void)transport;
    return coated_eval(scene, bsdf, wo, wi);
}

SHARED_FUNCTION bool bsdf_coated_diffuse_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                                BsdfSample *sample)
{
    return coated_sample(scene, bsdf, wo, draw.u_lobe, draw.u, draw.u_base, sample);
}

SHARED_FUNCTION bool bsdf_coated_diffuse_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                float u_lobe, BsdfInverse *inverse)
{
    bool flip = wo.z < 0.0f;
    return wo.z * wi.z > 0.0f &&
           coated_invert(scene, bsdf, direction_flip(wo, flip), direction_flip(wi, flip), u_lobe, inverse);
}

#endif
