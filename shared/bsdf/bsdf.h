/* Scattering at a surface: evaluates and samples whatever Bsdf it has. A branch for a kind or a rough lobe that the
 * scene lacks is compiled out on devices and costs one test in C. */
#ifndef TWINLIGHT_BSDF_BSDF_H
#define TWINLIGHT_BSDF_BSDF_H

#include "bsdf/coated.h"
#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/diffuse_transmission.h"
#include "bsdf/thin_dielectric.h"
#include "layout/scene_view.h"

/* A rough interface whose relative index is this close to 1 is treated as smooth: it bends light by less than 1e-3
 * alpha radians, which float32 half vectors no longer resolve. */
#define ETA_MATCHED 1e-3f

/* To be called after kind, alphas, eta and coat_table are set: derives BSDF_SMOOTH and BSDF_ROUGH, and clamps the
 * alphas of a rough lobe (ALPHA_MIN as in pbrt-v4). Keeps other flags. */
SHARED_FUNCTION void bsdf_flags_set(Bsdf *bsdf)
{
    uint kind = bsdf->kind;
    bool interface = kind == MATERIAL_DIELECTRIC || kind == MATERIAL_COATED_DIFFUSE;
    bool rough = (kind == MATERIAL_CONDUCTOR || interface) &&
                 (bsdf->alpha_x >= ALPHA_DELTA || bsdf->alpha_y >= ALPHA_DELTA) &&
                 !(interface && float_abs(bsdf->eta - 1.0f) < ETA_MATCHED);
    bsdf->flags &= ~(BSDF_SMOOTH | BSDF_ROUGH);
    if (rough) {
        bsdf->flags |= BSDF_ROUGH;
        bsdf->alpha_x = float_clamp(bsdf->alpha_x, ALPHA_MIN, ALPHA_MAX);
        bsdf->alpha_y = float_clamp(bsdf->alpha_y, ALPHA_MIN, ALPHA_MAX);
    } else if (kind == MATERIAL_CONDUCTOR || kind == MATERIAL_DIELECTRIC || kind == MATERIAL_THIN_DIELECTRIC) {
        bsdf->flags |= BSDF_SMOOTH;
    }
}

/* f(wo, wi) |cos wi| and both densities; delta lobes count as zero. wo and wi: unit, in the shading frame, pointing
 * away from the surface. */
SHARED_FUNCTION BsdfValue bsdf_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, uint transport)
{
    if (!(float_abs(wo.z) > BSDF_COSINE_MIN && float_abs(wi.z) > BSDF_COSINE_MIN))
        return bsdf_value_zero();
    if (SCENE_HAS(scene, FEATURE_DIFFUSE) && bsdf->kind == MATERIAL_DIFFUSE)
        return diffuse_eval(bsdf, wo, wi);
    if (SCENE_HAS(scene, FEATURE_COATED_DIFFUSE) && bsdf->kind == MATERIAL_COATED_DIFFUSE)
        return coated_eval(scene, bsdf, wo, wi);
    if (SCENE_HAS(scene, FEATURE_DIFFUSE_TRANSMISSION) && bsdf->kind == MATERIAL_DIFFUSE_TRANSMISSION)
        return diffuse_transmission_eval(bsdf, wo, wi);
    if (SCENE_HAS(scene, FEATURE_ROUGH) && (bsdf->flags & BSDF_ROUGH) != 0u) {
        if (SCENE_HAS(scene, FEATURE_CONDUCTOR) && bsdf->kind == MATERIAL_CONDUCTOR)
            return conductor_rough_eval(bsdf, wo, wi);
        if (SCENE_HAS(scene, FEATURE_DIELECTRIC) && bsdf->kind == MATERIAL_DIELECTRIC)
            return dielectric_rough_eval(bsdf, wo, wi, transport);
    }
    return bsdf_value_zero();
}

/* Whether bsdf_sample_base reads u_base. */
SHARED_FUNCTION bool bsdf_has_base(const SceneView *scene, const Bsdf *bsdf)
{
    return (SCENE_HAS(scene, FEATURE_DIFFUSE) && bsdf->kind == MATERIAL_DIFFUSE) ||
           (SCENE_HAS(scene, FEATURE_COATED_DIFFUSE) && bsdf->kind == MATERIAL_COATED_DIFFUSE) ||
           (SCENE_HAS(scene, FEATURE_DIFFUSE_TRANSMISSION) && bsdf->kind == MATERIAL_DIFFUSE_TRANSMISSION);
}

/* Draws wi. u_lobe chooses the lobe; u_base draws the direction in a cosine lobe, u in any other; all in [0,1). Fills
 * every member of *sample. False: no contribution, since the light is absorbed or the direction lies on the wrong side
 * of the surface. */
SHARED_FUNCTION bool bsdf_sample_base(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u,
                                      Vec2 u_base, uint transport, BsdfSample *sample)
{
    if (!(float_abs(wo.z) > BSDF_COSINE_MIN))
        return false;
    if (SCENE_HAS(scene, FEATURE_DIFFUSE) && bsdf->kind == MATERIAL_DIFFUSE)
        return diffuse_sample(bsdf, wo, u_base, sample);
    if (SCENE_HAS(scene, FEATURE_COATED_DIFFUSE) && bsdf->kind == MATERIAL_COATED_DIFFUSE)
        return coated_sample(scene, bsdf, wo, u_lobe, u, u_base, sample);
    if (SCENE_HAS(scene, FEATURE_DIFFUSE_TRANSMISSION) && bsdf->kind == MATERIAL_DIFFUSE_TRANSMISSION)
        return diffuse_transmission_sample(bsdf, wo, u_lobe, u_base, sample);
    if (SCENE_HAS(scene, FEATURE_THIN_DIELECTRIC) && bsdf->kind == MATERIAL_THIN_DIELECTRIC)
        return thin_dielectric_sample(bsdf, wo, u_lobe, sample);
    bool rough = SCENE_HAS(scene, FEATURE_ROUGH) && (bsdf->flags & BSDF_ROUGH) != 0u;
    if (SCENE_HAS(scene, FEATURE_CONDUCTOR) && bsdf->kind == MATERIAL_CONDUCTOR)
        return rough ? conductor_rough_sample(bsdf, wo, u, sample) : conductor_smooth_sample(bsdf, wo, sample);
    if (SCENE_HAS(scene, FEATURE_DIELECTRIC) && bsdf->kind == MATERIAL_DIELECTRIC)
        return rough ? dielectric_rough_sample(bsdf, wo, u_lobe, u, transport, sample)
                     : dielectric_smooth_sample(bsdf, wo, u_lobe, transport, sample);
    return false;
}

/* bsdf_sample_base with the same point for all lobes. */
SHARED_FUNCTION bool bsdf_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u,
                                 uint transport, BsdfSample *sample)
{
    return bsdf_sample_base(scene, bsdf, wo, u_lobe, u, u, transport, sample);
}

#endif
