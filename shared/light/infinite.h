/* Light at infinity from all directions: constant, or an image; perhaps seen through a portal alone. */
#ifndef TWINLIGHT_LIGHT_INFINITE_H
#define TWINLIGHT_LIGHT_INFINITE_H

#include "geometry/texture.h"
#include "layout/distribution.h"
#include "layout/path_types.h"
#include "layout/scene_view.h"
#include "light/portal.h"
#include "math/warp.h"

/* Whether the light has a portal. */
SHARED_FUNCTION bool light_has_portal(const SceneView *scene, uint light)
{
    return SCENE_HAS(scene, FEATURE_PORTAL) && light_kind(scene->lights + light) == LIGHT_PORTAL;
}

SHARED_FUNCTION Portal light_portal(const SceneView *scene, uint light)
{
    return scene->portals[light_detail(scene, scene->lights + light)->portal];
}

/* Whether a light at infinity reaches p from direction d (unit, away from the scene), occlusion ignored: not past its
 * portal. */
SHARED_FUNCTION bool environment_reaches(const SceneView *scene, uint light, Vec3 p, Vec3 d)
{
    if (!light_has_portal(scene, light))
        return true;
    Portal portal = light_portal(scene, light);
    return portal_lights(&portal, p) && portal_crossed(&portal, p, d);
}

/* Radiance of the light's image at uv (v = 0 is row 0), filtered as the image says and clamped to >= 0 in every
 * channel. Latitude-longitude images are not interpolated across the poles. */
SHARED_FUNCTION Vec3 environment_image(const SceneView *scene, uint light, Vec2 uv)
{
    __global const Light *source = scene->lights + light;
    uint image = light_detail(scene, source)->image;
    float v = uv.y;
    if ((source->flags & LIGHT_EQUIRECTANGULAR) != 0u) {
        float half_texel = 0.5f / (float)scene->images[image].height;
        v = float_clamp(v, half_texel, 1.0f - half_texel);
    }
    Vec3 c = vec3_mul(image_lookup(scene, image, vec2(uv.x, 1.0f - v)), source->emission);
    return vec3(float_max(c.x, 0.0f), float_max(c.y, 0.0f), float_max(c.z, 0.0f));
}

/* Image coordinates of the world direction d (unit); *pdf_uniform: solid-angle density of d if uv is uniform. If the
 * transform M from world to light stretches, d -> M d / |M d| scales solid angles by |det M| / |M d|^3: a cone of
 * height 1 has a third of its solid angle as volume, M scales that by |det M|, and the resulting cone has height |M d|
 * instead of 1. */
SHARED_FUNCTION Vec2 environment_uv(const SceneView *scene, uint light, Vec3 d, float *pdf_uniform)
{
    __global const Light *source = scene->lights + light;
    Affine light_from_world = light_detail(scene, source)->light_from_world;
    Vec3 w = affine_vector(light_from_world, d);
    float length = vec3_length(w);
    w = vec3_scale(w, 1.0f / length);
    /* |det M| = 1 (layout/scene_types.h). */
    float stretch = 1.0f / (length * length * length);
    if ((source->flags & LIGHT_EQUIRECTANGULAR) != 0u) {
        *pdf_uniform = stretch * equirectangular_pdf(w);
        return sphere_to_equirectangular(w);
    }
    *pdf_uniform = stretch * INV_4PI;
    return sphere_to_octahedral(w);
}

/* Radiance of an infinite light from direction d (unit, away from the scene), where it is seen. */
SHARED_FUNCTION Vec3 environment_beyond(const SceneView *scene, uint light, Vec3 d)
{
    __global const Light *source = scene->lights + light;
    uint kind = light_kind(source);
    if (kind == LIGHT_INFINITE || (kind == LIGHT_PORTAL && light_detail(scene, source)->image == NONE))
        return source->emission;
    float pdf_uniform;
    return environment_image(scene, light, environment_uv(scene, light, d, &pdf_uniform));
}

/* The same as it arrives at p. */
SHARED_FUNCTION Vec3 environment_light_radiance(const SceneView *scene, uint light, Vec3 p, Vec3 d)
{
    return environment_reaches(scene, light, p, d) ? environment_beyond(scene, light, d) : vec3_splat(0.0f);
}

/* The sum of environment_light_radiance over all infinite lights. */
SHARED_FUNCTION Vec3 environment_radiance(const SceneView *scene, Vec3 p, Vec3 d)
{
    Vec3 sum = vec3_splat(0.0f);
    if (!SCENE_HAS(scene, FEATURE_INFINITE_LIGHT))
        return sum;
    for (uint i = 0; i < scene->frame->scene.infinite_light_count; ++i)
        sum = vec3_add(sum, environment_light_radiance(scene, scene->infinite_lights[i], p, d));
    return sum;
}

