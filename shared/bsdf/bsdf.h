/* Scattering at a surface: evaluates and samples whatever Bsdf it has. A branch for a kind or a rough lobe that the
 * scene lacks is compiled out on devices and costs one test in C. */
#ifndef TWINLIGHT_BSDF_BSDF_H
#define TWINLIGHT_BSDF_BSDF_H

#include "bsdf/coated.h"
#include "bsdf/coated_conductor.h"
#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/diffuse_transmission.h"
#include "bsdf/fibre.h"
#include "bsdf/hair.h"
#include "bsdf/phase.h"
#include "bsdf/thin_dielectric.h"
#include "layout/scene_view.h"

/* A rough interface whose relative index is this close to 1 is treated as smooth: it bends light by less than 1e-3
 * alpha radians, which float32 half vectors no longer resolve. */
#define ETA_MATCHED 1e-3f

/* TRAIT_* of a kind of BSDF, from a constant with four bits per kind. */
SHARED_FUNCTION uint bsdf_traits(uint kind)
{
#define TRAITS_OF(NAME, name, text, traits) | (ulong)(traits) << 4 * MATERIAL_##NAME
    return (uint)((0ul BSDF_LIST(TRAITS_OF)) >> 4u * kind) & 0xfu;
#undef TRAITS_OF
}

/* To be called after kind, alphas, eta, coat_table and the alphas of a base (BSDF_BASE_SHIFT) are set: derives
 * BSDF_SMOOTH and BSDF_ROUGH, and clamps the alphas of a rough lobe (ALPHA_MIN as in pbrt-v4). Keeps other flags. */
SHARED_FUNCTION void bsdf_flags_set(Bsdf *bsdf)
{
    uint traits = bsdf_traits(bsdf->kind);
    bool rough = (traits & TRAIT_MICROFACET) != 0u && (bsdf->alpha_x >= ALPHA_DELTA || bsdf->alpha_y >= ALPHA_DELTA) &&
                 !((traits & TRAIT_INTERFACE) != 0u && float_abs(bsdf->eta - 1.0f) < ETA_MATCHED);
    bsdf->flags &= ~(BSDF_SMOOTH | BSDF_ROUGH);
    if (rough) {
        bsdf->flags |= BSDF_ROUGH;
        bsdf->alpha_x = float_clamp(bsdf->alpha_x, ALPHA_MIN, ALPHA_MAX);
        bsdf->alpha_y = float_clamp(bsdf->alpha_y, ALPHA_MIN, ALPHA_MAX);
    } else if ((traits & TRAIT_DELTA) != 0u && bsdf->flags >> BSDF_BASE_SHIFT == 0u) {
        bsdf->flags |= BSDF_SMOOTH;
    }
}

/* Whether to dispatch to the functions of kind NAME, whose directions have |z| > BSDF_COSINE_MIN. */
#define OF_KIND(scene, bsdf, NAME) (SCENE_HAS(scene, FEATURE_BIT(NAME)) && (bsdf)->kind == MATERIAL_##NAME)

/* Whether it is the phase function of a vertex in a medium. */
SHARED_FUNCTION bool bsdf_is_phase(const SceneView *scene, const Bsdf *bsdf)
{
    return SCENE_HAS(scene, FEATURE_SCATTERING) && bsdf->kind == MATERIAL_PHASE;
}

/* bsdf_eval at a surface. */
SHARED_FUNCTION BsdfValue bsdf_eval_kind(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, uint transport)
{
    if (!(float_abs(wo.z) > BSDF_COSINE_MIN && float_abs(wi.z) > BSDF_COSINE_MIN))
        return bsdf_value_zero();
#define EVAL(NAME, name, text, traits)                                                                                 \
    if (OF_KIND(scene, bsdf, NAME))                                                                                    \
        return bsdf_##name##_eval(scene, bsdf, wo, wi, transport);
    BSDF_LIST(EVAL)
#undef EVAL
    return bsdf_value_zero();
}

/* bsdf_eval on a curve. */
SHARED_FUNCTION_APART BsdfValue bsdf_eval_fibre(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                uint transport)
{
    BsdfValue forward = bsdf_eval_kind(scene, bsdf, wo, wi, TRANSPORT_RADIANCE);
    BsdfValue reverse = bsdf_eval_kind(scene, bsdf, fibre_tilt(wo, wi), fibre_tilt(wi, wo), TRANSPORT_RADIANCE);
    return fibre_value(forward, reverse, wo, wi, transport);
}

