/* Path tracing, one kernel per stage. Per segment: (rays traced) pt_shade_hits, pt_sample_lights, (shadow rays traced)
 * pt_add_lights, pt_extend_paths; around them pt_start_paths and pt_splat. Next-event estimation with multiple
 * importance sampling over the strategies s = 0 and s = 1 (Veach 1997, chapter 9); Russian roulette by throughput. */
#ifndef TWINLIGHT_PT_CL
#define TWINLIGHT_PT_CL

#include "bsdf/bsdf.h"
#include "bsdf/material.h"
#include "camera/film_splat.h"
#include "camera/splat_offset.h"
#include "camera/view.h"
#include "geometry/ray.h"
#include "geometry/surface.h"
#include "layout/diagnostics.h"
#include "layout/item.h"
#include "light/light.h"
#include "path/caustic_rest.h"
#include "path/mis.h"
#include "path/partition.h"
#include "path/passage.h"
#include "path/path_gather.h"
#include "path/path_random.h"
#include "path/path_state.h"

/* Vertices before this one always survive Russian roulette, and paths whose throughput is at least this. With 1 instead
 * of 0.25 the square error is 1.4 to 2.1 times as large, for 7 to 41 % less time (docs/TUNING.md). */
#define ROULETTE_FIRST_DEPTH 2u
#define ROULETTE_THROUGHPUT 0.25f

/* With frame->partition.split_direct: the least probability of a path to survive roulette; below it, reweighted
 * survivors would exceed the clamp. */
#define SURVIVED_LEAST 0.125f

SHARED_FUNCTION void path_end(__global uint *restrict paths, __global uint *restrict rays, uint stride, uint item)
{
    state_store(paths, stride, PATH_DEPTH, item, 0u);
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
}

/* The stored ray, which ends segment `depth` of the path, begins in `medium`. */
SHARED_FUNCTION_APART void path_ray_media(const SceneView *scene, __global const uint *restrict paths,
                                          __global uint *restrict rays, uint item, uint medium, uint depth)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride;
    ray_medium_store(scene, rays, stride, item, medium);
    if (!SCENE_HAS(scene, FEATURE_SCATTERING) || frame->pass.aovs != 0u)
        return;
    Random4 random = path_random(frame, state_load(paths, stride, PATH_PIXEL, item),
                                 state_load(paths, stride, PATH_SAMPLE, item), path_random_block(depth, RANDOM_MIX));
    ray_distance_draw(rays, stride, item, random.x[1]);
}

/* From: nothing. To: the path's first ray, throughput 1. */
__kernel void pt_start_paths(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                             __global const uint *restrict geometry, __global const uint *restrict tables,
                             __global const uint *restrict texels, __global uint *restrict paths,
                             __global uint *restrict rays, __global uint *restrict shadows,
                             __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    ItemPlace place = item_place(frame, item);
    uint pixel = place.pixel, sample = place.sample;
    Random4 random = path_random(frame, pixel, sample, RANDOM_CAMERA);
    float weight;
    Vec2 offset = pixel_filter_sample(scene, vec2(random_float(random.x[0]), random_float(random.x[1])), &weight);
    uint row = pixel / frame->film.width, column = pixel % frame->film.width;
    Vec2 film = vec2((float)column + 0.5f + offset.x, (float)row + 0.5f + offset.y);
    Ray ray = view_ray(scene, film, vec2(random_float(random.x[2]), random_float(random.x[3])));
    ray_store(rays, stride, item, ray);
    state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    state_store(paths, stride, PATH_PIXEL, item, pixel);
    state_store(paths, stride, PATH_SAMPLE, item, sample);
    state_store(paths, stride, PATH_DEPTH, item, 1u);
    state_store(paths, stride, PATH_FLAGS, item, PATH_FLAG_DELTA);
    state_store_float(paths, stride, PATH_WEIGHT, item, weight);
    state_store(paths, stride, PATH_OFFSET, item, splat_offset(&frame->film, pixel, film));
    state_store_vec3(paths, stride, PATH_BETA, item, vec3_splat(1.0f));
    state_store_vec3(paths, stride, PATH_RADIANCE, item, vec3_splat(0.0f));
    state_store_float(paths, stride, PATH_PDF_W, item, 1.0f);
    state_store_float(paths, stride, PATH_ETA_SCALE, item, 1.0f);
    if (frame->film.split_depths != 0u)
        state_store(paths, stride, PATH_GATHERED, item, 0u);
    if (frame->pass.aovs != 0u)
        state_store(paths, stride, PATH_AOV, item, 0u);
    if (frame->partition.split_direct != 0u) {
        state_store_float(paths, stride, PATH_LIMIT, item,
                          partition_threshold(frame, PARTITION_PATHS) / film_importance(frame, guide, film));
        state_store_float(paths, stride, PATH_SURVIVED, item, 1.0f);
        state_store_vec3(paths, stride, PATH_RARE, item, vec3_splat(0.0f));
        state_store_vec3(paths, stride, PATH_OWN, item, vec3_splat(0.0f));
    }
    if (frame->photons.count > 0u) {
        state_store(paths, stride, PATH_DELTA, item, 0u);
        state_store(paths, stride, PATH_CAUSTIC_DRAWN, item, 0u);
    }
    state_store_vec3(paths, stride, PATH_POINT, item, ray.o);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        path_ray_media(scene, paths, rays, item, frame->camera.medium, 1u);
    if (!ray_traceable(ray.o, ray.d)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_RAY_RANGE);
        path_end(paths, rays, stride, item);
    }
}

