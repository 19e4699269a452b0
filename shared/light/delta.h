/* Lights without extent. No sampled direction can hit them. For each of LIGHT_LIST_DELTA (layout/scene_types.h):
 *   light_NAME_sample: sets the light that arrives at `ref`, for light_sample: wi, p, infinite, radiance;
 *   light_NAME_emit: draws a ray that leaves it, for light_emit: w, pdf_w, p, pdf_p, delta_* and infinite;
 *   light_NAME_emit_pdf_w: pdf_w of that, from w;
 *   light_NAME_emitted: radiance of that, from w. */
#ifndef TWINLIGHT_LIGHT_DELTA_H
#define TWINLIGHT_LIGHT_DELTA_H

#include "light/intensity_image.h"
#include "light/position.h"

/* Whether a delta light of this kind is at LightDetail.position; the others are at infinity. */
SHARED_FUNCTION bool light_has_position(uint kind)
{
#define POSITION_OF(NAME, name, text, feature, position) | (position) << LIGHT_##NAME
    return ((0u LIGHT_LIST_DELTA(POSITION_OF)) >> kind & 1u) != 0u;
#undef POSITION_OF
}

/* Whether light of this kind comes to all places from infinity: distant, or an environment without a portal. */
SHARED_FUNCTION bool light_is_far(uint kind)
{
    return kind != LIGHT_AREA && kind != LIGHT_PORTAL && !light_has_position(kind);
}

/* ---- point ------------------------------------------------------------------------------------------------------- */

SHARED_FUNCTION bool light_point_sample(const SceneView *scene, __global const Light *source, Vec3 ref,
                                        LightSample *sample)
{
    float distance2;
    if (!position_light_sample(scene, source, ref, sample, &distance2))
        return false;
    sample->radiance = vec3_scale(source->emission, 1.0f / distance2);
    return true;
}

SHARED_FUNCTION float light_point_emit_pdf_w(const SceneView *scene, __global const Light *source, Vec3 w)
{
    (void)scene;
    (void)source;
    (void)w;
    return INV_4PI;
}

SHARED_FUNCTION Vec3 light_point_emitted(const SceneView *scene, __global const Light *source, Vec3 w)
{
    (void)scene;
    (void)w;
    return source->emission;
}

SHARED_FUNCTION bool light_point_emit(const SceneView *scene, __global const Light *source, Vec2 u_point,
                                      Vec2 u_direction, LightEmission *emission)
{
    (void)u_point;
    position_light_emit(scene, source, emission);
    emission->w = warp_sphere(u_direction);
    emission->pdf_w = INV_4PI;
    return true;
}

/* ---- spot -------------------------------------------------------------------------------------------------------- */

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

SHARED_FUNCTION Vec3 light_spot_emitted(const SceneView *scene, __global const Light *source, Vec3 w)
{
    __global const LightDetail *spot = light_detail(scene, source);
    float cosine = vec3_dot(spot->direction, w);
    return vec3_scale(source->emission, spot_falloff(cosine, spot->cos_total, spot->cos_falloff));
}

SHARED_FUNCTION bool light_spot_sample(const SceneView *scene, __global const Light *source, Vec3 ref,
                                       LightSample *sample)
{
    float distance2;
    if (!position_light_sample(scene, source, ref, sample, &distance2))
        return false;
    sample->radiance = vec3_scale(light_spot_emitted(scene, source, vec3_negate(sample->wi)), 1.0f / distance2);
    return true;
}

/* Integral over cosines of the unnormalised density from which a spot's directions are drawn: 1 inside the falloff
 * angle, linear in the cosine down to 0 at the edge. The cubic falloff has the same integral, and is at most 9/8 of the
 * line. */
SHARED_FUNCTION float spot_emit_integral(__global const LightDetail *spot)
{
    return (1.0f - spot->cos_falloff) + 0.5f * (spot->cos_falloff - spot->cos_total);
}

SHARED_FUNCTION float spot_emit_pdf_w(__global const LightDetail *spot, float cosine)
{
    float pdf = INV_2PI / spot_emit_integral(spot);
    if (cosine >= spot->cos_falloff)
        return pdf;
    if (!(cosine > spot->cos_total))
        return 0.0f;
    return pdf * ((cosine - spot->cos_total) / (spot->cos_falloff - spot->cos_total));
}

/* Mapped through the disk, as in warp_cone: the squared radius is the fraction of spot_emit_integral within the
 * angle. */
SHARED_FUNCTION Vec3 spot_emit_direction(__global const LightDetail *spot, Vec2 u)
{
    float r;
    Vec2 d = warp_disk_polar(u, &r);
    float integral = spot_emit_integral(spot), inner = 1.0f - spot->cos_falloff;
    float versine = r * r * integral; /* 1 - cos */
    float scale = float_sqrt(integral * (2.0f - versine));
    if (versine > inner) {
        float width = spot->cos_falloff - spot->cos_total;
        float t = float_sqrt(float_max(1.0f - 2.0f * ((versine - inner) / width), 0.0f));
        versine = float_min(inner + width * (1.0f - t), 2.0f);
        scale = float_sqrt(versine * (2.0f - versine)) / r;
    }
    return frame_to_world(frame_from_normal(spot->direction), vec3(d.x * scale, d.y * scale, 1.0f - versine));
}

