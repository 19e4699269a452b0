/* Instant bidirectional path tracing: of all strategies the three that need no stored vertices, so that the state of a
 * path does not depend on its length (Frolov 2018, section 1; Bogolepov, Ulyanov, Sopin and Turlapov, "GPU-optimized
 * bi-directional path tracing", WSCG 2013). Per segment: (rays traced) ib_shade_hits, ib_connect, (shadow rays traced)
 * ib_add_connections, ib_extend_walks; around them ib_start_light, ib_start_camera, bd_splat. */
#ifndef TWINLIGHT_IBPT_CL
#define TWINLIGHT_IBPT_CL

#include "bd_connect.h"
#include "bd_start.h"
#include "bd_weight.h"
#include "ib_weight.h"

/* Whether the strategy is wanted. */
SHARED_FUNCTION bool ib_wanted(__global const FrameParams *frame, uint s, uint t)
{
    return strategy_taken(frame->strategies, s, s + t - 1u) &&
           (frame->only_s == NONE || (frame->only_s == s && frame->only_t == t));
}

/* From: nothing. To: the item's pixel and sample; y_0 and the light's first ray. */
__kernel void ib_start_light(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                             __global const uint *restrict tables, __global const uint *restrict texels,
                             __global uint *restrict paths, __global uint *restrict rays,
                             __global uint *restrict shadows, __global uint *restrict vertices,
                             __global uint *restrict diagnostics)
{
    uint t = (uint)get_global_id(0), stride = frame->stride;
    if (t >= frame->item_count)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    float own;
    bd_header_begin(frame, paths, rays, shadows, stride, t);
    if (frame->max_depth >= 2u && walk_start_light(&scene, paths, rays, vertices, diagnostics, stride, t, 0u, &own))
        state_store_float(paths, stride, IB_OWN_BEFORE, t, own);
}

/* From: nothing more than the pixel. To: the camera's first ray. */
__kernel void ib_start_camera(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                              __global const uint *restrict tables, __global const uint *restrict texels,
                              __global uint *restrict paths, __global uint *restrict rays,
                              __global uint *restrict diagnostics)
{
    uint t = (uint)get_global_id(0);
    if (t >= frame->item_count)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    walk_start_camera(&scene, paths, rays, diagnostics, frame->stride, t);
}

SHARED_FUNCTION void ib_add_radiance(__global uint *restrict paths, uint stride, uint t, Vec3 radiance)
{
    Vec3 sum = state_load_vec3(paths, stride, BD_RADIANCE, t);
    state_store_vec3(paths, stride, BD_RADIANCE, t, vec3_add(sum, radiance));
}

/* s = 0: adds what a light met sends. */
SHARED_FUNCTION void ib_add_met(__global const FrameParams *frame, __global uint *restrict paths, uint t, uint depth,
                                Vec3 radiance, const StrategyEnds *ends)
{
    bool delta = (state_load(paths, frame->stride, BD_WALK_FLAGS, t) & WALK_DELTA) != 0u;
    if (vec3_is_zero(radiance) || !ib_wanted(frame, 0u, depth + 1u))
        return;
    float weight = frame->unweighted != 0u ? 1.0f : ib_weight_met(frame, paths, t, depth, delta, ends);
    Vec3 beta = state_load_vec3(paths, frame->stride, BD_BETA, t);
    ib_add_radiance(paths, frame->stride, t, vec3_scale(vec3_mul(beta, radiance), weight));
}

SHARED_FUNCTION void ib_add_environment(const SceneView *scene, __global uint *restrict paths, uint t, uint depth,
                                        Vec3 d, Vec3 ng)
{
    for (uint i = 0; i < scene->frame->infinite_light_count; ++i) {
        StrategyEnds ends = {0};
        Vec3 radiance = environment_met(scene, scene->infinite_lights[i], d, ng, &ends);
        ib_add_met(scene->frame, paths, t, depth, radiance, &ends);
    }
}

