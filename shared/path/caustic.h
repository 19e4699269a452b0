/* A receiver's direction drawn by photons (path/caustic_rest.h), and the smooth specular vertices that it passes on the
 * way to a light. Path tracing does this; its state has fields for it (path/path_state.h). */
#ifndef TWINLIGHT_PATH_CAUSTIC_H
#define TWINLIGHT_PATH_CAUSTIC_H

#include "bsdf/bsdf.h"
#include "bsdf/material.h"
#include "geometry/media_walk.h"
#include "geometry/ray.h"
#include "layout/diagnostics.h"
#include "light/light.h"
#include "path/caustic_rest.h"
#include "path/passage.h"
#include "path/path_gather.h"
#include "path/path_random.h"
#include "path/path_state.h"

/* Blocks of random numbers from one direction of a receiver to its next. */
#define CAUSTIC_DRAW_BLOCKS 0x10000u

/* Random numbers of the latest direction of the receiver after `depth` segments: `what` 0 for the photon and the
 * direction, then the smooth vertices in order. */
SHARED_FUNCTION Random4 caustic_random(__global const FrameParams *frame, __global const uint *paths, uint item,
                                       uint depth, uint what)
{
    uint stride = frame->pass.stride, draw = state_load(paths, stride, PATH_CAUSTIC_DRAWN, item) - 1u;
    return sample_random(frame, state_load(paths, stride, PATH_PIXEL, item),
                         state_load(paths, stride, PATH_SAMPLE, item),
                         draw * CAUSTIC_DRAW_BLOCKS + depth * (CAUSTIC_VERTICES + 1u) + what, PATH_STREAM_CAUSTIC, 1u);
}

/* Draws the next direction of the path's vertex and stores its ray; none if it has drawn all, there are no photons
 * around, or it brings nothing. Of several, each chooses among its part of the photons. */
SHARED_FUNCTION void caustic_begin(const SceneView *scene, __global uint *restrict paths, __global uint *restrict rays,
                                   uint item)
{
    __global const FrameParams *frame = scene->frame;
    PhotonParams params = frame->photons;
    uint stride = frame->pass.stride, depth = state_load(paths, stride, PATH_DEPTH, item);
    uint delta = state_load(paths, stride, PATH_DELTA, item),
         drawn = state_load(paths, stride, PATH_CAUSTIC_DRAWN, item);
    const uint draws = receiver_draw_count(depth);
    state_store(paths, stride, PATH_CAUSTIC_DRAWN, item, drawn + 1u);
    if (drawn >= draws || depth + 2u > frame->path.max_depth ||
        (state_load(paths, stride, PATH_BSDF + STORED_BSDF_FLAGS, item) & BSDF_SMOOTH) != 0u ||
        bsdf_kind_load(scene, paths, stride, PATH_BSDF, item) == MATERIAL_PHASE ||
        !receiver_draws(params.everywhere, delta, depth))
        return;
    Vec3 p = state_load_vec3(paths, stride, PATH_POINT, item);
    PhotonSets found = photon_sets(params, scene->photons, p);
    if (!(found.weight > 0.0f))
        return;
    Random4 random = caustic_random(frame, paths, item, depth, 0u);
    float choice = ((float)drawn + random_float(random.x[0])) / (float)draws;
    PhotonLobe lobe = photon_lobe(params, scene->photons, photon_choose(&found, choice), p);
    Vec3 w;
    if (!photon_lobe_sample(&lobe, vec2(random_float(random.x[1]), random_float(random.x[2])), &w))
        return;
    Bsdf bsdf = bsdf_load(scene, paths, stride, PATH_BSDF, item);
    Frame shading = frame_load(paths, stride, PATH_FRAME, item);
    BsdfValue value = bsdf_eval(scene, &bsdf, state_load_vec3(paths, stride, PATH_WO, item), frame_to_local(shading, w),
                                TRANSPORT_RADIANCE);
    float density = (float)draws * photon_density(params, scene->photons, &found, p, w, lobe.light);
    if (lobe.light == NONE) { /* lights of no extent are hit by nothing else */
        if (caustic_rest_of(value.pdf_w, density) == 1.0f)
            return;
        density += value.pdf_w;
    }
    Vec3 beta = vec3_mul(state_load_vec3(paths, stride, PATH_BETA, item), value.f_cos);
    Ray ray = ray_spawn(p, state_load_vec3(paths, stride, PATH_NG, item), w);
    if (vec3_is_zero(value.f_cos) || !(density > 0.0f) || !ray_traceable(ray.o, ray.d))
        return;
    ray_store(rays, stride, item, ray);
    ray_medium_store(scene, rays, stride, item,
                     medium_towards(bsdf.media, state_load_vec3(paths, stride, PATH_NG, item), w));
    state_store(paths, stride, PATH_CAUSTIC_SEGMENTS, item, depth + 1u);
    state_store(paths, stride, PATH_CAUSTIC_LIGHT, item, lobe.light);
    state_store_vec3(paths, stride, PATH_CAUSTIC_BETA, item, vec3_scale(beta, 1.0f / density));
    bool found_by_chance = lobe.light == NONE && value.pdf_w > 0.0f;
    state_store_float(paths, stride, PATH_CAUSTIC_OVER, item, found_by_chance ? density / value.pdf_w : FLOAT_INFINITY);
}