SHARED_FUNCTION float light_spot_emit_pdf_w(const SceneView *scene, __global const Light *source, Vec3 w)
{
    __global const LightDetail *spot = light_detail(scene, source);
    return spot_emit_pdf_w(spot, vec3_dot(spot->direction, w));
}

SHARED_FUNCTION bool light_spot_emit(const SceneView *scene, __global const Light *source, Vec2 u_point,
                                     Vec2 u_direction, LightEmission *emission)
{
    (void)u_point;
    position_light_emit(scene, source, emission);
    __global const LightDetail *spot = light_detail(scene, source);
    if (!(spot_emit_integral(spot) > 0.0f))
        return false;
    emission->w = vec3_normalize(spot_emit_direction(spot, u_direction));
    emission->pdf_w = spot_emit_pdf_w(spot, vec3_dot(spot->direction, emission->w));
    return emission->pdf_w > 0.0f;
}

/* ---- distant ----------------------------------------------------------------------------------------------------- */

SHARED_FUNCTION bool light_distant_sample(const SceneView *scene, __global const Light *source, Vec3 ref,
                                          LightSample *sample)
{
    (void)ref;
    sample->infinite = 1u;
    sample->wi = vec3_negate(light_detail(scene, source)->direction);
    sample->radiance = source->emission;
    return true;
}

SHARED_FUNCTION float light_distant_emit_pdf_w(const SceneView *scene, __global const Light *source, Vec3 w)
{
    (void)scene;
    (void)source;
    (void)w;
    return 1.0f;
}

SHARED_FUNCTION Vec3 light_distant_emitted(const SceneView *scene, __global const Light *source, Vec3 w)
{
    (void)scene;
    (void)w;
    return source->emission;
}

SHARED_FUNCTION bool light_distant_emit(const SceneView *scene, __global const Light *source, Vec2 u_point,
                                        Vec2 u_direction, LightEmission *emission)
{
    (void)u_direction;
    emission->w = light_detail(scene, source)->direction;
    emission->pdf_w = 1.0f;
    emission->delta_direction = 1u;
    return light_emit_from_disc(scene, u_point, emission);
}

/* ---- all --------------------------------------------------------------------------------------------------------- */

/* Whether the light is of the kind, which scenes with all of `feature` have. */
SHARED_FUNCTION bool delta_light_is(const SceneView *scene, __global const Light *source, uint kind, ulong feature)
{
    bool used = (feature & FEATURE_INTENSITY_IMAGE) == 0u || SCENE_HAS(scene, FEATURE_INTENSITY_IMAGE);
    return used && light_kind(source) == kind;
}

/* sample->radiance is the arriving radiance integrated over solid angle, so pdf_w is 1. */
SHARED_FUNCTION bool delta_light_sample(const SceneView *scene, __global const Light *source, Vec3 ref,
                                        LightSample *sample)
{
    bool reached = false;
    sample->ng = vec3_splat(0.0f);
    sample->pdf_w = 1.0f;
    sample->delta = 1u;
#define SAMPLE(NAME, name, text, feature, position)                                                                    \
    if (delta_light_is(scene, source, LIGHT_##NAME, feature))                                                          \
        reached = light_##name##_sample(scene, source, ref, sample);
    LIGHT_LIST_DELTA(SAMPLE)
#undef SAMPLE
    return reached && !vec3_is_zero(sample->radiance) && vec3_finite(sample->radiance);
}

SHARED_FUNCTION bool delta_light_emit(const SceneView *scene, __global const Light *source, Vec2 u_point,
                                      Vec2 u_direction, LightEmission *emission)
{
#define EMIT(NAME, name, text, feature, position)                                                                      \
    if (delta_light_is(scene, source, LIGHT_##NAME, feature)) {                                                        \
        bool emits = light_##name##_emit(scene, source, u_point, u_direction, emission);                               \
        emission->radiance = light_##name##_emitted(scene, source, emission->w);                                       \
        return emits;                                                                                                  \
    }
    LIGHT_LIST_DELTA(EMIT)
#undef EMIT
    return false;
}

SHARED_FUNCTION float delta_light_emit_pdf_w(const SceneView *scene, __global const Light *source, Vec3 w)
{
#define PDF(NAME, name, text, feature, position)                                                                       \
    if (delta_light_is(scene, source, LIGHT_##NAME, feature))                                                          \
        return light_##name##_emit_pdf_w(scene, source, w);
    LIGHT_LIST_DELTA(PDF)
#undef PDF
    return 0.0f;
}

/* Radiance of LightEmission along w. */
SHARED_FUNCTION Vec3 delta_light_emitted(const SceneView *scene, __global const Light *source, Vec3 w)
{
#define EMITTED(NAME, name, text, feature, position)                                                                   \
    if (delta_light_is(scene, source, LIGHT_##NAME, feature))                                                          \
        return light_##name##_emitted(scene, source, w);
    LIGHT_LIST_DELTA(EMITTED)
#undef EMITTED
    return vec3_splat(0.0f);
}

#endif