/* From: closest hits. To: emission met by the camera's walk gathered; the vertex. Walks that miss or are full end. */
__kernel void ib_shade_hits(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global uint *restrict paths, __global uint *restrict rays,
                            __global const uint *restrict hits, __global uint *restrict vertices)
{
    uint t = (uint)get_global_id(0), stride = frame->stride;
    if (t >= frame->item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, t);
    if (depth == 0u)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    uint side = state_load(paths, stride, BD_SIDE, t), flags = state_load(paths, stride, BD_WALK_FLAGS, t);
    Ray ray = ray_load(rays, stride, t);
    Hit hit = hit_load(hits, stride, t);
    float pdf = state_load_float(paths, stride, BD_PDF, t);
    bool first = side == SIDE_CAMERA && depth == 1u;
    /* The vertex before this one, which takes its place. */
    Vec3 from = state_load_vec3(vertices, stride, VERTEX_POINT, t);
    Vec3 from_ng = state_load_vec3(vertices, stride, VERTEX_NG, t);
    if (hit.primitive == NONE) {
        if (side == SIDE_CAMERA && SCENE_HAS(&scene, FEATURE_INFINITE_LIGHT)) {
            state_store_float(paths, stride, IB_OWN, t, pdf);
            ib_add_environment(&scene, paths, t, depth, ray.d, first ? ray.d : from_ng);
        }
        walk_end(paths, rays, stride, t);
        return;
    }
    Surface surface = surface_from_hit(&scene, &ray, hit);
    uint emitter = side == SIDE_LIGHT && depth == 1u ? state_load(paths, stride, BD_EMITTER_FLAGS, t) : 0u;
    float back = first ? 1.0f : walk_back(surface.p, from, from_ng, emitter);
    if (first || (flags & WALK_PARALLEL) != 0u)
        from = ray.o;
    float distance2 = vec3_length_squared(vec3_sub(surface.p, from));
    state_store_float(paths, stride, IB_OWN, t,
                      walk_density(frame, &ray, &surface, distance2, side, depth, flags, pdf));
    state_store_float(paths, stride, BD_BACK, t, back);
    uint first_light = scene.shapes[surface.shape].first_light;
    if (side == SIDE_CAMERA && SCENE_HAS(&scene, FEATURE_AREA_LIGHT) && first_light != NONE) {
        uint light = first_light + hit.primitive - scene.shapes[surface.shape].first_primitive;
        StrategyEnds ends = {0};
        Vec3 radiance = emission_met(&scene, light, &surface, ray.d, from, distance2, back, &ends);
        ib_add_met(frame, paths, t, depth, radiance, &ends);
    }
    Random4 random = bd_random(frame, paths, t, bd_random_vertex(side, depth, BD_RANDOM_MIX));
    Vertex vertex;
    if ((side == SIDE_CAMERA && depth >= frame->max_depth) ||
        !vertex_make(&scene, &surface, ray.d, state_load_vec3(paths, stride, BD_BETA, t), random_float(random.x[0]),
                     &vertex)) {
        walk_end(paths, rays, stride, t);
        return;
    }
    if (side == SIDE_LIGHT && depth == 1u)
        state_store_float(paths, stride, BD_CONNECT, t,
                          bd_emitter_ratio(&scene, paths, vertices, stride, t, surface.p));
    vertex_store(&scene, vertices, stride, 0u, t, &vertex);
}

/* From: the vertex. To: its connection to the lens (the light's walk) or to a point drawn on a light, weighted, and the
 * shadow ray. */
