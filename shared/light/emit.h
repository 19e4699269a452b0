/* Emission, for light paths: rays that leave a light, and their densities. light/light.h is the counterpart for points
 * that are lit. */
#ifndef TWINLIGHT_LIGHT_EMIT_H
#define TWINLIGHT_LIGHT_EMIT_H

#include "light/light.h"

/* ---- infinite ---------------------------------------------------------------------------------------------------- */

/* light_emit of a light with a portal: along a direction in proportion to the light that passes it, through a uniform
 * point of it. */
SHARED_FUNCTION_APART bool portal_light_emit(const SceneView *scene, uint light, Vec2 u_point, Vec2 u_direction,
                                             LightEmission *emission)
{
    Portal portal = light_portal(scene, light);
    float pdf, stretch;
    Distribution2D directions = scene->distributions2d[light_detail(scene, scene->lights + light)->distribution];
    Vec2 uv = distribution2d_sample(scene->lookup, directions, u_direction, &pdf);
    Vec3 d = portal_direction(&portal, uv, &stretch);
    Vec3 passed = vec3_mad(portal.corner, u_point.x * portal.width, portal.axes.t);
    passed = vec3_mad(passed, u_point.y * portal.height, portal.axes.b);
    emission->w = vec3_negate(d);
    emission->radiance = environment_beyond(scene, light, d);
    emission->pdf_w = pdf / stretch;
    emission->pdf_p = portal_pdf_p(&portal, d);
    light_emit_from_far(scene, passed, emission);
    return emission->pdf_w > 0.0f && float_finite(emission->pdf_w) && emission->pdf_p > 0.0f &&
           float_finite(emission->pdf_p) && scene->frame->scene.world_radius > 0.0f;
}

SHARED_FUNCTION bool light_emit_infinite(const SceneView *scene, uint light, Vec2 u_point, Vec2 u_direction,
                                         LightEmission *emission)
{
    LightSample sample;
    if (light_has_portal(scene, light))
        return portal_light_emit(scene, light, u_point, u_direction, emission);
    if (!infinite_light_sample(scene, light, vec3_splat(0.0f), u_direction, &sample))
        return false;
    emission->w = vec3_negate(sample.wi);
    emission->radiance = sample.radiance;
    emission->pdf_w = sample.pdf_w;
    return light_emit_from_disc(scene, u_point, emission);
}

/* Density, per area perpendicular to w, with which light_emit makes the ray of a light at infinity that passes p along
 * w (unit), given w. */
SHARED_FUNCTION float light_emit_pdf_passing(const SceneView *scene, uint light, Vec3 p, Vec3 w)
{
    if (!light_has_portal(scene, light))
        return light_emit_pdf_disc(scene);
    Portal portal = light_portal(scene, light);
    Vec3 d = vec3_negate(w);
    return portal_crossed(&portal, p, d) ? portal_pdf_p(&portal, d) : 0.0f;
}

/* ---- area -------------------------------------------------------------------------------------------------------- */

SHARED_FUNCTION float area_emit_pdf_w(__global const Light *source, Vec3 ng, Vec3 w)
{
    float cosine = vec3_dot(ng, w);
    if ((source->flags & LIGHT_TWO_SIDED) != 0u)
        return 0.5f * INV_PI * float_abs(cosine);
    return warp_cosine_hemisphere_pdf(cosine);
}

