/* Light at infinity from all directions: constant, or an image. */
#ifndef TWINLIGHT_LIGHT_INFINITE_H
#define TWINLIGHT_LIGHT_INFINITE_H

#include "geometry/texture.h"
#include "layout/distribution.h"
#include "layout/path_types.h"
#include "layout/scene_view.h"
#include "math/warp.h"

/* Radiance of the light's image at uv (v = 0 is row 0), filtered as the image says and clamped to >= 0 in every
 * channel. Latitude-longitude images are not interpolated across the poles. */
SHARED_FUNCTION Vec3 environment_image(const SceneView *scene, uint light, Vec2 uv)
{
    __global const Light *source = scene->lights + light;
    float v = uv.y;
    if ((source->flags & LIGHT_EQUIRECTANGULAR) != 0u) {
        float half_texel = 0.5f / (float)scene->images[source->image].height;
        v = float_clamp(v, half_texel, 1.0f - half_texel);
    }
    Vec3 c = vec3_mul(image_lookup(scene, source->image, vec2(uv.x, 1.0f - v)), source->emission);
    return vec3(float_max(c.x, 0.0f), float_max(c.y, 0.0f), float_max(c.z, 0.0f));
}

/* Image coordinates of the world direction d (unit); *pdf_uniform: solid-angle density of d if uv is uniform. If the
 * transform M from world to light stretches, d -> M d / |M d| scales solid angles by |det M| / |M d|^3: a cone of
 * height 1 has a third of its solid angle as volume, M scales that by |det M|, and the resulting cone has height |M d|
 * instead of 1. */
SHARED_FUNCTION Vec2 environment_uv(const SceneView *scene, uint light, Vec3 d, float *pdf_uniform)
{
    __global const Light *source = scene->lights + light;
    Affine light_from_world = source->light_from_world;
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

/* Radiance that arrives from direction d (unit, away from the scene) of one infinite light. */
SHARED_FUNCTION Vec3 environment_light_radiance(const SceneView *scene, uint light, Vec3 d)
{
    if (scene->lights[light].kind != LIGHT_INFINITE_IMAGE)
        return scene->lights[light].emission;
    float pdf_uniform;
    return environment_image(scene, light, environment_uv(scene, light, d, &pdf_uniform));
}

/* The sum of environment_light_radiance over all infinite lights. */
SHARED_FUNCTION Vec3 environment_radiance(const SceneView *scene, Vec3 d)
{
    Vec3 sum = vec3_splat(0.0f);
    if (!SCENE_HAS(scene, FEATURE_INFINITE_LIGHT))
        return sum;
    for (uint i = 0; i < scene->frame->scene.infinite_light_count; ++i)
        sum = vec3_add(sum, environment_light_radiance(scene, scene->infinite_lights[i], d));
    return sum;
}

/* Density per solid angle with which infinite_light_sample draws d, given the light. */
SHARED_FUNCTION float environment_pdf_w(const SceneView *scene, uint light, Vec3 d)
{
    if (scene->lights[light].kind != LIGHT_INFINITE_IMAGE)
        return INV_4PI;
    float pdf_uniform;
    Vec2 uv = environment_uv(scene, light, d, &pdf_uniform);
    if (!float_finite(pdf_uniform))
        return 0.0f;
    return distribution2d_pdf(scene->lookup, scene->distributions2d[scene->lights[light].distribution], uv) *
           pdf_uniform;
}

SHARED_FUNCTION bool infinite_light_sample(const SceneView *scene, uint light, Vec2 u, LightSample *sample)
{
    __global const Light *source = scene->lights + light;
    sample->p = vec3_splat(0.0f);
    sample->ng = vec3_splat(0.0f);
    sample->delta = 0u;
    sample->infinite = 1u;
    if (source->kind != LIGHT_INFINITE_IMAGE) {
        sample->wi = warp_sphere(u);
        sample->pdf_w = INV_4PI;
        sample->radiance = source->emission;
        return !vec3_is_zero(sample->radiance);
    }
    float pdf;
    Vec2 uv = distribution2d_sample(scene->lookup, scene->distributions2d[source->distribution], u, &pdf);
    bool equirectangular = (source->flags & LIGHT_EQUIRECTANGULAR) != 0u;
    Vec3 w = equirectangular ? equirectangular_to_sphere(uv) : octahedral_to_sphere(uv);
    Affine world_from_light = source->world_from_light;
    Vec3 d = affine_vector(world_from_light, w);
    float length = vec3_length(d);
    sample->wi = vec3_scale(d, 1.0f / length);
    /* |M wi| of environment_uv is 1 / length. */
    sample->pdf_w = pdf * (equirectangular ? equirectangular_pdf(w) : INV_4PI) * (length * length * length);
    sample->radiance = environment_image(scene, light, uv);
    return sample->pdf_w > 0.0f && float_finite(sample->pdf_w) && !vec3_is_zero(sample->radiance);
}

#endif
