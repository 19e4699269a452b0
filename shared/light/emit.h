/* Emission, for light paths: rays that leave a light, and their densities. light/light.h is the counterpart for points
 * that are lit. */
#ifndef TWINLIGHT_LIGHT_EMIT_H
#define TWINLIGHT_LIGHT_EMIT_H

#include "light/light.h"

/* A ray that leaves a light from p along w. Its throughput is radiance * cosine / (select_pdf * pdf_p * pdf_w). */
typedef struct LightEmission {
    Vec3 p;
    Vec3 ng; /* area: geometric normal on the side that w leaves. Zero for other lights */
    Vec3 w; /* unit */
    Vec3 radiance; /* area, infinite: radiance. point, spot: intensity. distant: irradiance on a plane facing it */
    float pdf_p; /* area: per area of the light. infinite, distant: per area perpendicular to w. point, spot: 1 */
    float pdf_w; /* per solid angle; distant: 1 */
    float cosine; /* area: |ng.w|; else 1 */
    uint delta_position; /* 1: point, spot */
    uint delta_direction; /* 1: distant */
    uint infinite; /* 1: infinite, distant: p is not on the light */
} LightEmission;

/* ---- the disc that light from infinity comes through ------------------------------------------------------------- */

/* Radius of the disc: that of the scene's bounding sphere, plus what rounding of the centre and of points on the disc
 * may take away in a small scene far from (0,0,0). 0 if there is nothing to light. */
SHARED_FUNCTION float light_emit_disc_radius(const SceneView *scene)
{
    float radius = scene->frame->world_radius;
    float size = vec3_max_abs(scene->frame->world_center) + radius;
    return radius > 0.0f ? radius + 4.0f * FLOAT_EPSILON * size : 0.0f;
}

/* Density of points on the disc, 1 / (pi R^2); 0 if there is nothing to light. */
SHARED_FUNCTION float light_emit_pdf_disc(const SceneView *scene)
{
    float radius = light_emit_disc_radius(scene);
    return radius > 0.0f ? INV_PI / (radius * radius) : 0.0f;
}

/* Sets p, pdf_p and `infinite` for light from infinity, given w. p is uniform on a disc perpendicular to w that touches
 * the bounding sphere on the side that w comes from. */
SHARED_FUNCTION bool light_emit_from_disc(const SceneView *scene, Vec2 u, LightEmission *emission)
{
    float radius = light_emit_disc_radius(scene);
    Vec2 disc = warp_disk_concentric(u);
    Vec3 offset = frame_to_world(frame_from_normal(emission->w), vec3(disc.x, disc.y, -1.0f));
    emission->p = vec3_mad(scene->frame->world_center, radius, offset);
    emission->pdf_p = light_emit_pdf_disc(scene);
    emission->infinite = 1u;
    return emission->pdf_p > 0.0f && float_finite(emission->pdf_p);
}

SHARED_FUNCTION bool light_emit_infinite(const SceneView *scene, uint light, Vec2 u_point, Vec2 u_direction,
                                         LightEmission *emission)
{
    LightSample sample;
    if (!infinite_light_sample(scene, light, u_direction, &sample))
        return false;
    emission->w = vec3_negate(sample.wi);
    emission->radiance = sample.radiance;
    emission->pdf_w = sample.pdf_w;
    return light_emit_from_disc(scene, u_point, emission);
}

/* ---- point, spot, distant ---------------------------------------------------------------------------------------- */

/* Integral over cosines of the unnormalised density from which a spot's directions are drawn: 1 inside the falloff
 * angle, linear in the cosine down to 0 at the edge. The cubic falloff has the same integral, and is at most 9/8 of the
 * line. */
SHARED_FUNCTION float spot_emit_integral(__global const Light *spot)
{
    return (1.0f - spot->cos_falloff) + 0.5f * (spot->cos_falloff - spot->cos_total);
}

SHARED_FUNCTION float spot_emit_pdf_w(__global const Light *spot, float cosine)
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
SHARED_FUNCTION Vec3 spot_emit_direction(__global const Light *spot, Vec2 u)
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