/* s = 0: the camera's path hits a light of `radiance`, which light sampling would have found with density `pdf_other`
 * (0: never). alpha: light_hit_alpha, a factor of the path's contribution that this strategy has as a probability. */
SHARED_FUNCTION void path_add_met(const SceneView *scene, __global uint *restrict paths, uint item, Vec3 radiance,
                                  float pdf_other, float alpha)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride;
    float weight = 1.0f, balance = 1.0f;
    if (pdf_other > 0.0f) {
        float pdf = state_load_float(paths, stride, PATH_PDF_W, item);
        weight = mis_power(pdf, pdf_other);
        balance = mis_balance(pdf, pdf_other);
    }
    Vec3 light = vec3_mul(state_load_vec3(paths, stride, PATH_BETA, item), radiance);
    uint segments = state_load(paths, stride, PATH_DEPTH, item);
    float rest = 1.0f, luminance = rgb_luminance(light);
    if (frame->photons.count > 0u) {
        uint delta = state_load(paths, stride, PATH_DELTA, item);
        rest = receiver_rest(scene, paths, PATH_RECEIVER, item, delta, segments - 1u);
        luminance *= receiver_find(0u, delta, segments - 1u) != 0u ? rest : 1.0f;
    }
    float shown = path_shown(frame, paths, item, segments, luminance * balance * alpha);
    path_add_radiance(frame, paths, item, segments, vec3_scale(light, rest * weight), shown);
}

/* The probability with which the vertex that the path has left chooses the light. */
SHARED_FUNCTION float path_choice_pdf(const SceneView *scene, __global const uint *paths, uint item, uint light)
{
    uint stride = scene->frame->pass.stride;
    return light_choice_pdf(scene, light, state_load_vec3(paths, stride, PATH_POINT, item),
                            state_load_vec3(paths, stride, PATH_NG, item));
}

/* Adds what the environment sends along the ray of a path, which has missed, weighted against light sampling. */
SHARED_FUNCTION void path_add_environment(const SceneView *scene, __global uint *restrict paths, uint item,
                                          const Ray *ray)
{
    uint flags = state_load(paths, scene->frame->pass.stride, PATH_FLAGS, item);
    for (uint i = 0; i < scene->frame->scene.infinite_light_count; ++i) {
        uint light = scene->infinite_lights[i];
        float pdf_light = 0.0f;
        if (!environment_reaches(scene, light, ray->o, ray->d))
            continue;
        if ((flags & PATH_FLAG_DELTA) == 0u)
            pdf_light =
                path_choice_pdf(scene, paths, item, light) * environment_sample_pdf_w(scene, light, ray->o, ray->d);
        path_add_met(scene, paths, item, environment_beyond(scene, light, ray->d), pdf_light, 1.0f);
    }
}

/* The same for the area light at `surface`. */
SHARED_FUNCTION void path_add_emission(const SceneView *scene, __global uint *restrict paths, uint item, uint light,
                                       const Surface *surface, Vec3 d)
{
    uint stride = scene->frame->pass.stride, flags = state_load(paths, stride, PATH_FLAGS, item);
    Vec3 radiance = light_emitted(scene, light, surface->ng, vec3_negate(d));
    float pdf_light = 0.0f;
    if (vec3_is_zero(radiance))
        return;
    if ((flags & PATH_FLAG_DELTA) == 0u)
        pdf_light = path_choice_pdf(scene, paths, item, light) *
                    light_pdf_w(scene, light, state_load_vec3(paths, stride, PATH_POINT, item), d, surface);
    path_add_met(scene, paths, item, radiance, pdf_light, light_hit_alpha(scene, light, surface));
}

