/* Instant bidirectional path tracing: only the three strategies that need no stored vertices, so that the state of a
 * path does not depend on its length (Frolov 2018, section 1; Bogolepov, Ulyanov, Sopin and Turlapov, "GPU-optimized
 * bi-directional path tracing", WSCG 2013). Per segment: (rays traced) ib_shade_hits, ib_connect, (shadow rays traced)
 * ib_add_connections, ib_extend_walks; around them ib_start_light, bd_start_camera, bd_splat. */
#ifndef TWINLIGHT_IBPT_CL
#define TWINLIGHT_IBPT_CL

#include "path/bd_connect.h"
#include "path/bd_start.h"
#include "path/bd_weight.h"
#include "path/ib_weight.h"

/* From: nothing. To: the item's pixel and sample; y_0 and the light's first ray; no splat. */
__kernel void ib_start_light(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                             __global const uint *restrict tables, __global const uint *restrict texels,
                             __global uint *restrict paths, __global uint *restrict rays,
                             __global uint *restrict shadows, __global uint *restrict splats,
                             __global uint *restrict vertices, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    float own;
    bd_header_begin(frame, paths, rays, shadows, item, item_place(frame, item));
    state_store(splats, stride, SPLAT_PIXEL, item, NONE);
    Walk walk = {paths, rays, diagnostics, stride, item};
    if (frame->path.max_depth >= 2u &&
        walk_start_light(scene, walk, vertices, 0u, bd_random(frame, paths, item, BD_RANDOM_LIGHT),
                         bd_random(frame, paths, item, BD_RANDOM_EMIT), &own))
        state_store_float(paths, stride, IB_OWN_BEFORE, item, own);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        bd_ray_media(scene, paths, rays, item, SIDE_LIGHT, 1u, emitter_medium(scene, walk));
}

/* s = 0: adds what a light sends that was hit. beta: throughput of the walk. */
SHARED_FUNCTION void ib_add_met(__global const FrameParams *frame, __global uint *restrict paths, uint item, uint depth,
                                Vec3 beta, Vec3 radiance, const StrategyEnds *ends)
{
    bool delta = (state_load(paths, frame->pass.stride, BD_WALK_FLAGS, item) & WALK_DELTA) != 0u;
    if (vec3_is_zero(radiance) || !strategy_wanted(frame, 0u, depth + 1u))
        return;
    float weight = frame->path.unweighted != 0u ? 1.0f : ib_weight_met(frame, paths, item, depth, delta, ends);
    bd_add_radiance(frame, paths, item, depth, vec3_scale(vec3_mul(beta, radiance), weight));
}

SHARED_FUNCTION void ib_add_environment(const SceneView *scene, __global uint *restrict paths, uint item, uint depth,
                                        const WalkHit *miss)
{
    for (uint i = 0; i < scene->frame->scene.infinite_light_count; ++i) {
        StrategyEnds ends = {0};
        Vec3 radiance = environment_met(scene, scene->infinite_lights[i], miss, &ends);
        ib_add_met(scene->frame, paths, item, depth, miss->beta, radiance, &ends);
    }
}

/* From: closest hits. To: emission that the camera walk has hit, gathered; the vertex. Walks that miss or have
 * max_depth segments end. */
__kernel void ib_shade_hits(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global uint *restrict paths, __global uint *restrict rays,
                            __global const uint *restrict hits, __global uint *restrict vertices)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, item);
    if (depth == 0u)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    uint side = state_load(paths, stride, BD_SIDE, item);
    /* The vertex overwrites the one before it. */
    WalkHit walk_hit = {0};
    walk_hit_make(scene, paths, rays, hits, vertices, item, &walk_hit);
    state_store_float(paths, stride, IB_OWN, item, walk_hit.own);
    if (side == SIDE_CAMERA && SCENE_HAS(scene, FEATURE_MEDIUM_EMISSION))
        walk_add_medium_emission(scene, paths, hits, item, depth);
    if (walk_hit.missed) {
        if (side == SIDE_CAMERA && SCENE_HAS(scene, FEATURE_INFINITE_LIGHT))
            ib_add_environment(scene, paths, item, depth, &walk_hit);
        walk_end(paths, rays, stride, item);
        return;
    }
    if (side == SIDE_CAMERA && walk_hit.light != NONE) {
        StrategyEnds ends = {0};
        Vec3 radiance = emission_met(scene, &walk_hit, &ends);
        ib_add_met(frame, paths, item, depth, walk_hit.beta, radiance, &ends);
    }
    if (!walk_vertex(scene, paths, vertices, item, 0u, bd_random_mix(scene, paths, item, side, depth), &walk_hit))
        walk_end(paths, rays, stride, item);
}

