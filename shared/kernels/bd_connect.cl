/* Connections of bidirectional path tracing: per pair (s, t) bd_connect, (shadow rays traced) bd_add_connections; at
 * the end bd_splat. */
#ifndef TWINLIGHT_BD_CONNECT_CL
#define TWINLIGHT_BD_CONNECT_CL

#include "chain/pool.h"
#include "path/bd_connect.h"
#include "path/bd_weight.h"

/* The probability with which a walk survived roulette up to its vertex number `count`; 1 for a walk without
 * segments. */
SHARED_FUNCTION float vertex_survival(__global const FrameParams *frame, __global const uint *vertices, uint item,
                                      uint side, uint count)
{
    return count > 1u ? state_load_float(vertices, frame->pass.stride,
                                         vertex_base(frame, side, count - 1u) + VERTEX_SURVIVAL, item)
                      : 1.0f;
}

/* From: both walks. To: the connection (BD_S, BD_T), weighted, and its shadow ray. */
__kernel void bd_connect(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                         __global const uint *restrict geometry, __global const uint *restrict tables,
                         __global const uint *restrict texels, __global uint *restrict paths,
                         __global uint *restrict shadows, __global const uint *restrict vertices,
                         __global const uint *restrict densities)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint s = state_load(paths, stride, BD_S, item), t = state_load(paths, stride, BD_T, item);
    uint lengths = state_load(paths, stride, BD_LENGTHS, item);
    if ((s > 1u && s > (lengths & 0xffffu)) || t > (lengths >> 16) + 1u || !strategy_wanted(frame, s, t))
        return;
    uint base_y = vertex_base(frame, SIDE_LIGHT, s - 1u), base_z = vertex_base(frame, SIDE_CAMERA, t - 1u);
    if ((s > 1u && vertex_smooth(vertices, stride, base_y, item)) ||
        (t > 1u && vertex_smooth(vertices, stride, base_z, item)))
        return;
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    bool traced = connection_traced(scene, shadows, item);
    Connection connection = {0};
    Vertex y = {0}, z = {0};
    if (s > 1u)
        y = vertex_load(scene, vertices, stride, base_y, item);
    if (t > 1u)
        z = vertex_load(scene, vertices, stride, base_z, item);
    Random4 random = bd_random_connection(frame, paths, item, s, t);
    bool possible = connect_ends(scene, s, t, &y, &z, random, &connection);
    if (possible && t == 1u)
        possible = connection_target(scene, random, &connection);
    if (!possible || !connection_traceable(&connection))
        return;
    if (SCENE_HAS(scene, FEATURE_MEDIUM) && !traced) {
        connection_ray_store(scene, shadows, item, &connection);
        return;
    }
    if (traced && !connection_pass(scene, shadows, item, s > 1u ? &y : 0, t > 1u ? &z : 0, &connection))
        return;
    if (s >= 2u)
        connection_light_end(paths, stride, item, &connection.ends);
    DensityView view = bd_density_view(frame, paths, densities, item);
    float weight = bd_weight(frame, s, t, &view, &connection.ends);
    connection_store(paths, shadows, stride, item, &connection, weight);
    if (frame->pool.enabled == 0u)
        return;
    state_store_float(paths, stride, BD_CONNECTION_SURVIVAL, item,
                      vertex_survival(frame, vertices, item, SIDE_LIGHT, s) *
                          vertex_survival(frame, vertices, item, SIDE_CAMERA, t));
    if (t == 1u)
        state_store_float(paths, stride, BD_TARGET_IMPORTANCE, item,
                          film_importance(frame, scene->guide, connection.film));
}

/* Moves on to the next pair, in the order of the list of steps (render/integrator_bdpt.c): t = 1: s = 2 ... D; then t =
 * 2 ... D: s = 1 ... D + 1 - t. */
SHARED_FUNCTION void connection_advance(__global uint *restrict paths, uint stride, uint item, uint max_depth)
{
    uint s = state_load(paths, stride, BD_S, item) + 1u, t = state_load(paths, stride, BD_T, item);
    if (s + t > max_depth + 1u) {
        s = 1u;
        ++t;
    }
    state_store(paths, stride, BD_S, item, s);
    state_store(paths, stride, BD_T, item, t);
}