/* Density per solid angle with which light subpaths come from d, given the light. Unless it has a portal,
 * infinite_light_sample draws d with the same density. */
SHARED_FUNCTION float environment_pdf_w(const SceneView *scene, uint light, Vec3 d)
{
    __global const Light *source = scene->lights + light;
    if (light_kind(source) == LIGHT_INFINITE)
        return INV_4PI;
    float pdf_uniform, stretch;
    Vec2 uv;
    if (light_has_portal(scene, light)) {
        Portal portal = light_portal(scene, light);
        if (!portal_uv(&portal, d, &uv, &stretch))
            return 0.0f;
        pdf_uniform = 1.0f / stretch;
    } else {
        uv = environment_uv(scene, light, d, &pdf_uniform);
    }
    if (!float_finite(pdf_uniform))
        return 0.0f;
    Distribution2D directions = scene->distributions2d[light_detail(scene, source)->distribution];
    return distribution2d_pdf(scene->lookup, directions, uv) * pdf_uniform;
}

/* Density per solid angle with which infinite_light_sample draws d at p, given the light. */
SHARED_FUNCTION float environment_sample_pdf_w(const SceneView *scene, uint light, Vec3 p, Vec3 d)
{
    if (!light_has_portal(scene, light))
        return environment_pdf_w(scene, light, d);
    Portal portal = light_portal(scene, light);
    float pdf = portal_pdf_w(scene, &portal, p, d);
    return float_finite(pdf) ? pdf : 0.0f;
}

/* infinite_light_sample of a light with a portal: a direction in its window. */
SHARED_FUNCTION_APART void portal_light_sample(const SceneView *scene, uint light, Vec3 ref, Vec2 u,
                                               LightSample *sample)
{
    Portal portal = light_portal(scene, light);
    PortalWindow window;
    sample->pdf_w = 0.0f;
    if (!portal_window(&portal, ref, &window))
        return;
    float pdf, stretch;
    Vec2 uv = portal_sample(scene, &portal, &window, u, &pdf);
    sample->wi = portal_direction(&portal, uv, &stretch);
    sample->pdf_w = pdf / stretch;
    sample->pdf_emit = environment_pdf_w(scene, light, sample->wi);
    sample->radiance = environment_beyond(scene, light, sample->wi);
}

/* infinite_light_sample of an image that is seen from everywhere. */
SHARED_FUNCTION void image_light_sample(const SceneView *scene, uint light, Vec2 u, LightSample *sample)
{
    __global const Light *source = scene->lights + light;
    __global const LightDetail *detail = light_detail(scene, source);
    float pdf;
    Vec2 uv = distribution2d_sample(scene->lookup, scene->distributions2d[detail->distribution], u, &pdf);
    bool equirectangular = (source->flags & LIGHT_EQUIRECTANGULAR) != 0u;
    Vec3 w = equirectangular ? equirectangular_to_sphere(uv) : octahedral_to_sphere(uv);
    Affine world_from_light = detail->world_from_light;
    Vec3 d = affine_vector(world_from_light, w);
    float length = vec3_length(d);
    sample->wi = vec3_scale(d, 1.0f / length);
    /* |M wi| of environment_uv is 1 / length. */
    sample->pdf_w = pdf * (equirectangular ? equirectangular_pdf(w) : INV_4PI) * (length * length * length);
    sample->pdf_emit = sample->pdf_w;
    sample->radiance = environment_image(scene, light, uv);
}

/* Draws a direction from which the light may reach ref. False: no light. */
SHARED_FUNCTION bool infinite_light_sample(const SceneView *scene, uint light, Vec3 ref, Vec2 u, LightSample *sample)
{
    __global const Light *source = scene->lights + light;
    sample->p = vec3_splat(0.0f);
    sample->ng = vec3_splat(0.0f);
    sample->delta = 0u;
    sample->infinite = 1u;
    if (light_kind(source) == LIGHT_INFINITE) {
        sample->wi = warp_sphere(u);
        sample->pdf_w = INV_4PI;
        sample->pdf_emit = INV_4PI;
        sample->radiance = source->emission;
        return !vec3_is_zero(sample->radiance);
    }
    if (light_has_portal(scene, light))
        portal_light_sample(scene, light, ref, u, sample);
    else
        image_light_sample(scene, light, u, sample);
    return sample->pdf_w > 0.0f && float_finite(sample->pdf_w) && !vec3_is_zero(sample->radiance);
}

#endif