/* Whether the Bsdf is that of a point on a curve. */
SHARED_FUNCTION bool bsdf_is_fibre(const SceneView *scene, const Bsdf *bsdf)
{
    return SCENE_HAS(scene, FEATURE_CURVE) && (bsdf->flags & BSDF_FIBRE) != 0u;
}

/* f(wo, wi) |cos wi|, or the phase function, and both densities; delta lobes count as zero. wo and wi: unit, in the
 * shading frame, pointing away from the surface. */
SHARED_FUNCTION BsdfValue bsdf_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, uint transport)
{
    if (bsdf_is_phase(scene, bsdf))
        return phase_eval(bsdf->color0.x, wi);
    if (bsdf_is_fibre(scene, bsdf))
        return bsdf_eval_fibre(scene, bsdf, wo, wi, transport);
    return bsdf_eval_kind(scene, bsdf, wo, wi, transport);
}

/* Whether bsdf_sample_base reads draw.u_base. */
SHARED_FUNCTION bool bsdf_has_base(const Bsdf *bsdf)
{
    return (bsdf_traits(bsdf->kind) & TRAIT_COSINE) != 0u;
}

/* bsdf_sample_base at a surface. */
SHARED_FUNCTION bool bsdf_sample_kind(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                      BsdfSample *sample)
{
    if (!(float_abs(wo.z) > BSDF_COSINE_MIN))
        return false;
#define SAMPLE(NAME, name, text, traits)                                                                               \
    if (OF_KIND(scene, bsdf, NAME))                                                                                    \
        return bsdf_##name##_sample(scene, bsdf, wo, draw, sample);
    BSDF_LIST(SAMPLE)
#undef SAMPLE
    return false;
}

/* bsdf_sample_base on a curve. */
SHARED_FUNCTION_APART bool bsdf_sample_fibre(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                             BsdfSample *sample)
{
    uint transport = draw.transport;
    draw.transport = TRANSPORT_RADIANCE;
    if (!bsdf_sample_kind(scene, bsdf, wo, draw, sample))
        return false;
    if (sample->delta != 0u)
        return true;
    Vec3 wi = sample->wi;
    BsdfValue reverse = bsdf_eval_kind(scene, bsdf, fibre_tilt(wo, wi), fibre_tilt(wi, wo), TRANSPORT_RADIANCE);
    sample->pdf_rev_w = reverse.pdf_w;
    if (transport == TRANSPORT_IMPORTANCE)
        sample->weight = vec3_scale(reverse.f_cos, fibre_cosine_ratio(wo, wi) / sample->pdf_w);
    return true;
}

/* Draws wi. Fills every member of *sample. False: no contribution, since the light is absorbed or the direction lies on
 * the wrong side of the surface. */
SHARED_FUNCTION bool bsdf_sample_base(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                      BsdfSample *sample)
{
    if (bsdf_is_phase(scene, bsdf)) {
        *sample = phase_sample(bsdf->color0.x, draw.u);
        return true;
    }
    if (bsdf_is_fibre(scene, bsdf))
        return bsdf_sample_fibre(scene, bsdf, wo, draw, sample);
    return bsdf_sample_kind(scene, bsdf, wo, draw, sample);
}

/* bsdf_sample_base with the same point for all lobes. */
SHARED_FUNCTION bool bsdf_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u,
                                 uint transport, BsdfSample *sample)
{
    BsdfDraw draw = {u_lobe, u, u, transport};
    return bsdf_sample_base(scene, bsdf, wo, draw, sample);
}

/* The point with which bsdf_sample_base draws wi in the lobe that u_lobe chooses. False: that lobe is a delta or cannot
 * draw wi. If several lobes can draw wi, it has other points as well. */
SHARED_FUNCTION bool bsdf_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                 BsdfInverse *inverse)
{
    if (bsdf_is_phase(scene, bsdf) || !(float_abs(wo.z) > BSDF_COSINE_MIN && float_abs(wi.z) > BSDF_COSINE_MIN))
        return false;
#define INVERT(NAME, name, text, traits)                                                                               \
    if (OF_KIND(scene, bsdf, NAME))                                                                                    \
        return bsdf_##name##_invert(scene, bsdf, wo, wi, u_lobe, inverse);
    BSDF_LIST(INVERT)
#undef INVERT
    return false;
}

#undef OF_KIND

#endif