/* Stores the path's vertex, except for its Bsdf. */
SHARED_FUNCTION void path_vertex_store(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                       Vec3 p, Vec3 ng, Vec3 wo, const Frame *shading)
{
    uint stride = frame->pass.stride;
    state_store_vec3(paths, stride, PATH_POINT, item, p);
    state_store_vec3(paths, stride, PATH_NG, item, ng);
    state_store_vec3(paths, stride, PATH_WO, item, wo);
    frame_store(paths, stride, PATH_FRAME, item, *shading);
}

/* The vertex where the path's ray was scattered, in `medium`. */
SHARED_FUNCTION_APART void path_vertex_in_medium(const SceneView *scene, __global uint *restrict paths, uint item,
                                                 Ray ray, Hit hit, uint medium)
{
    Frame along = frame_from_normal(vec3_negate(ray.d));
    Bsdf phase = medium_bsdf(scene, medium);
    path_vertex_store(scene->frame, paths, item, scatter_position(&ray, hit), vec3_splat(0.0f), vec3(0.0f, 0.0f, 1.0f),
                      &along);
    bsdf_store(scene, paths, scene->frame->pass.stride, PATH_BSDF, item, &phase);
}

/* Takes the path through the media before its hit: throughput, density, and the light that they emit. */
SHARED_FUNCTION_APART void path_pass_media(const SceneView *scene, __global uint *restrict paths,
                                           __global const uint *restrict hits, uint item, bool scattered, Vec3 p)
{
    uint stride = scene->frame->pass.stride;
    Passage passage = passage_load(scene, hits, stride, item, scattered, p);
    Vec3 beta = state_load_vec3(paths, stride, PATH_BETA, item);
    if (SCENE_HAS(scene, FEATURE_MEDIUM_EMISSION))
        path_add_own(scene->frame, paths, item, state_load(paths, stride, PATH_DEPTH, item),
                     vec3_mul(beta, state_load_vec3(hits, stride, HIT_EMISSION, item)));
    state_store_vec3(paths, stride, PATH_BETA, item, vec3_mul(beta, passage.weight));
    state_store_float(paths, stride, PATH_PDF_W, item, state_load_float(paths, stride, PATH_PDF_W, item) * passage.pdf);
}

/* From: closest hits. To: emission gathered; the vertex, its frame and Bsdf. Paths that miss or have max_depth segments
 * end. */
__kernel void pt_shade_hits(__global const FrameParams *restrict frame, __global const uint *restrict photons,
                            __global const uint *restrict geometry, __global const uint *restrict tables,
                            __global const uint *restrict texels, __global uint *restrict paths,
                            __global uint *restrict rays, __global const uint *restrict hits)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, PATH_DEPTH, item);
    if (depth == 0u)
        return;
    KERNEL_SCENE_PHOTONS(frame, 0, photons, geometry, tables, texels);
    Ray whole = ray_load(rays, stride, item), ray = ray_last_part(scene, hits, stride, item, whole);
    Hit hit = hit_load(hits, stride, item);
    bool scattered = SCENE_HAS(scene, FEATURE_SCATTERING) && hit.primitive == HIT_SCATTERED;
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        path_pass_media(scene, paths, hits, item, scattered, scatter_position(&ray, hit));
    if (hit.primitive == NONE) {
        if (SCENE_HAS(scene, FEATURE_INFINITE_LIGHT))
            path_add_environment(scene, paths, item, &whole);
        path_end(paths, rays, stride, item);
        return;
    }
    uint medium = hit_medium(scene, hits, stride, item);
    if (scattered && depth < frame->path.max_depth) {
        path_vertex_in_medium(scene, paths, item, ray, hit, medium);
        return;
    }
    if (scattered) {
        path_end(paths, rays, stride, item);
        return;
    }
    Surface surface = surface_from_hit(scene, &ray, hit);
    uint first_light = scene->shapes[surface.shape].first_light;
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && first_light != NONE) {
        uint light = first_light + hit.primitive - scene->shapes[surface.shape].first_primitive;
        path_add_emission(scene, paths, item, light, &surface, ray.d);
    }
    if (depth >= frame->path.max_depth) {
        path_end(paths, rays, stride, item);
        return;
    }
    float u_mix = 0.5f;
    if (SCENE_HAS(scene, FEATURE_MIX)) {
        Random4 random =
            path_random(frame, state_load(paths, stride, PATH_PIXEL, item),
                        state_load(paths, stride, PATH_SAMPLE, item), path_random_block(depth, RANDOM_MIX));
        u_mix = random_float(random.x[0]);
    }
    Bsdf bsdf;
    Frame shading;
    material_resolve(scene, u_mix, &surface, &bsdf, &shading);
    if (bsdf.kind == MATERIAL_DIFFUSE && vec3_is_zero(bsdf.color0)) {
        path_end(paths, rays, stride, item);
        return;
    }
    bsdf.media = media_at(scene, surface.shape, medium);
    path_vertex_store(frame, paths, item, surface.p, surface.ng, frame_to_local(shading, vec3_negate(ray.d)), &shading);
    bsdf_store(scene, paths, stride, PATH_BSDF, item, &bsdf);
}

