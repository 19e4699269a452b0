/* Scattering at a surface: evaluation and sampling of whatever Bsdf it has. A branch for a kind or a rough lobe that
 * the scene lacks is compiled out on devices and costs one test in C. */
#ifndef TWINLIGHT_BSDF_BSDF_H
#define TWINLIGHT_BSDF_BSDF_H

#include "bsdf/coated.h"
#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/diffuse_transmission.h"
#include "bsdf/thin_dielectric.h"
#include "layout/scene_view.h"

/* A rough interface whose index is this close to 1 is taken as smooth: it bends light by less than 1e-3 alpha radians,
 * and float32 half vectors no longer resolve that. */
#define ETA_MATCHED 1e-3f

/* TRAIT_* of a kind of BSDF: four bits of a constant. */
SHARED_FUNCTION uint bsdf_traits(uint kind)
{
#define TRAITS_OF(NAME, name, text, traits) | (ulong)(traits) << 4 * MATERIAL_##NAME
    return (uint)((0ul BSDF_LIST(TRAITS_OF)) >> 4u * kind) & 0xfu;
#undef TRAITS_OF
}

/* Must be called once kind, alphas, eta and coat_table are set: derives BSDF_SMOOTH and BSDF_ROUGH, and bounds the
 * alphas of a rough lobe (ALPHA_MIN as in pbrt-v4). Other flags are kept. */
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
    } else if ((traits & TRAIT_DELTA) != 0u) {
        bsdf->flags |= BSDF_SMOOTH;
    }
}

/* The functions of each kind's file, for directions with |z| above BSDF_COSINE_MIN. */
#define OF_KIND(scene, bsdf, NAME) (SCENE_HAS(scene, FEATURE_##NAME) && (bsdf)->kind == MATERIAL_##NAME)

/* Both directions are unit, in the shading frame, pointing away from the surface. Delta lobes are zero. */
SHARED_FUNCTION BsdfValue bsdf_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, uint transport)
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

/* Whether bsdf_sample_base asks for u_base. */
SHARED_FUNCTION bool bsdf_has_base(const SceneView *scene, const Bsdf *bsdf)
{
    (void)scene;
    return (bsdf_traits(bsdf->kind) & TRAIT_COSINE) != 0u;
}

/* Draws wi from u_lobe (which lobe) and u_base (where in a cosine lobe) or u (where in another), all in [0,1). Fills
 * every member of *sample. False: the light is absorbed, or the sample fell on the wrong side of the surface; it
 * contributes nothing. */
SHARED_FUNCTION bool bsdf_sample_base(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u,
                                      Vec2 u_base, uint transport, BsdfSample *sample)
{
    if (!(float_abs(wo.z) > BSDF_COSINE_MIN))
        return false;
#define SAMPLE(NAME, name, text, traits)                                                                               \
    if (OF_KIND(scene, bsdf, NAME))                                                                                    \
        return bsdf_##name##_sample(scene, bsdf, wo, u_lobe, u, u_base, transport, sample);
    BSDF_LIST(SAMPLE)
#undef SAMPLE
    return false;
}

/* The same with one point for all lobes. */
SHARED_FUNCTION bool bsdf_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u,
                                 uint transport, BsdfSample *sample)
{
    return bsdf_sample_base(scene, bsdf, wo, u_lobe, u, u, transport, sample);
}

/* The point by which bsdf_sample_base would draw wi, with the lobe that u_lobe chooses. False: that lobe is a delta, or
 * does not reach wi. Where it is one of several lobes that do, the same direction has other points, too. */
SHARED_FUNCTION bool bsdf_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                 BsdfInverse *inverse)
{
    if (!(float_abs(wo.z) > BSDF_COSINE_MIN && float_abs(wi.z) > BSDF_COSINE_MIN))
        return false;
#define INVERT(NAME, name, text, traits)                                                                               \
    if (OF_KIND(scene, bsdf, NAME))                                                                                    \
        return bsdf_##name##_invert(scene, bsdf, wo, wi, u_lobe, inverse);
    BSDF_LIST(INVERT)
#undef INVERT
    return false;
}

#endif
