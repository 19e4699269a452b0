/* Light subpaths aimed at smooth specular surfaces. Of a lamp in a room, and of light from infinity, few subpaths meet
 * the small mirror or the window pane that makes a caustic, and connections to a camera find its light by nothing else.
 * So a part of the rays that leave a light, AIM_PART, is drawn through spheres around those surfaces, the aims, with
 * equal probability through each: uniform in the solid angle that the sphere subtends at the light's point or, from
 * infinity, uniform on the sphere's disc. A sphere around the light's point itself aims nowhere, and the ray is drawn
 * as by light_emit. (Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, section 5.3.1, has such projection
 * maps.)
 *
 * Here are the densities that result, and the drawing. */
#ifndef TWINLIGHT_LIGHT_AIM_H
#define TWINLIGHT_LIGHT_AIM_H

#include "light/opening.h"

/* Others have at most a third more variance. docs/CAUSTICS.md */
#define AIM_PART 0.25f

/* At squared distances below this many squared radii a point counts as inside the aim. */
#define AIM_OUTSIDE 1.0001f

/* Whether the line through p along w (unit) meets the aim. */
SHARED_FUNCTION bool aim_met(Aim aim, Vec3 p, Vec3 w)
{
    return vec3_length_squared(vec3_cross(vec3_sub(aim.center, p), w)) <= aim.radius * aim.radius;
}

/* 1 - cosine of the half-angle that the aim subtends at p; 0 if p is not outside. */
SHARED_FUNCTION float aim_versine(Aim aim, Vec3 p)
{
    float distance2 = vec3_length_squared(vec3_sub(aim.center, p)), radius2 = aim.radius * aim.radius;
    if (!(distance2 > AIM_OUTSIDE * radius2))
        return 0.0f;
    float sin2 = radius2 / distance2;
    return sin2 / (1.0f + float_sqrt(1.0f - sin2));
}

/* Density per solid angle of a ray that leaves p along w (unit), given its light and p. ng: light_emit_pdf_w. Distant
 * and infinite lights: their directions are not aimed. */
SHARED_FUNCTION float light_aimed_pdf_w(const SceneView *scene, uint light, Vec3 p, Vec3 ng, Vec3 w)
{
    uint count = scene->frame->scene.aim_count, kind = light_kind(scene->lights + light);
    float unaimed = light_emit_pdf_w(scene, light, ng, w), sum = 0.0f;
    if (count == 0u || (kind != LIGHT_AREA && !light_has_position(kind)))
        return unaimed;
    for (uint i = 0u; i < count; ++i) {
        Aim aim = scene->aims[i];
        float versine = aim_versine(aim, p);
        if (!(versine > 0.0f))
            sum += unaimed;
        else if (aim_met(aim, p, w) && vec3_dot(vec3_sub(aim.center, p), w) > 0.0f)
            sum += warp_cone_pdf(versine);
    }
    return (1.0f - AIM_PART) * unaimed + AIM_PART * (sum / (float)count);
}

/* Density, per area perpendicular to it, of the ray of a light at infinity that passes p along w (unit), given w. p
 * must be in the scene. */
SHARED_FUNCTION float light_aimed_pdf_disc(const SceneView *scene, uint light, Vec3 p, Vec3 w)
{
    uint count = scene->frame->scene.aim_count;
    float unaimed = light_opened_pdf_disc(scene, light, p, w), sum = 0.0f;
    if (count == 0u)
        return unaimed;
    for (uint i = 0u; i < count; ++i) {
        Aim aim = scene->aims[i];
        if (aim_met(aim, p, w))
            sum += INV_PI / (aim.radius * aim.radius);
    }
    return (1.0f - AIM_PART) * unaimed + AIM_PART * (sum / (float)count);
}

/* Moves the ray's origin so that it passes the disc of the aim; as in light_emit_from_disc, it begins where the
 * bounding sphere does. */
SHARED_FUNCTION void aim_from_infinity(const SceneView *scene, Aim aim, Vec2 u, LightEmission *emission)
{
    Vec2 disc = warp_disk_concentric(u);
    Vec3 offset = frame_to_world(frame_from_normal(emission->w), vec3(disc.x, disc.y, 0.0f));
    Vec3 passed = vec3_mad(aim.center, aim.radius, offset);
    light_emit_from_far(scene, passed, emission);
}

/* Turns the ray to pass through the aim, which does not contain its origin; false if the light emits nothing there. */
SHARED_FUNCTION bool aim_from_point(const SceneView *scene, __global const Light *source, Aim aim, Vec2 u,
                                    LightEmission *emission)
{
    Vec3 axis = vec3_normalize(vec3_sub(aim.center, emission->p));
    Vec3 w = frame_to_world(frame_from_normal(axis), warp_cone(u, aim_versine(aim, emission->p)));
    emission->w = vec3_normalize(w);
    if (light_kind(source) != LIGHT_AREA) {
        emission->radiance = delta_light_emitted(scene, source, emission->w);
        return !vec3_is_zero(emission->radiance);
    }
    float cosine = vec3_dot(emission->ng, emission->w);
    if (cosine < 0.0f && (source->flags & LIGHT_TWO_SIDED) != 0u) {
        emission->ng = vec3_negate(emission->ng);
        emission->back ^= 1u;
        cosine = -cosine;
    }
    emission->cosine = cosine;
    return cosine > 0.0f;
}

/* light_emit, with a part of the rays aimed, and of the others from infinity a part through openings. u_aim: uniform in
 * [0, 1). */
SHARED_FUNCTION bool light_emit_aimed(const SceneView *scene, uint light, float u_aim, Vec2 u_point, Vec2 u_direction,
                                      LightEmission *emission)
{
    uint count = scene->frame->scene.aim_count;
    __global const Light *source = scene->lights + light;
    if (!light_emit(scene, light, u_point, u_direction, emission))
        return false;
    bool infinite = emission->infinite != 0u;
    if (count == 0u && (!infinite || scene->frame->openings.count == 0u))
        return true;
    float part = count > 0u ? AIM_PART : 0.0f;
    uint index = count > 0u ? (uint)(u_aim / AIM_PART * (float)count) : 0u;
    bool aimed = u_aim < part && index < count;
    Aim aim = {{0.0f, 0.0f, 0.0f}, 0.0f};
    if (aimed)
        aim = scene->aims[index];
    if (infinite) {
        if (aimed)
            aim_from_infinity(scene, aim, u_point, emission);
        else if (!light_open(scene, light, (u_aim - part) / (1.0f - part), u_point, emission))
            return false;
        if (aimed && light_has_portal(scene, light) &&
            !(light_emit_pdf_passing(scene, light, emission->p, emission->w) > 0.0f))
            return false;
        emission->pdf_p = light_aimed_pdf_disc(scene, light, emission->p, emission->w);
        return emission->pdf_p > 0.0f;
    }
    if (aimed && aim_versine(aim, emission->p) > 0.0f && !aim_from_point(scene, source, aim, u_direction, emission))
        return false;
    emission->pdf_w = light_aimed_pdf_w(scene, light, emission->p, emission->ng, emission->w);
    return emission->pdf_w > 0.0f;
}

#endif