__kernel void ib_connect(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                         __global const uint *restrict tables, __global const uint *restrict texels,
                         __global uint *restrict paths, __global uint *restrict shadows,
                         __global const uint *restrict vertices)
{
    uint item = (uint)get_global_id(0), stride = frame->stride;
    if (item >= frame->item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, item), side = state_load(paths, stride, BD_SIDE, item);
    uint s = side == SIDE_LIGHT ? depth + 1u : 1u, t = side == SIDE_LIGHT ? 1u : depth + 1u;
    if (depth == 0u || !ib_wanted(frame, s, t))
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    Vertex vertex = vertex_load(&scene, vertices, stride, 0u, item);
    Random4 random = bd_random(frame, paths, item, bd_random_connection(s, t));
    float back = state_load_float(paths, stride, BD_BACK, item);
    Connection connection = {0};
    connection.target = NONE;
    bool possible = side == SIDE_LIGHT ? connect_camera(&scene, &vertex, back, random, &connection)
                                       : connect_light(&scene, &vertex, back, random, &connection);
    if (!possible || vec3_is_zero(connection.contribution) || !(connection.shadow.t_max > 0.0f) ||
        !ray_traceable(connection.shadow.o, connection.shadow.d))
        return;
    float weight = 1.0f;
    if (side == SIDE_LIGHT) {
        connection.ends.hittable = (state_load(paths, stride, BD_EMITTER_FLAGS, item) & EMITTER_DELTA) == 0u;
        connection.ends.connect = state_load_float(paths, stride, BD_CONNECT, item);
    }
    if (frame->unweighted == 0u)
        weight = side == SIDE_LIGHT ? ib_weight_seen(frame, paths, item, depth + 1u, &connection.ends)
                                    : ib_weight_drawn(frame, paths, item, depth + 1u, &connection.ends);
    state_store_vec3(paths, stride, BD_CONTRIBUTION, item, vec3_scale(connection.contribution, weight));
    state_store(paths, stride, BD_TARGET, item, connection.target);
    ray_store(shadows, stride, item, connection.shadow);
}

/* From: traced shadow rays. To: visible connections gathered (the camera's walk), or put out for the film. */
__kernel void ib_add_connections(__global const FrameParams *restrict frame, __global uint *restrict paths,
                                 __global uint *restrict shadows, __global uint *restrict splats,
                                 __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->stride;
    if (item >= frame->item_count)
        return;
    bool from_light = state_load(paths, stride, BD_SIDE, item) == SIDE_LIGHT, visible = false;
    if (state_load_float(shadows, stride, RAY_T_MAX, item) > 0.0f) {
        visible = state_load(shadows, stride, SHADOW_OCCLUDED, item) == 0u;
        state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    }
    Vec3 contribution = state_load_vec3(paths, stride, BD_CONTRIBUTION, item);
    if (from_light && visible)
        splat_store(splats, diagnostics, stride, item, SPLAT_FROM_LIGHT | state_load(paths, stride, BD_TARGET, item),
                    contribution);
    else if (from_light)
        state_store(splats, stride, SPLAT_PIXEL, item, NONE);
    else if (visible)
        ib_add_radiance(paths, stride, item, contribution);
}

/* From: the vertex. To: the running product; the next ray, or the walk's end by absorption or Russian roulette. */
__kernel void ib_extend_walks(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                              __global const uint *restrict tables, __global const uint *restrict texels,
                              __global uint *restrict paths, __global uint *restrict rays,
                              __global const uint *restrict vertices, __global uint *restrict diagnostics)
{
    uint t = (uint)get_global_id(0), stride = frame->stride;
    if (t >= frame->item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, t), side = state_load(paths, stride, BD_SIDE, t);
    if (depth == 0u)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    Random4 random = bd_random(frame, paths, t, bd_random_vertex(side, depth, BD_RANDOM_SCATTER));
    Vertex vertex = vertex_load(&scene, vertices, stride, 0u, t);
    WalkStep step;
    if (!walk_scatter(&scene, &vertex, side, depth, state_load_float(paths, stride, BD_ETA_SCALE, t), random, &step)) {
        walk_end(paths, rays, stride, t);
        return;
    }
    if (!ray_traceable(step.ray.o, step.ray.d)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_RAY_RANGE);
        walk_end(paths, rays, stride, t);
        return;
    }
    ib_leave(paths, stride, t, side, depth, step.reverse * state_load_float(paths, stride, BD_BACK, t),
             step.delta != 0u);
    walk_step_store(paths, rays, stride, t, depth, &step);
}

#endif
