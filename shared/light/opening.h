/* Light subpaths from infinity that start through openings (layout/openings.h). Of the light that falls on a house,
 * little passes a window; so part of the rays are drawn uniformly through each opening, and the rest as by
 * light_emit. The rays of a direction w through a rectangle have density 1 / (area |w_axis|) per area perpendicular
 * to w. Those that would come from the opening's inner side are mirrored at its plane, so the density of a direction
 * on the outer side is the sum of its own and its mirror image's. */
#ifndef TWINLIGHT_LIGHT_OPENING_H
#define TWINLIGHT_LIGHT_OPENING_H

#include "light/emit.h"

/* Rays that are as good as parallel to an opening are not drawn through it. */
#define OPENING_COSINE_MIN 1e-4f

SHARED_FUNCTION Vec3 opening_mirrored(Vec3 v, uint axis)
{
    return vec3(axis == 0u ? -v.x : v.x, axis == 1u ? -v.y : v.y, axis == 2u ? -v.z : v.z);
}

/* Whether light along w comes from the opening's inner side. */
SHARED_FUNCTION bool opening_from_inside(Opening opening, Vec3 w)
{
    return vec3_component(w, opening.axis) * opening.side > 0.0f;
}

/* Density, per area perpendicular to w (unit), of the ray that passes p along w among those drawn through the
 * opening. Here and below, of functions without a scene, p and w are in the openings' frame. */
SHARED_FUNCTION float opening_pdf(Opening opening, Vec3 p, Vec3 w)
{
    uint u_axis = opening.axis == 2u ? 0u : opening.axis + 1u, v_axis = opening.axis == 0u ? 2u : opening.axis - 1u;
    float cosine = vec3_component(w, opening.axis);
    if (!(float_abs(cosine) > OPENING_COSINE_MIN))
        return 0.0f;
    float along = (opening.at - vec3_component(p, opening.axis)) / cosine;
    float u = vec3_component(p, u_axis) + along * vec3_component(w, u_axis);
    float v = vec3_component(p, v_axis) + along * vec3_component(w, v_axis);
    if (u < opening.u_low || u > opening.u_high || v < opening.v_low || v > opening.v_high)
        return 0.0f;
    float area = (opening.u_high - opening.u_low) * (opening.v_high - opening.v_low);
    return 1.0f / (area * float_abs(cosine));
}

/* By how much more rays of the light that are drawn through the opening come along w (unit, in the openings' frame)
 * than those of light_emit. */
SHARED_FUNCTION float opening_direction_ratio(const SceneView *scene, Opening opening, Vec3 w)
{
    if (opening.side == 0.0f)
        return 1.0f;
    if (opening_from_inside(opening, w))
        return 0.0f;
    Frame frame = scene->frame->openings.frame;
    Vec3 d = vec3_negate(w);
    float pdf = environment_pdf_w(scene, opening.light, frame_to_world(frame, d));
    if (!(pdf > 0.0f))
        return 1.0f;
    Vec3 mirrored = frame_to_world(frame, opening_mirrored(d, opening.axis));
    return 1.0f + environment_pdf_w(scene, opening.light, mirrored) / pdf;
}

/* Density, per area perpendicular to w (unit), with which a ray of the light that passes p along w starts, if no aim
 * takes it; relative to the density of w by light_emit. */
SHARED_FUNCTION float light_opened_pdf_disc(const SceneView *scene, uint light, Vec3 p, Vec3 w)
{
    __global const OpeningParams *openings = &scene->frame->openings;
    Vec3 p_local = frame_to_local(openings->frame, p), w_local = frame_to_local(openings->frame, w);
    float rest = 1.0f, sum = 0.0f;
    for (uint i = 0u; i < openings->count; ++i) {
        Opening opening = openings->each[i];
        if (opening.light != light)
            continue;
        rest -= opening.share;
        float pdf = opening_pdf(opening, p_local, w_local);
        if (pdf > 0.0f)
            sum += opening.share * pdf * opening_direction_ratio(scene, opening, w_local);
    }
    return rest * light_emit_pdf_passing(scene, light, p, w) + sum;
}

/* Moves the ray's origin so that it passes a uniform point of the opening, from its outer side. False if it cannot, or
 * the light emits nothing from there. */
SHARED_FUNCTION bool opening_from_infinity(const SceneView *scene, Opening opening, Vec2 u, LightEmission *emission)
{
    Frame frame = scene->frame->openings.frame;
    float x = opening.u_low + u.x * (opening.u_high - opening.u_low);
    float y = opening.v_low + u.y * (opening.v_high - opening.v_low);
    Vec3 passed = opening.axis == 0u   ? vec3(opening.at, x, y)
                  : opening.axis == 1u ? vec3(y, opening.at, x)
                                       : vec3(x, y, opening.at);
    Vec3 w = frame_to_local(frame, emission->w);
    if (opening_from_inside(opening, w)) {
        emission->w = frame_to_world(frame, opening_mirrored(w, opening.axis));
        emission->radiance = environment_beyond(scene, opening.light, vec3_negate(emission->w));
        emission->pdf_w = environment_pdf_w(scene, opening.light, vec3_negate(emission->w));
    }
    light_emit_from_far(scene, frame_to_world(frame, passed), emission);
    return float_abs(vec3_component(w, opening.axis)) > OPENING_COSINE_MIN && emission->pdf_w > 0.0f &&
           float_finite(emission->pdf_w) && !vec3_is_zero(emission->radiance);
}

/* Moves the origin of a ray from infinity, drawn by light_emit, to pass one of the light's openings or none of them.
 * u_choice: uniform in [0, 1). False: no emission. */
SHARED_FUNCTION bool light_open(const SceneView *scene, uint light, float u_choice, Vec2 u_point,
                                LightEmission *emission)
{
    __global const OpeningParams *openings = &scene->frame->openings;
    for (uint i = 0u; i < openings->count; ++i) {
        Opening opening = openings->each[i];
        if (opening.light != light)
            continue;
        if (u_choice < opening.share)
            return opening_from_infinity(scene, opening, u_point, emission);
        u_choice -= opening.share;
    }
    return true;
}

#endif