/* Keeps an unweighted light sample until its shadow ray has been traced (path_light_pass). */
SHARED_FUNCTION_APART void path_light_keep(__global uint *restrict paths, uint stride, uint item, Vec3 light, float pdf,
                                           float pdf_other)
{
    state_store_vec3(paths, stride, PATH_LIGHT, item, light);
    state_store_float(paths, stride, PATH_LIGHT_PDF, item, pdf);
    state_store_float(paths, stride, PATH_LIGHT_OTHER, item, pdf_other);
}

/* Stores what a light sample brings if it is visible. light: f times the radiance; pdf: its density; pdf_other: that of
 * hitting the light by the Bsdf. */
SHARED_FUNCTION void path_light_weigh(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                      Vec3 light, float pdf, float pdf_other)
{
    uint stride = frame->pass.stride;
    float path_tracing = rgb_luminance(light) / (pdf + pdf_other);
    state_store_vec3(paths, stride, PATH_LIGHT, item, vec3_scale(light, mis_power(pdf, pdf_other) / pdf));
    if (frame->partition.split_direct != 0u)
        state_store_float(
            paths, stride, PATH_LIGHT_SHOWN, item,
            path_shown(frame, paths, item, state_load(paths, stride, PATH_DEPTH, item) + 1u, path_tracing));
}

/* From: the vertex. To: one light sample, its shadow ray, and its contribution if visible. */
__kernel void pt_sample_lights(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                               __global const uint *restrict tables, __global const uint *restrict texels,
                               __global uint *restrict paths, __global uint *restrict shadows)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, PATH_DEPTH, item);
    if (depth == 0u || (state_load(paths, stride, PATH_BSDF + STORED_BSDF_FLAGS, item) & BSDF_SMOOTH) != 0u)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    Random4 random = path_random(frame, state_load(paths, stride, PATH_PIXEL, item),
                                 state_load(paths, stride, PATH_SAMPLE, item), path_random_block(depth, RANDOM_LIGHT));
    Vec2 u;
    float choice;
    Vec3 p = state_load_vec3(paths, stride, PATH_POINT, item), ng = state_load_vec3(paths, stride, PATH_NG, item);
    uint light = light_choose_point(scene, p, ng, random, &u, &choice);
    LightSample sample = {0};
    if (!light_sample(scene, light, p, u, &sample))
        return;
    Bsdf bsdf = bsdf_load(scene, paths, stride, PATH_BSDF, item);
    Frame shading = frame_load(paths, stride, PATH_FRAME, item);
    BsdfValue value = bsdf_eval(scene, &bsdf, state_load_vec3(paths, stride, PATH_WO, item),
                                frame_to_local(shading, sample.wi), TRANSPORT_RADIANCE);
    if (vec3_is_zero(value.f_cos))
        return;
    float pdf = choice * sample.pdf_w;
    float pdf_other = sample.delta != 0u ? 0.0f : value.pdf_w;
    Vec3 beta = state_load_vec3(paths, stride, PATH_BETA, item);
    Vec3 light_term = vec3_mul(vec3_mul(beta, value.f_cos), sample.radiance);
    Ray shadow = light_shadow_ray(scene, p, ng, &sample);
    if (!ray_traceable(shadow.o, shadow.d))
        return;
    ray_store(shadows, stride, item, shadow);
    if (SCENE_HAS(scene, FEATURE_MEDIUM)) {
        path_light_keep(paths, stride, item, light_term, pdf, pdf_other);
        shadow_medium_store(scene, shadows, stride, item, medium_towards(bsdf.media, ng, shadow.d));
    } else {
        path_light_weigh(frame, paths, item, light_term, pdf, pdf_other);
    }
}