SHARED_FUNCTION bool light_emit_delta(const SceneView *scene, uint light, Vec2 u_point, Vec2 u_direction,
                                      LightEmission *emission)
{
    __global const Light *source = scene->lights + light;
    emission->radiance = source->emission;
    if (source->kind == LIGHT_DISTANT) {
        emission->w = source->direction;
        emission->pdf_w = 1.0f;
        emission->delta_direction = 1u;
        return light_emit_from_disc(scene, u_point, emission);
    }
    emission->p = source->position;
    emission->pdf_p = 1.0f;
    emission->delta_position = 1u;
    if (source->kind == LIGHT_POINT) {
        emission->w = warp_sphere(u_direction);
        emission->pdf_w = INV_4PI;
        return true;
    }
    if (!(spot_emit_integral(source) > 0.0f))
        return false;
    emission->w = vec3_normalize(spot_emit_direction(source, u_direction));
    float cosine = vec3_dot(source->direction, emission->w);
    emission->pdf_w = spot_emit_pdf_w(source, cosine);
    emission->radiance = vec3_scale(source->emission, spot_falloff(cosine, source->cos_total, source->cos_falloff));
    return emission->pdf_w > 0.0f;
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
    }
    Vec3 w = frame_to_world(frame_from_normal(emission->ng), warp_cosine_hemisphere(u_direction));
    emission->w = vec3_normalize(w);
    emission->cosine = vec3_dot(emission->ng, emission->w);
    emission->pdf_w = area_emit_pdf_w(source, emission->ng, emission->w);
    emission->radiance = vec3_scale(source->emission, area_light_alpha(scene, &primitive, point.p, point.uv));
    return emission->pdf_w > 0.0f && emission->pdf_p > 0.0f && float_finite(emission->pdf_p);
}

/* ---- all --------------------------------------------------------------------------------------------------------- */

/* Draws a ray that leaves `light`. Area lights: the point by area_light_point, even on spheres, which light_sample
 * draws by solid angle; the direction with the cosine, on the side or sides that emit. Point lights: a uniform
 * direction; spots: roughly in proportion to their intensity. Light from infinity: the direction as in light_sample,
 * the point on a disc that covers the scene. False: no emission; *emission is then meaningless. */
SHARED_FUNCTION bool light_emit(const SceneView *scene, uint light, Vec2 u_point, Vec2 u_direction,
                                LightEmission *emission)
{
    uint kind = scene->lights[light].kind;
    bool done = false;
    emission->ng = vec3_splat(0.0f);
    emission->cosine = 1.0f;
    emission->delta_position = 0u;
    emission->delta_direction = 0u;
    emission->infinite = 0u;
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && kind == LIGHT_AREA)
        done = light_emit_area(scene, light, u_point, u_direction, emission);
    else if (SCENE_HAS(scene, FEATURE_INFINITE_LIGHT) && kind >= LIGHT_INFINITE)
        done = light_emit_infinite(scene, light, u_point, u_direction, emission);
    else if (SCENE_HAS(scene, FEATURE_DELTA_LIGHT))
        done = light_emit_delta(scene, light, u_point, u_direction, emission);
    return done && !vec3_is_zero(emission->radiance);
}

/* pdf_p of light_emit. Area lights: at their point `hit` (ng, u, v are read), per area; other lights do not read `hit`.
 * Infinite and distant: per area perpendicular to the light's direction. Point and spot: 1. */
SHARED_FUNCTION float light_emit_pdf_p(const SceneView *scene, uint light, const Surface *hit)
{
    uint kind = scene->lights[light].kind;
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && kind == LIGHT_AREA) {
        Primitive primitive = scene->primitives[scene->lights[light].primitive];
        float pdf = area_light_pdf_a(scene, light, &primitive, hit);
        return float_finite(pdf) ? pdf : 0.0f;
    }
    return kind == LIGHT_POINT || kind == LIGHT_SPOT ? 1.0f : light_emit_pdf_disc(scene);
}

/* pdf_w of light_emit, of leaving along w (unit, the direction in which light travels). Area lights: from a point with
 * normal ng (either of the two if both sides emit). Distant: 1. */
SHARED_FUNCTION float light_emit_pdf_w(const SceneView *scene, uint light, Vec3 ng, Vec3 w)
{
    __global const Light *source = scene->lights + light;
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && source->kind == LIGHT_AREA)
        return area_emit_pdf_w(source, ng, w);
    if (SCENE_HAS(scene, FEATURE_INFINITE_LIGHT) && source->kind >= LIGHT_INFINITE)
        return environment_pdf_w(scene, light, vec3_negate(w));
    if (source->kind == LIGHT_SPOT)
        return spot_emit_pdf_w(source, vec3_dot(source->direction, w));
    return source->kind == LIGHT_POINT ? INV_4PI : 1.0f;
}

#endif
