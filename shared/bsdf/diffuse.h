/* Lambertian reflection on the side that light comes from, and what all BSDFs share.
 *
 * Conventions of every file of bsdf/: directions are unit, in the shading frame, and point away from the surface.
 * `eval` and `sample` return nothing for directions with |z| <= BSDF_COSINE_MIN. */
#ifndef TWINLIGHT_BSDF_DIFFUSE_H
#define TWINLIGHT_BSDF_DIFFUSE_H

#include "layout/path_types.h"
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

#endif
