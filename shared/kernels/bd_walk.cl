/* Both walks of bidirectional path tracing (Veach 1997, chapter 10; Lafortune and Willems 1993), vertex by vertex. Per
 * segment: (rays traced) bd_shade_hits, bd_extend_walks; before them bd_start_light, then bd_start_camera. */
#ifndef TWINLIGHT_BD_WALK_CL
#define TWINLIGHT_BD_WALK_CL

#include "chain/pool.h"
#include "path/bd_random.h"
#include "path/bd_start.h"
#include "path/bd_walk.h"
#include "path/bd_weight.h"

/* From: nothing. To: the item's pixel and sample; y_0 and the light's first ray. */
__kernel void bd_start_light(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                             __global const uint *restrict geometry, __global const uint *restrict tables,
                             __global const uint *restrict texels, __global uint *restrict paths,
                             __global uint *restrict rays, __global uint *restrict shadows,
                             __global uint *restrict vertices, __global uint *restrict densities,
                             __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    bd_header_begin(frame, paths, rays, shadows, item, pool_item_place(frame, guide, frame->pass.first_item + item));
    state_store(paths, stride, BD_LENGTHS, item, 0u);
    state_store(paths, stride, BD_LIGHT_DELTA, item, 0u);
    state_store(paths, stride, BD_CAMERA_DELTA, item, 0u);
    state_store(paths, stride, BD_S, item, 2u);
    state_store(paths, stride, BD_T, item, 1u);
    if (frame->path.max_depth < 2u ||
        (frame->pool.enabled != 0u && !pool_has_light(frame, frame->pass.first_item + item)))
        return;
    float own;
    Walk walk = {paths, rays, diagnostics, stride, item};
    if (!walk_start_light(scene, walk, vertices, vertex_base(frame, SIDE_LIGHT, 0u),
                          bd_random(frame, paths, item, BD_RANDOM_LIGHT), bd_random(frame, paths, item, BD_RANDOM_EMIT),
                          &own))
        return;
    if (frame->pool.enabled != 0u)
        pool_roulette_weigh(frame, paths, item, 1.0f);
    state_store_float(densities, stride, density_base(frame, SIDE_LIGHT, 0u) + DENSITY_OWN, item, own);
    state_store(paths, stride, BD_LENGTHS, item, 1u);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        bd_ray_media(scene, paths, rays, item, SIDE_LIGHT, 1u, emitter_medium(scene, walk));
}

/* From: the pixel. To: the camera's first ray. */
__kernel void bd_start_camera(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                              __global const uint *restrict geometry, __global const uint *restrict tables,
                              __global const uint *restrict texels, __global uint *restrict paths,
                              __global uint *restrict rays, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    Walk walk = {paths, rays, diagnostics, stride, item};
    if (frame->pool.enabled != 0u)
        pool_start_camera(scene, walk);
    else
        walk_start_camera(scene, walk);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        bd_ray_media(scene, paths, rays, item, SIDE_CAMERA, 1u, frame->camera.medium);
}

/* reservoir_update for a path with s = 0. */
SHARED_FUNCTION Vec3 bd_offer_met(const SceneView *scene, __global uint *restrict paths, uint item, uint depth,
                                  Vec3 contribution)
{
    uint stride = scene->frame->pass.stride;
    Candidate path = {0u,
                      depth + 1u,
                      state_load_float(paths, stride, BD_SURVIVAL, item),
                      state_load_float(paths, stride, BD_COVER, item),
                      state_load_float(paths, stride, BD_IMPORTANCE, item),
                      contribution};
    return reservoir_update(scene->frame, scene->guide, paths, item, path);
}

/* s = 0: adds what the lights send that the camera walk has hit after `depth` segments. */
SHARED_FUNCTION void bd_add_met(const SceneView *scene, __global uint *restrict paths, uint item, uint depth,
                                Vec3 contribution)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride;
    contribution =
        vec3_scale(contribution, receiver_rest(scene, paths, BD_RECEIVER, item,
                                               state_load(paths, stride, BD_CAMERA_DELTA, item), depth - 1u));
    if (frame->pool.enabled != 0u)
        contribution = bd_offer_met(scene, paths, item, depth, contribution);
    if (frame->film.split_depths != 0u)
        state_store(paths, stride, BD_GATHERED, item, depth);
    bd_add_radiance(frame, paths, item, depth, contribution);
}