SHARED_FUNCTION bool light_emit_area(const SceneView *scene, uint light, Vec2 u_point, Vec2 u_direction,
                                     LightEmission *emission)
{
    __global const Light *source = scene->lights + light;
    Primitive primitive = scene->primitives[source->primitive];
    AreaPoint point = area_light_point(scene, light, &primitive, u_point);
    emission->p = point.p;
    emission->ng = point.ng;
    emission->pdf_p = point.pdf;
    if ((source->flags & LIGHT_TWO_SIDED) != 0u) {
        bool back = u_direction.x >= 0.5f;
        u_direction.x = back ? 2.0f * u_direction.x - 1.0f : 2.0f * u_direction.x;
        emission->ng = back ? vec3_negate(point.ng) : point.ng;
        emission->back = back ? 1u : 0u;
    }
    Vec3 w = frame_to_world(frame_from_normal(emission->ng), warp_cosine_hemisphere(u_direction));
    emission->w = vec3_normalize(w);
    emission->cosine = vec3_dot(emission->ng, emission->w);
    emission->pdf_w = area_emit_pdf_w(source, emission->ng, emission->w);
    emission->radiance = source->emission;
    if (!light_is_invisible(scene, light))
        emission->radiance = vec3_scale(source->emission, area_light_alpha(scene, &primitive, point.p, point.uv));
    return emission->pdf_w > 0.0f && emission->pdf_p > 0.0f && float_finite(emission->pdf_p);
}

/* ---- all --------------------------------------------------------------------------------------------------------- */

/* Draws a ray that leaves `light`. Area lights: the point by area_light_point, even on spheres, which light_sample
 * draws by solid angle; the direction with the cosine, on the side or sides that emit. Point lights: a uniform
 * direction; spots roughly, goniometric and projection lights exactly in proportion to their intensity. Light from
 * infinity: the direction as in light_sample, the point on a disc that covers the scene, or on the light's portal.
 * False: no emission; *emission is then meaningless. */
SHARED_FUNCTION bool light_emit(const SceneView *scene, uint light, Vec2 u_point, Vec2 u_direction,
                                LightEmission *emission)
{
    uint kind = light_kind(scene->lights + light);
    bool done = false;
    emission->ng = vec3_splat(0.0f);
    emission->cosine = 1.0f;
    emission->delta_position = 0u;
    emission->delta_direction = 0u;
    emission->infinite = 0u;
    emission->back = 0u;
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && kind == LIGHT_AREA)
        done = light_emit_area(scene, light, u_point, u_direction, emission);
    else if (SCENE_HAS(scene, FEATURE_INFINITE_LIGHT) && kind >= LIGHT_INFINITE)
        done = light_emit_infinite(scene, light, u_point, u_direction, emission);
    else if (SCENE_HAS(scene, FEATURE_DELTA_LIGHT))
        done = delta_light_emit(scene, scene->lights + light, u_point, u_direction, emission);
    return done && !vec3_is_zero(emission->radiance);
}

/* pdf_p of light_emit. Area lights: at their point `hit` (ng, u, v are read), per area; other lights do not read `hit`.
 * Infinite and distant: per area perpendicular to the light's direction, unless the light has a portal
 * (light_emit_pdf_passing). Lights at a point: 1. */
SHARED_FUNCTION float light_emit_pdf_p(const SceneView *scene, uint light, const Surface *hit)
{
    uint kind = light_kind(scene->lights + light);
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && kind == LIGHT_AREA) {
        Primitive primitive = scene->primitives[scene->lights[light].primitive];
        float pdf = area_light_pdf_a(scene, light, &primitive, hit);
        return float_finite(pdf) ? pdf : 0.0f;
    }
    return light_has_position(kind) ? 1.0f : light_emit_pdf_disc(scene);
}

/* pdf_w of light_emit, of leaving along w (unit, the direction in which light travels). Area lights: from a point with
 * normal ng (either of the two if both sides emit). Distant: 1. */
SHARED_FUNCTION float light_emit_pdf_w(const SceneView *scene, uint light, Vec3 ng, Vec3 w)
{
    __global const Light *source = scene->lights + light;
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && light_kind(source) == LIGHT_AREA)
        return area_emit_pdf_w(source, ng, w);
    if (SCENE_HAS(scene, FEATURE_INFINITE_LIGHT) && light_kind(source) >= LIGHT_INFINITE)
        return environment_pdf_w(scene, light, vec3_negate(w));
    return delta_light_emit_pdf_w(scene, source, w);
}

#endif