/* In scenes with media: weights the light sample after its shadow ray has been traced through them. */
SHARED_FUNCTION_APART void path_light_pass(const SceneView *scene, __global uint *restrict paths,
                                           __global const uint *restrict shadows, uint item)
{
    uint stride = scene->frame->pass.stride;
    Passage passage = passage_shadow(scene, shadows, stride, item);
    path_light_weigh(scene->frame, paths, item,
                     vec3_mul(state_load_vec3(paths, stride, PATH_LIGHT, item), passage.weight),
                     state_load_float(paths, stride, PATH_LIGHT_PDF, item),
                     state_load_float(paths, stride, PATH_LIGHT_OTHER, item) * passage.pdf);
}

/* From: traced shadow rays. To: visible light samples gathered, shadow rays cleared. */
__kernel void pt_add_lights(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global uint *restrict paths, __global uint *restrict shadows)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    if (!(state_load_float(shadows, stride, RAY_T_MAX, item) > 0.0f))
        return;
    state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    if (state_load(shadows, stride, SHADOW_OCCLUDED, item) != 0u)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        path_light_pass(scene, paths, shadows, item);
    path_add_radiance(frame, paths, item, state_load(paths, stride, PATH_DEPTH, item) + 1u,
                      state_load_vec3(paths, stride, PATH_LIGHT, item),
                      frame->partition.split_direct != 0u ? state_load_float(paths, stride, PATH_LIGHT_SHOWN, item)
                                                          : 1.0f);
}

/* The probability with which Russian roulette lets the path live; 1 or more: certainly. */
SHARED_FUNCTION float path_survival(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                    Vec3 beta, float eta_scale)
{
    float survival = vec3_max_component(beta) * eta_scale * (1.0f / ROULETTE_THROUGHPUT);
    if (frame->partition.split_direct == 0u || !(survival > 0.0f))
        return survival;
    float before = state_load_float(paths, frame->pass.stride, PATH_SURVIVED, item);
    survival = float_clamp(survival, SURVIVED_LEAST / before, 1.0f);
    state_store_float(paths, frame->pass.stride, PATH_SURVIVED, item, before * survival);
    return survival;
}

/* From: the vertex. To: the next ray, or the path's end by absorption or Russian roulette. */
__kernel void pt_extend_paths(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                              __global const uint *restrict tables, __global const uint *restrict texels,
                              __global uint *restrict paths, __global uint *restrict rays,
                              __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, PATH_DEPTH, item);
    if (depth == 0u)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    Random4 random =
        path_random(frame, state_load(paths, stride, PATH_PIXEL, item), state_load(paths, stride, PATH_SAMPLE, item),
                    path_random_block(depth, RANDOM_SCATTER));
    Bsdf bsdf = bsdf_load(scene, paths, stride, PATH_BSDF, item);
    BsdfSample sample = {0};
    if (!bsdf_sample(scene, &bsdf, state_load_vec3(paths, stride, PATH_WO, item), random_float(random.x[0]),
                     vec2(random_float(random.x[1]), random_float(random.x[2])), TRANSPORT_RADIANCE, &sample)) {
        path_end(paths, rays, stride, item);
        return;
    }
    Vec3 beta = vec3_mul(state_load_vec3(paths, stride, PATH_BETA, item), sample.weight);
    float eta_scale = state_load_float(paths, stride, PATH_ETA_SCALE, item) * sample.eta * sample.eta;
    float survival = depth >= ROULETTE_FIRST_DEPTH ? path_survival(frame, paths, item, beta, eta_scale) : 1.0f;
    if (!(random_float(random.x[3]) < survival)) {
        path_end(paths, rays, stride, item);
        return;
    }
    if (survival < 1.0f)
        beta = vec3_scale(beta, 1.0f / survival);
    Frame shading = frame_load(paths, stride, PATH_FRAME, item);
    Vec3 p = state_load_vec3(paths, stride, PATH_POINT, item), ng = state_load_vec3(paths, stride, PATH_NG, item);
    Vec3 wi = vec3_normalize(frame_to_world(shading, sample.wi));
    Ray ray = ray_spawn(p, ng, wi);
    if (!ray_traceable(ray.o, ray.d)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_RAY_RANGE);
        path_end(paths, rays, stride, item);
        return;
    }
    ray_store(rays, stride, item, ray);
    if (frame->photons.count > 0u) {
        state_store(paths, stride, PATH_CAUSTIC_DRAWN, item, 0u);
        receiver_leave(paths, stride, PATH_RECEIVER, item, p, wi,
                       receiver_pdf(scene, &bsdf, sample.pdf_w, sample.delta));
        if (sample.delta != 0u && depth <= RECEIVER_LAST)
            state_store(paths, stride, PATH_DELTA, item, state_load(paths, stride, PATH_DELTA, item) | 1u << depth);
    }
    state_store_vec3(paths, stride, PATH_BETA, item, beta);
    state_store_float(paths, stride, PATH_PDF_W, item, sample.pdf_w);
    state_store_float(paths, stride, PATH_ETA_SCALE, item, eta_scale);
    state_store(paths, stride, PATH_FLAGS, item, sample.delta != 0u ? PATH_FLAG_DELTA : 0u);
    state_store(paths, stride, PATH_DEPTH, item, depth + 1u);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        path_ray_media(scene, paths, rays, item, medium_towards(bsdf.media, ng, wi), depth + 1u);
}