/* Records the depth of the connected path for its splat, which goes to the pixel or elsewhere. */
SHARED_FUNCTION void connection_depth_set(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                          uint segments)
{
    uint stride = frame->pass.stride;
    if (frame->film.split_depths == 0u)
        return;
    uint target = state_load(paths, stride, BD_TARGET, item);
    state_store(paths, stride, BD_GATHERED, item, segments);
    if (target != NONE)
        state_store(paths, stride, BD_TARGET, item, target | splat_depth(frame->film.split_depths, segments));
}

/* From: traced shadow rays. To: visible connections gathered, or (t = 1) splatted; the next pair. */
__kernel void bd_add_connections(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                                 __global uint *restrict paths, __global uint *restrict shadows,
                                 __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint s = state_load(paths, stride, BD_S, item), t = state_load(paths, stride, BD_T, item);
    bool visible = shadow_take(shadows, stride, item);
    if (frame->pool.enabled != 0u && visible) {
        /* The weight of a splat is its cover times the filter's own weight and a sign. */
        float cover =
            t == 1u ? float_abs(state_load_float(paths, stride, BD_TARGET_WEIGHT, item) / frame->film.filter.weight)
                    : state_load_float(paths, stride, BD_COVER, item);
        float importance = state_load_float(paths, stride, t == 1u ? BD_TARGET_IMPORTANCE : BD_IMPORTANCE, item);
        Candidate path = {s,     t,          state_load_float(paths, stride, BD_CONNECTION_SURVIVAL, item),
                          cover, importance, state_load_vec3(paths, stride, BD_CONTRIBUTION, item)};
        state_store_vec3(paths, stride, BD_CONTRIBUTION, item, reservoir_update(frame, guide, paths, item, path));
    }
    if (visible)
        connection_depth_set(frame, paths, item, s + t - 1u);
    connection_add(frame, paths, splats, diagnostics, item, t == 1u ? 0u : s + t - 1u, visible);
    connection_advance(paths, stride, item, frame->path.max_depth);
}

/* Splats what was gathered in `field` to the path's pixel. */
SHARED_FUNCTION void gathered_splat(__global const FrameParams *frame, __global const uint *restrict paths,
                                    __global uint *restrict splats, __global uint *restrict diagnostics, uint item,
                                    uint field, uint flags)
{
    uint stride = frame->pass.stride;
    splat_store(
        splats, diagnostics, stride, item, flags | state_load(paths, stride, BD_PIXEL, item),
        state_load(paths, stride, BD_OFFSET, item),
        vec3_scale(state_load_vec3(paths, stride, field, item), state_load_float(paths, stride, BD_WEIGHT, item)));
}

/* Only with frame->partition.split_direct. From: direct light, gathered for the pixel. To: its splat, a sample of the
 * pixel. */
__kernel void bd_splat_direct(__global const FrameParams *restrict frame, __global const uint *restrict paths,
                              __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0);
    if (item < frame->pass.item_count)
        gathered_splat(frame, paths, splats, diagnostics, item, BD_DIRECT, SPLAT_SAMPLE);
}

/* From: what was gathered for the pixel. To: its splat. With frame->partition.split_direct it goes where splats from
 * the light go, and also apart from these, since the film divides it by the number of samples near the pixel
 * (film_normalize_bidirectional). With frame->film.split_depths it also runs in the course of a path, and then
 * clears what was gathered. */
__kernel void bd_splat(__global const FrameParams *restrict frame, __global uint *restrict paths,
                       __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint flags = frame->pool.enabled != 0u             ? SPLAT_LIGHT
                 : frame->partition.split_direct != 0u ? SPLAT_LIGHT | SPLAT_RARE
                                                       : SPLAT_SAMPLE;
    if (frame->film.split_depths != 0u)
        flags |= splat_depth(frame->film.split_depths, state_load(paths, stride, BD_GATHERED, item));
    gathered_splat(frame, paths, splats, diagnostics, item, BD_RADIANCE, flags);
    if (frame->film.split_depths != 0u)
        state_store_vec3(paths, stride, BD_RADIANCE, item, vec3_splat(0.0f));
}

#endif