/* Adds light that the caustic path of `segments` segments has found. alpha: light_hit_alpha, as in path_add_met. */
SHARED_FUNCTION void caustic_gather(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                    uint segments, Vec3 light, float alpha)
{
    uint stride = frame->pass.stride;
    if (receiver_draws(0u, state_load(paths, stride, PATH_DELTA, item), state_load(paths, stride, PATH_DEPTH, item))) {
        path_add_own(frame, paths, item, segments, light);
        return;
    }
    float path_tracing = rgb_luminance(light) * alpha * state_load_float(paths, stride, PATH_CAUSTIC_OVER, item);
    path_add_radiance(frame, paths, item, segments, light, path_shown(frame, paths, item, segments, path_tracing));
}

/* ---- lights at the end ------------------------------------------------------------------------------------------- */

/* How far along the ray (d unit) a light at a point is, which counts as a sphere of PhotonParams.point_radius; 0: the
 * ray passes it by. */
SHARED_FUNCTION float caustic_point_distance(const SceneView *scene, __global const Light *source, Ray ray)
{
    Vec3 to_light = vec3_sub(light_detail(scene, source)->position, ray.o);
    float along = vec3_dot(to_light, ray.d), radius = scene->frame->photons.point_radius;
    bool seen = along > 0.0f && vec3_length_squared(vec3_cross(to_light, ray.d)) < radius * radius;
    return seen ? along : 0.0f;
}

/* Radiance of that sphere, which has the light's power, along a ray of direction d. */
SHARED_FUNCTION Vec3 caustic_point_radiance(const SceneView *scene, __global const Light *source, Vec3 d)
{
    float radius2 = scene->frame->photons.point_radius * scene->frame->photons.point_radius;
    return vec3_scale(delta_light_emitted(scene, source, vec3_negate(d)), INV_PI / radius2);
}

/* Whether shadow rays find lights at a point: in media, where of a ray the optical depth up to its end alone is known,
 * and such a light may lie before that. */
SHARED_FUNCTION bool caustic_has_shadows(ulong features)
{
    return (features & FEATURE_MEDIUM) != 0u && (features & FEATURE_DELTA_LIGHT) != 0u;
}

/* In scenes with such shadow rays: stores that of the caustic path's next ray, to the light at a point that the path
 * was drawn for, if the ray meets it. */
SHARED_FUNCTION_APART void caustic_shadow_store(const SceneView *scene, __global const uint *restrict paths,
                                                __global const uint *restrict rays, __global uint *restrict shadows,
                                                uint item)
{
    uint stride = scene->frame->pass.stride, light = state_load(paths, stride, PATH_CAUSTIC_LIGHT, item);
    if (light == NONE || !light_has_position(light_kind(scene->lights + light)))
        return;
    Ray ray = ray_load(rays, stride, item);
    ray.t_max = caustic_point_distance(scene, scene->lights + light, ray);
    ray_store(shadows, stride, item, ray);
    shadow_medium_store(scene, shadows, stride, item, state_load(rays, stride, RAY_MEDIUM, item));
}

/* What such a shadow ray, which has been traced, brings to the caustic path from its light; then clears it. */
SHARED_FUNCTION_APART Vec3 caustic_shadow_radiance(const SceneView *scene, __global const uint *restrict paths,
                                                   __global uint *restrict shadows, uint item)
{
    uint stride = scene->frame->pass.stride, light = state_load(paths, stride, PATH_CAUSTIC_LIGHT, item);
    if (!(state_load_float(shadows, stride, RAY_T_MAX, item) > 0.0f))
        return vec3_splat(0.0f);
    state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    if (state_load(shadows, stride, SHADOW_OCCLUDED, item) != 0u)
        return vec3_splat(0.0f);
    Vec3 radiance =
        caustic_point_radiance(scene, scene->lights + light, state_load_vec3(shadows, stride, RAY_DIRECTION, item));
    return vec3_mul(radiance, passage_shadow(scene, shadows, stride, item).weight);
}

/* Radiance of a light of no extent along a ray (d unit) that goes as far as t_max (FLOAT_INFINITY: misses): of a sphere
 * (caustic_point_radiance), unless shadow rays find it, or of a cone of PhotonParams.distant_sine with the light's
 * power. */
