/* Lights without extent: point, spot, distant. No sampled direction can hit them. */
#ifndef TWINLIGHT_LIGHT_DELTA_H
#define TWINLIGHT_LIGHT_DELTA_H

#include "layout/path_types.h"
#include "layout/scene_view.h"

/* pbrt-v4's falloff: a cubic step in the cosine, from 0 at the cone's edge to 1 inside the falloff angle. Without
 * falloff cos_falloff = cos_total, which gives a step. */
SHARED_FUNCTION float spot_falloff(float cosine, float cos_total, float cos_falloff)
{
    if (cosine >= cos_falloff)
        return 1.0f;
    if (!(cosine > cos_total))
        return 0.0f;
    float t = (cosine - cos_total) / (cos_falloff - cos_total);
    return t * t * (3.0f - 2.0f * t);
}

/* sample->radiance is the arriving radiance integrated over solid angle, so pdf_w is 1. */
SHARED_FUNCTION bool delta_light_sample(const SceneView *scene, uint light, Vec3 ref, LightSample *sample)
{
    __global const Light *source = scene->lights + light;
    sample->ng = vec3_splat(0.0f);
    sample->pdf_w = 1.0f;
    sample->delta = 1u;
    sample->p = source->position;
    if (source->kind == LIGHT_DISTANT) {
        sample->infinite = 1u;
        sample->wi = vec3_negate(source->direction);
        sample->radiance = source->emission;
    } else {
        Vec3 d = vec3_sub(source->position, ref);
        float distance2 = vec3_length_squared(d);
        if (!(distance2 > 0.0f))
            return false;
        sample->infinite = 0u;
        sample->wi = vec3_scale(d, 1.0f / float_sqrt(distance2));
        float falloff = 1.0f;
        if (source->kind == LIGHT_SPOT)
            falloff = spot_falloff(-vec3_dot(source->direction, sample->wi), source->cos_total, source->cos_falloff);
        sample->radiance = vec3_scale(source->emission, falloff / distance2);
    }
    return !vec3_is_zero(sample->radiance) && vec3_finite(sample->radiance);
}

#endif