/* Splats what the path has gathered in `field` to its pixel, and clears it. A sum that is not finite is counted, and
 * splatted as zero. */
SHARED_FUNCTION void path_splat(__global const FrameParams *frame, __global uint *restrict paths,
                                __global uint *restrict splats, __global uint *restrict diagnostics, uint item,
                                uint field, uint flags)
{
    uint stride = frame->pass.stride;
    Vec3 radiance =
        vec3_scale(state_load_vec3(paths, stride, field, item), state_load_float(paths, stride, PATH_WEIGHT, item));
    if (!vec3_finite(radiance)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_NOT_FINITE);
        radiance = vec3_splat(0.0f);
    }
    state_store(splats, stride, SPLAT_PIXEL, item, flags | state_load(paths, stride, PATH_PIXEL, item));
    state_store_vec3(splats, stride, SPLAT_COLOR, item, radiance);
    state_store(splats, stride, SPLAT_OFFSET, item, state_load(paths, stride, PATH_OFFSET, item));
    state_store_vec3(paths, stride, field, item, vec3_splat(0.0f));
}

/* Only with frame->partition.split_direct. From: paths of two segments, or if path tracing shows more than direct light
 * alone (PATH_OWN), finished ones. To: that light, as a sample of the pixel. */
__kernel void pt_splat_own(__global const FrameParams *restrict frame, __global uint *restrict paths,
                           __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0);
    if (item < frame->pass.item_count)
        path_splat(frame, paths, splats, diagnostics, item, PATH_OWN, SPLAT_SAMPLE);
}

/* The bits of a splat for the depth of what the path has gathered; 0 without frame->film.split_depths. */
SHARED_FUNCTION uint path_splat_depth(__global const FrameParams *frame, __global const uint *restrict paths, uint item)
{
    if (frame->film.split_depths == 0u)
        return 0u;
    return splat_depth(frame->film.split_depths, state_load(paths, frame->pass.stride, PATH_GATHERED, item));
}

/* Only with frame->partition.split_direct. From: the finished path, or with frame->film.split_depths one under way. To:
 * a splat of its rare light, if it has any. */
__kernel void pt_splat_rare(__global const FrameParams *restrict frame, __global uint *restrict paths,
                            __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    if (vec3_is_zero(state_load_vec3(paths, stride, PATH_RARE, item))) {
        state_store(splats, stride, SPLAT_PIXEL, item, NONE);
        return;
    }
    path_splat(frame, paths, splats, diagnostics, item, PATH_RARE,
               SPLAT_LIGHT | SPLAT_RARE | path_splat_depth(frame, paths, item));
}

/* From: the finished path. To: its splat; with SPLAT_LIGHT if its direct light has been splatted as the pixel's sample
 * before. With frame->film.split_depths it also runs in the course of a path, for the contribution of the latest
 * segment. */
__kernel void pt_splat(__global const FrameParams *restrict frame, __global uint *restrict paths,
                       __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), flags = frame->partition.split_direct != 0u ? SPLAT_LIGHT : SPLAT_SAMPLE;
    if (item >= frame->pass.item_count)
        return;
    path_splat(frame, paths, splats, diagnostics, item, PATH_RADIANCE, flags | path_splat_depth(frame, paths, item));
}

#endif