SHARED_FUNCTION Vec3 caustic_delta_radiance(const SceneView *scene, uint light, Ray ray, float t_max)
{
    __global const Light *source = scene->lights + light;
    PhotonParams params = scene->frame->photons;
    if (light_kind(source) == LIGHT_DISTANT) {
        float sine2 = params.distant_sine * params.distant_sine;
        Vec3 direction = light_detail(scene, source)->direction;
        bool seen = vec3_dot(ray.d, direction) < 0.0f && vec3_length_squared(vec3_cross(ray.d, direction)) < sine2;
        return vec3_scale(source->emission, seen && t_max == FLOAT_INFINITY ? INV_PI / sine2 : 0.0f);
    }
    float along = SCENE_HAS(scene, FEATURE_MEDIUM) ? 0.0f : caustic_point_distance(scene, source, ray);
    if (!(along > 0.0f && along < t_max))
        return vec3_splat(0.0f);
    return caustic_point_radiance(scene, source, ray.d);
}

/* What the ray of a caustic path brings from lights that it hits, or from infinity. *alpha: light_hit_alpha. */
SHARED_FUNCTION Vec3 caustic_radiance(const SceneView *scene, uint light, Ray ray, Hit hit, const Surface *surface,
                                      float *alpha)
{
    *alpha = 1.0f;
    if (light != NONE)
        return caustic_delta_radiance(scene, light, ray, hit.primitive == NONE ? FLOAT_INFINITY : hit.t);
    if (hit.primitive == NONE)
        return environment_radiance(scene, ray.o, ray.d);
    __global const Shape *shape = scene->shapes + surface->shape;
    if (!SCENE_HAS(scene, FEATURE_AREA_LIGHT) || shape->first_light == NONE)
        return vec3_splat(0.0f);
    uint lamp = shape->first_light + hit.primitive - shape->first_primitive;
    *alpha = light_hit_alpha(scene, lamp, surface);
    return light_emitted(scene, lamp, surface->ng, vec3_negate(ray.d));
}

/* ---- smooth vertices --------------------------------------------------------------------------------------------- */

/* What a surface does to a path that a delta lobe is drawn for. */
typedef struct DeltaScatter {
    Ray ray; /* on */
    uint medium; /* in which it begins */
    Vec3 weight; /* factor of the throughput */
    bool transmitted;
    bool smooth; /* the surface has delta lobes alone */
} DeltaScatter;

/* Draws a lobe at a surface that a ray in `medium` has hit along d; false if it is no delta or brings nothing. random:
 * the lobe, its point, mix materials. */
SHARED_FUNCTION bool delta_scatter(const SceneView *scene, Surface *surface, Vec3 d, uint medium, uint transport,
                                   Random4 random, DeltaScatter *scatter)
{
    Bsdf bsdf;
    Frame frame;
    BsdfSample sample = {0};
    float u_mix = SCENE_HAS(scene, FEATURE_MIX) ? random_float(random.x[3]) : 0.5f;
    material_resolve(scene, u_mix, surface, &bsdf, &frame);
    scatter->smooth = (bsdf.flags & BSDF_SMOOTH) != 0u;
    if (!bsdf_sample(scene, &bsdf, frame_to_local(frame, vec3_negate(d)), random_float(random.x[0]),
                     vec2(random_float(random.x[1]), random_float(random.x[2])), transport, &sample) ||
        sample.delta == 0u)
        return false;
    scatter->weight = sample.weight;
    scatter->transmitted = sample.transmitted != 0u;
    scatter->ray = ray_spawn(surface->p, surface->ng, vec3_normalize(frame_to_world(frame, sample.wi)));
    scatter->medium = medium_towards(media_at(scene, surface->shape, medium), surface->ng, scatter->ray.d);
    return !vec3_is_zero(sample.weight) && ray_traceable(scatter->ray.o, scatter->ray.d);
}

/* Continues a caustic path at what its ray, in `medium`, has hit along d; false if it ends there. */
SHARED_FUNCTION bool caustic_continue(const SceneView *scene, __global uint *restrict paths,
                                      __global uint *restrict rays, uint item, Surface *surface, Vec3 d, uint medium)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, segments = state_load(paths, stride, PATH_CAUSTIC_SEGMENTS, item);
    uint depth = state_load(paths, stride, PATH_DEPTH, item), vertex = segments - depth;
    DeltaScatter scatter;
    if (segments >= frame->path.max_depth || vertex > CAUSTIC_VERTICES ||
        !delta_scatter(scene, surface, d, medium, TRANSPORT_RADIANCE, caustic_random(frame, paths, item, depth, vertex),
                       &scatter))
        return false;
    ray_store(rays, stride, item, scatter.ray);
    ray_medium_store(scene, rays, stride, item, scatter.medium);
    state_store(paths, stride, PATH_CAUSTIC_SEGMENTS, item, segments + 1u);
    state_store_vec3(paths, stride, PATH_CAUSTIC_BETA, item,
                     vec3_mul(scatter.weight, state_load_vec3(paths, stride, PATH_CAUSTIC_BETA, item)));
    return true;
}

#endif