/* From: the vertex. To: its connection to the lens (the light's walk) or to a point drawn on a light, weighted, and the
 * shadow ray. */
__kernel void ib_connect(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                         __global const uint *restrict tables, __global const uint *restrict texels,
                         __global uint *restrict paths, __global uint *restrict shadows,
                         __global const uint *restrict vertices)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, item), side = state_load(paths, stride, BD_SIDE, item);
    uint s = side == SIDE_LIGHT ? depth + 1u : 1u, t = side == SIDE_LIGHT ? 1u : depth + 1u;
    if (depth == 0u || !strategy_wanted(frame, s, t))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    bool traced = connection_traced(scene, shadows, item);
    Vertex vertex = vertex_load(scene, vertices, stride, 0u, item);
    Random4 random = bd_random_connection(frame, paths, item, s, t);
    Connection connection = {0};
    connection.target = NONE;
    bool possible = side == SIDE_LIGHT ? connect_camera(scene, &vertex, random, &connection) &&
                                             connection_target(scene, random, &connection)
                                       : connect_light(scene, &vertex, random, &connection);
    if (!possible || !connection_traceable(&connection))
        return;
    if (SCENE_HAS(scene, FEATURE_MEDIUM) && !traced) {
        connection_ray_store(scene, shadows, item, &connection);
        return;
    }
    if (traced && !connection_pass(scene, shadows, item, s > 1u ? &vertex : 0, t > 1u ? &vertex : 0, &connection))
        return;
    if (side == SIDE_LIGHT)
        connection_light_end(paths, stride, item, &connection.ends);
    float weight = 1.0f;
    if (frame->path.unweighted == 0u)
        weight = side == SIDE_LIGHT ? ib_weight_seen(frame, paths, item, depth + 1u, &connection.ends)
                                    : ib_weight_drawn(frame, paths, item, depth + 1u, &connection.ends);
    connection_store(paths, shadows, stride, item, &connection, weight);
}

/* From: traced shadow rays. To: visible connections gathered (the camera walk) or splatted (the light walk). */
__kernel void ib_add_connections(__global const FrameParams *restrict frame, __global uint *restrict paths,
                                 __global uint *restrict shadows, __global uint *restrict splats,
                                 __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    bool visible = shadow_take(shadows, stride, item);
    bool from_lens = state_load(paths, stride, BD_SIDE, item) == SIDE_LIGHT;
    uint segments = state_load(paths, stride, BD_DEPTH, item) + 1u;
    connection_add(frame, paths, splats, diagnostics, item, from_lens ? 0u : segments, visible);
}

/* From: the vertex. To: the running product; the next ray, or the walk's end by absorption or Russian roulette; no
 * splat, since the film has taken the vertex's own and no later kernel visits a walk that has ended. */
__kernel void ib_extend_walks(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                              __global const uint *restrict tables, __global const uint *restrict texels,
                              __global uint *restrict paths, __global uint *restrict rays,
                              __global uint *restrict splats, __global const uint *restrict vertices,
                              __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, item), side = state_load(paths, stride, BD_SIDE, item);
    if (depth == 0u)
        return;
    if (side == SIDE_LIGHT)
        state_store(splats, stride, SPLAT_PIXEL, item, NONE);
    KERNEL_SCENE(frame, geometry, tables, texels);
    Random4 random = bd_random(frame, paths, item, bd_random_vertex(side, depth, BD_RANDOM_SCATTER));
    WalkStep step = {0};
    Walk walk = {paths, rays, diagnostics, stride, item};
    if (!walk_leave(scene, walk, vertices, 0u, random, &step))
        return;
    ib_leave(paths, stride, item, side, depth, step.reverse, step.delta != 0u);
    walk_step_store(paths, rays, stride, item, depth, &step);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        bd_ray_media(scene, paths, rays, item, side, depth + 1u, step.medium);
}

#endif
