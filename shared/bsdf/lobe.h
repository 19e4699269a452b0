/* What BSDFs share: conventions, the cut-off at grazing directions, and lobes that several have.
 *
 * Conventions of every BSDF: directions are unit, in the shading frame, and point away from the surface. Evaluation and
 * sampling return nothing for directions with |z| <= BSDF_COSINE_MIN. */
#ifndef TWINLIGHT_BSDF_LOBE_H
#define TWINLIGHT_BSDF_LOBE_H

#include "bsdf/microfacet.h"
#include "layout/path_types.h"
#include "layout/scene_view.h"
#include "math/warp.h"

#define BSDF_COSINE_MIN 1e-6f

SHARED_FUNCTION BsdfValue bsdf_value_zero(void)
{
    BsdfValue value;
    value.f_cos = vec3_splat(0.0f);
    value.pdf_w = 0.0f;
    value.pdf_rev_w = 0.0f;
    return value;
}

/* w, mirrored to the other side of the surface if `flip`. */
SHARED_FUNCTION Vec3 direction_flip(Vec3 w, bool flip)
{
    return vec3(w.x, w.y, flip ? -w.z : w.z);
}

/* A non-delta sample on wo's side; everything but wi and weight comes from `value`. */
SHARED_FUNCTION void bsdf_sample_set(BsdfSample *sample, Vec3 wi, Vec3 weight, BsdfValue value)
{
    sample->wi = wi;
    sample->weight = weight;
    sample->pdf_w = value.pdf_w;
    sample->pdf_rev_w = value.pdf_rev_w;
    sample->delta = 0u;
    sample->transmitted = 0u;
    sample->eta = 1.0f;
}

/* A sample of a delta lobe that is chosen with probability `probability` in either direction. */
SHARED_FUNCTION void bsdf_sample_set_delta(BsdfSample *sample, Vec3 wi, Vec3 weight, float probability)
{
    sample->wi = wi;
    sample->weight = weight;
    sample->pdf_w = probability;
    sample->pdf_rev_w = probability;
    sample->delta = 1u;
    sample->transmitted = 0u;
    sample->eta = 1.0f;
}

/* Whether the specular lobe is a microfacet lobe, not a delta. */
SHARED_FUNCTION bool bsdf_is_rough(const SceneView *scene, const Bsdf *bsdf)
{
    return SCENE_HAS(scene, FEATURE_ROUGH) && (bsdf->flags & BSDF_ROUGH) != 0u;
}

/* ---- inverses: the point that draws a direction ------------------------------------------------------------------ */

/* The numbers with which a lobe draws a direction, once the lobe is chosen, and their density: pdf_w is that of the
 * lobe alone, without the probability of choosing it. */
typedef struct BsdfInverse {
    Vec2 u; /* BsdfDraw.u, or BsdfDraw.u_base if `base` */
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

#endif