/* From: closest hits. To: emission that the camera walk has hit, gathered; the vertex with its densities. Walks that
 * miss or have max_depth segments end. */
__kernel void bd_shade_hits(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                            __global const uint *restrict photons, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global uint *restrict paths, __global uint *restrict rays,
                            __global const uint *restrict hits, __global uint *restrict vertices,
                            __global uint *restrict densities)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, item);
    if (depth == 0u)
        return;
    KERNEL_SCENE_PHOTONS(frame, guide, photons, geometry, tables, texels);
    uint side = state_load(paths, stride, BD_SIDE, item);
    WalkHit walk_hit = {0};
    walk_hit.before = vertex_base(frame, side, depth - 1u);
    walk_hit_make(scene, paths, rays, hits, vertices, item, &walk_hit);
    Vec3 beta = walk_hit.beta;
    if (side == SIDE_CAMERA && SCENE_HAS(scene, FEATURE_MEDIUM_EMISSION))
        walk_add_medium_emission(scene, paths, hits, item, depth);
    DensityView view = bd_density_view(frame, paths, densities, item);
    state_store_float(densities, stride, density_base(frame, side, depth) + DENSITY_OWN, item, walk_hit.own);
    if (walk_hit.missed) {
        if (side == SIDE_CAMERA && SCENE_HAS(scene, FEATURE_INFINITE_LIGHT)) {
            Vec3 sum = walk_environment(scene, view, &walk_hit, depth);
            bd_add_met(scene, paths, item, depth, vec3_mul(beta, sum));
        }
        walk_end(paths, rays, stride, item);
        return;
    }
    if (side == SIDE_CAMERA && walk_hit.light != NONE) {
        StrategyEnds ends = {0};
        Vec3 radiance = emission_met(scene, &walk_hit, &ends);
        if (!vec3_is_zero(radiance))
            bd_add_met(scene, paths, item, depth,
                       vec3_scale(vec3_mul(beta, radiance), bd_weight(frame, 0u, depth + 1u, &view, &ends)));
    }
    if (!walk_vertex(scene, paths, vertices, item, vertex_base(frame, side, depth),
                     bd_random_mix(scene, paths, item, side, depth), &walk_hit)) {
        walk_end(paths, rays, stride, item);
        return;
    }
    uint lengths = state_load(paths, stride, BD_LENGTHS, item);
    lengths = side == SIDE_LIGHT ? (lengths & 0xffff0000u) | (depth + 1u) : (lengths & 0xffffu) | (depth << 16);
    state_store(paths, stride, BD_LENGTHS, item, lengths);
}

/* From: the vertex. To: the density of the vertex before by the other side; the next ray, or the walk's end by
 * absorption or Russian roulette. MIS weights ignore roulette: they sum to one without it. */
__kernel void bd_extend_walks(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                              __global const uint *restrict geometry, __global const uint *restrict tables,
                              __global const uint *restrict texels, __global uint *restrict paths,
                              __global uint *restrict rays, __global const uint *restrict vertices,
                              __global uint *restrict densities, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, item), side = state_load(paths, stride, BD_SIDE, item);
    if (depth == 0u)
        return;
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    Random4 random = bd_random(frame, paths, item, bd_random_vertex(side, depth, BD_RANDOM_SCATTER));
    WalkStep step = {0};
    Walk walk = {paths, rays, diagnostics, stride, item};
    if (!walk_leave(scene, walk, vertices, vertex_base(frame, side, depth), random, &step))
        return;
    walk_mark(paths, stride, item, side, depth, &step);
    if (side == SIDE_LIGHT || depth > 1u)
        state_store_float(densities, stride, density_base(frame, side, depth - 1u) + DENSITY_OTHER, item, step.reverse);
    walk_step_store(paths, rays, stride, item, depth, &step);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        bd_ray_media(scene, paths, rays, item, side, depth + 1u, step.medium);
}

#endif
