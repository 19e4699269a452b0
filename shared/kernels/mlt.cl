/* Multiplexed Metropolis light transport: chains over the random numbers of bidirectional paths with a fixed depth d
 * and, between large steps, a fixed number s of vertices from the light (Hachisuka et al. 2014; Frolov 2018, section
 * 2). A pass: mlt_begin; then per proposal mlt_propose, the light walk, mlt_start_camera, the camera walk, mlt_connect,
 * (shadow rays traced) mlt_accept; at the end mlt_end. Per segment of a walk: (rays traced) mlt_walk. The first
 * proposal of a pass is the current path, so that its vertices exist. */
#ifndef TWINLIGHT_MLT_CL
#define TWINLIGHT_MLT_CL

#include "chain/chain_light.h"
#include "chain/mutation.h"
#include "layout/pass_data.h"
#include "path/bd_connect.h"
#include "path/bd_start.h"
#include "path/bd_weight.h"

/* From: the candidates of a pool. To: the contribution weight of each sample, and the path kept of it. */
__kernel void pool_end(__global const FrameParams *restrict frame, __global const uint *restrict paths,
                       __global uint *restrict pass)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    pass_store(frame, pass, POOL_WEIGHT, item, state_load(paths, stride, BD_CANDIDATE_SUM, item));
    pass_store(frame, pass, POOL_KEY, item, state_load(paths, stride, BD_CANDIDATE, item));
    pass_store(frame, pass, POOL_LUMINANCE, item, state_load(paths, stride, BD_CANDIDATE_LUMINANCE, item));
}

/* From: where each chain starts. To: its coordinates. */
__kernel void mlt_begin(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                        __global const uint *restrict geometry, __global const uint *restrict tables,
                        __global const uint *restrict texels, __global const uint *restrict pass,
                        __global uint *restrict paths, __global uint *restrict rays, __global uint *restrict shadows)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint key = pass_load(frame, pass, CHAIN_PASS_KEY, item), pool_item = pass_load(frame, pass, CHAIN_PASS_ITEM, item);
    uint words = NUMBER_VERTICES + (chain_key_depth(key) - 1u) * chain_vertex_numbers(frame);
    state_store(paths, stride, CHAIN_KEY, item, key);
    state_store(paths, stride, CHAIN_STEP, item, pass_load(frame, pass, CHAIN_PASS_STEP, item));
    state_store(paths, stride, CHAIN_MOVE, item, MUTATION_REPLAY << MOVE_MUTATION);
    state_store_float(paths, stride, CHAIN_LUMINANCE, item, 0.0f);
    state_store(paths, stride, CHAIN_EXPECTED, item, pass_load(frame, pass, CHAIN_PASS_LUMINANCE, item));
    state_store_float(paths, stride, CHAIN_PENDING, item, 0.0f);
    state_store(paths, stride, CHAIN_BAD, item, NONE);
    state_store(paths, stride, CHAIN_RUN, item, run_begin(pass_load(frame, pass, CHAIN_PASS_RUN, item)));
    for (uint i = 0u; i < MUTATION_COUNT; ++i)
        state_store(paths, stride, CHAIN_TALLY + i, item, 0u);
    state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    walk_end(paths, rays, stride, item);
    if (pool_item != NONE) {
        KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
        chain_numbers_of_pool(scene, paths, item, key, pool_item);
        return;
    }
    for (uint i = 0u; i < words; ++i)
        state_store(paths, stride, CHAIN_NUMBERS + i, item, pass_load(frame, pass, CHAIN_PASS_NUMBERS + i, item));
}

/* A large step changes s, and with it which densities of a bank are the light's and which are the camera's. If the
 * current path's subpaths are in different banks, the proposal's would overwrite them, so the camera subpath moves to
 * the bank of the light subpath. */
SHARED_FUNCTION void chain_banks_join(__global const FrameParams *restrict frame, __global uint *restrict paths,
                                      __global uint *restrict vertices, __global uint *restrict densities, uint item)
{
    uint stride = frame->pass.stride, banks = chain_move(paths, stride, item, MOVE_BANKS);
    uint light = banks & 1u, camera = banks >> 1 & 1u, key = state_load(paths, stride, CHAIN_KEY, item);
    if (light == camera)
        return;
    for (uint i = chain_key_s(key); i < chain_key_depth(key); ++i)
        state_store_float(densities, stride, light * frame->path.max_depth + i, item,
                          state_load_float(densities, stride, camera * frame->path.max_depth + i, item));
    uint to = chain_subpath(SIDE_CAMERA, light), from = chain_subpath(SIDE_CAMERA, camera);
    for (uint i = 0u; i < CHAIN_CAMERA_SUBPATH_WORDS; ++i)
        state_store(paths, stride, to + i, item, state_load(paths, stride, from + i, item));
    to = chain_vertex_base(SIDE_CAMERA, light);
    from = chain_vertex_base(SIDE_CAMERA, camera);
    for (uint i = 0u; i < VERTEX_WORDS; ++i)
        state_store(vertices, stride, to + i, item, state_load(vertices, stride, from + i, item));
    to = shift_base(light);
    from = shift_base(camera);
    for (uint i = 0u; i < SHIFT_WORDS; ++i)
        state_store(vertices, stride, to + i, item, state_load(vertices, stride, from + i, item));
    chain_move_set(paths, stride, item, MOVE_BANKS, light != 0u ? SUBPATH_BOTH : 0u);
}

/* From: the current path. To: a proposal, and the first ray of its light walk if that is new. */
__kernel void mlt_propose(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                          __global const uint *restrict geometry, __global const uint *restrict tables,
                          __global const uint *restrict texels, __global uint *restrict paths,
                          __global uint *restrict rays, __global uint *restrict vertices,
                          __global uint *restrict densities, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    chain_propose(frame, paths, vertices, item);
    if (chain_move(paths, stride, item, MOVE_MUTATION) == MUTATION_LARGE)
        chain_banks_join(frame, paths, vertices, densities, item);
    uint key = state_load(paths, stride, CHAIN_PROPOSED_KEY, item), s = chain_key_s(key);
    state_store_vec3(paths, stride, BD_CONTRIBUTION, item, vec3_splat(0.0f));
    state_store(paths, stride, BD_LIGHT_DELTA, item, 0u);
    state_store(paths, stride, BD_CAMERA_DELTA, item, 0u);
    walk_end(paths, rays, stride, item);
    if ((chain_move(paths, stride, item, MOVE_REACHED) & SUBPATH_LIGHT) != 0u)
        return;
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    uint bank = chain_bank(paths, stride, item, SIDE_LIGHT);
    float own;
    Walk walk = {paths, rays, diagnostics, stride, item};
    if (walk_start_light(scene, walk, vertices, chain_vertex_base(SIDE_LIGHT, bank), chain_select(frame, paths, item),
                         chain_emit(frame, paths, item), &own)) {
        state_store_float(densities, stride, chain_density(frame, SIDE_LIGHT, bank, s, 0u), item, own);
        if (SCENE_HAS(scene, FEATURE_MEDIUM))
            chain_ray_media(scene, walk, SIDE_LIGHT, chain_key_depth(key), 1u, emitter_medium(scene, walk));
    }
}

/* From: the finished light walk. To: the camera's first ray, if the camera subpath is new and the light subpath is
 * complete. */
__kernel void mlt_start_camera(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                               __global const uint *restrict geometry, __global const uint *restrict tables,
                               __global const uint *restrict texels, __global uint *restrict paths,
                               __global uint *restrict rays, __global uint *restrict vertices,
                               __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint key = state_load(paths, stride, CHAIN_PROPOSED_KEY, item),
         reached = chain_move(paths, stride, item, MOVE_REACHED);
    walk_end(paths, rays, stride, item);
    if (reached != SUBPATH_LIGHT)
        return;
    shift_density_set(vertices, stride, chain_bank(paths, stride, item, SIDE_CAMERA), item, 0.0f);
    if (chain_key_s(key) == chain_key_depth(key)) { /* the camera subpath is the lens alone */
        chain_move_set(paths, stride, item, MOVE_REACHED, SUBPATH_BOTH);
        return;
    }
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    Walk walk = {paths, rays, diagnostics, stride, item};
    walk_start_film(scene, walk, chain_camera(frame, paths, item));
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        chain_ray_media(scene, walk, SIDE_CAMERA, chain_key_depth(key), 1u, frame->camera.medium);
}

/* The walk has made the last vertex of its side: stores what the connection needs to know of it. */
SHARED_FUNCTION void chain_subpath_store(__global uint *restrict paths, uint stride, uint item, uint side, uint bank)
{
    uint part = chain_subpath(side, bank), mask = side == SIDE_LIGHT ? BD_LIGHT_DELTA : BD_CAMERA_DELTA;
    uint flag = side == SIDE_LIGHT ? SUBPATH_LIGHT : SUBPATH_CAMERA;
    state_store(paths, stride, part + CHAIN_SUBPATH_DELTA, item, state_load(paths, stride, mask, item));
    if (side == SIDE_LIGHT) {
        state_store(paths, stride, part + CHAIN_SUBPATH_EMITTER_FLAGS, item,
                    state_load(paths, stride, BD_EMITTER_FLAGS, item));
        state_store(paths, stride, part + CHAIN_SUBPATH_CONNECT, item, state_load(paths, stride, BD_CONNECT, item));
    }
    chain_move_set(paths, stride, item, MOVE_REACHED, chain_move(paths, stride, item, MOVE_REACHED) | flag);
}

/* How far the walk of a chain is: at vertex `depth` of a side, whose subpath is in `bank`, of a proposal of d segments
 * with s vertices from the light. */
typedef struct ChainWalk {
    uint side, depth, bank, d, s;
} ChainWalk;

/* Continues the walk from a vertex that is not its last; only its position and geometric normal are read later. */
SHARED_FUNCTION void chain_walk_on(const SceneView *scene, Walk walk, __global uint *restrict vertices,
                                   __global uint *restrict densities, ChainWalk at, Random4 numbers, Vertex *vertex)
{
    __global const FrameParams *frame = scene->frame;
    __global uint *paths = walk.paths;
    uint stride = walk.stride, item = walk.item, side = at.side, depth = at.depth;
    bool shifts = frame->chains.shifts > 0.0f && side == SIDE_CAMERA && shift_draws(depth, at.d, at.s);
    WalkStep step = {0};
    vertex_place_store(vertices, stride, chain_vertex_base(side, at.bank), item, vertex);
    vertex->frame.b = vec3_cross(vertex->frame.n, vertex->frame.t); /* as frame_load makes it of the pool's vertex */
    if (shifts && (chain_move(paths, stride, item, MOVE_SHIFT) & SHIFT_KEEPS) != 0u) {
        if (!shift_guide(scene, paths, vertices, item, depth, vertex, &numbers)) {
            walk_end(paths, walk.rays, stride, item);
            return;
        }
        shift_numbers_store(frame, paths, item, at.d, depth, numbers);
    }
    if (!walk_leave_vertex(scene, walk, vertex, numbers, &step))
        return;
    if (shifts)
        shift_drawn(scene, paths, item, vertex, numbers, step.ray.d);
    walk_mark(paths, stride, item, side, depth, &step);
    if (side == SIDE_LIGHT || depth > 1u) {
        uint before = chain_density(frame, side, at.bank, at.s, depth - 1u);
        state_store_float(densities, stride, before, item,
                          step.reverse / state_load_float(densities, stride, before, item));
    }
    walk_step_store(paths, walk.rays, stride, item, depth, &step);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        chain_ray_media(scene, walk, side, at.d, depth + 1u, step.medium);
}

/* From: closest hits. To: the vertex with its density, the density ratio of the vertex before, and the next ray; for s
 * = 0, at the last vertex, the emission found there. A walk ends at its last vertex, by absorption, or where it can no
 * longer make a path. */
__kernel void mlt_walk(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                       __global const uint *restrict photons, __global const uint *restrict geometry,
                       __global const uint *restrict tables, __global const uint *restrict texels,
                       __global uint *restrict paths, __global uint *restrict rays, __global const uint *restrict hits,
                       __global uint *restrict vertices, __global uint *restrict densities,
                       __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, item), side = state_load(paths, stride, BD_SIDE, item);
    if (depth == 0u)
        return;
    KERNEL_SCENE_PHOTONS(frame, guide, photons, geometry, tables, texels);
    uint key = state_load(paths, stride, CHAIN_PROPOSED_KEY, item), d = chain_key_depth(key), s = chain_key_s(key);
    uint bank = chain_bank(paths, stride, item, side), base = chain_vertex_base(side, bank);
    uint last = side == SIDE_LIGHT ? s - 1u : s == 0u ? d : d - s;
    WalkHit walk_hit = {0};
    walk_hit.before = base;
    walk_hit_make(scene, paths, rays, hits, vertices, item, &walk_hit);
    state_store_float(densities, stride, chain_density(frame, side, bank, s, depth), item, walk_hit.own);
    if (frame->chains.shifts > 0.0f && side == SIDE_CAMERA && depth > 1u && shift_draws(depth - 1u, d, s) &&
        !shift_hit(scene, paths, vertices, item, depth, &walk_hit)) {
        walk_end(paths, rays, stride, item);
        return;
    }
    if (s == 0u && depth == d)
        chain_hit_light(scene, paths, densities, item, d, &walk_hit);
    if (walk_hit.missed || (s == 0u && depth == d)) {
        walk_end(paths, rays, stride, item);
        return;
    }
    Random4 numbers = {{0u, 0u, 0u, 0u}};
    if (depth < last || SCENE_HAS(scene, FEATURE_MIX))
        numbers = chain_vertex(frame, paths, item, side, d, depth);
    float u_mix = SCENE_HAS(scene, FEATURE_MIX) ? random_float(numbers.x[3]) : 0.5f;
    Vertex vertex;
    if (!walk_vertex_make(scene, paths, vertices, item, u_mix, &walk_hit, &vertex)) {
        walk_end(paths, rays, stride, item);
        return;
    }
    if (depth < last) {
        Walk walk = {paths, rays, diagnostics, stride, item};
        ChainWalk at = {side, depth, bank, d, s};
        chain_walk_on(scene, walk, vertices, densities, at, numbers, &vertex);
        return;
    }
    vertex_store(scene, vertices, stride, base, item, &vertex);
    chain_subpath_store(paths, stride, item, side, bank);
    walk_end(paths, rays, stride, item);
}

/* Connects the two last vertices of the proposal. film: chain_camera. */
SHARED_FUNCTION bool chain_connect(const SceneView *scene, __global const uint *restrict paths,
                                   __global uint *restrict shadows, __global const uint *restrict vertices, uint item,
                                   Random4 film, Connection *connection)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, key = state_load(paths, stride, CHAIN_PROPOSED_KEY, item);
    uint s = chain_key_s(key), camera = chain_key_depth(key) + 1u - s;
    uint light_bank = chain_bank(paths, stride, item, SIDE_LIGHT),
         camera_bank = chain_bank(paths, stride, item, SIDE_CAMERA);
    uint light_half = chain_subpath(SIDE_LIGHT, light_bank);
    Vertex y = {0}, z = {0};
    if (s > 1u)
        y = vertex_load(scene, vertices, stride, chain_vertex_base(SIDE_LIGHT, light_bank), item);
    if (camera > 1u)
        z = vertex_load(scene, vertices, stride, chain_vertex_base(SIDE_CAMERA, camera_bank), item);
    Random4 random = film;
    if (camera == 1u)
        random = connection_random_lens(film, film);
    else if (s == 1u)
        random = connection_random_light(chain_select(frame, paths, item), chain_emit(frame, paths, item));
    bool possible = connect_ends(scene, s, camera, &y, &z, random, connection);
    if (s >= 2u) {
        uint flags = state_load(paths, stride, light_half + CHAIN_SUBPATH_EMITTER_FLAGS, item);
        connection->ends.hittable = (flags & EMITTER_DELTA) == 0u;
        connection->ends.connect = state_load_float(paths, stride, light_half + CHAIN_SUBPATH_CONNECT, item);
    }
    if (!possible || !connection_traceable(connection))
        return false;
    return !connection_traced(scene, shadows, item) ||
           connection_pass(scene, shadows, item, s > 1u ? &y : 0, camera > 1u ? &z : 0, connection);
}

/* From: both subpaths. To: their connection, weighted, and its shadow ray. */
__kernel void mlt_connect(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                          __global const uint *restrict geometry, __global const uint *restrict tables,
                          __global const uint *restrict texels, __global uint *restrict paths,
                          __global uint *restrict shadows, __global const uint *restrict vertices,
                          __global const uint *restrict densities)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint key = state_load(paths, stride, CHAIN_PROPOSED_KEY, item), s = chain_key_s(key);
    uint camera = chain_key_depth(key) + 1u - s;
    if (s == 0u || chain_move(paths, stride, item, MOVE_REACHED) != SUBPATH_BOTH)
        return;
    Random4 film = chain_camera(frame, paths, item);
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    Connection connection = {0};
    bool traced = connection_traced(scene, shadows, item);
    if (!chain_connect(scene, paths, shadows, vertices, item, film, &connection))
        return;
    if (SCENE_HAS(scene, FEATURE_MEDIUM) && !traced) {
        connection_ray_store(scene, shadows, item, &connection);
        return;
    }
    DensityView view = chain_density_view(frame, paths, densities, item, s, camera);
    StrategyWeights weights = bd_weights(frame, s, camera, &view, &connection.ends);
    connection_store(paths, shadows, stride, item, &connection, weights.own);
    Vec2 position = camera == 1u ? connection.film : film_position(frame, film.x[0], film.x[1]);
    /* Path tracing does not draw one of the film positions from which a path is seen. */
    chain_place(scene, paths, item, position, vec3_scale(connection.contribution, weights.own),
                weights.path_tracing * connection.copies);
}

/* From: the proposal's contribution and visibility. To: the next current path, and one splat. */
__kernel void mlt_accept(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                         __global const uint *restrict geometry, __global const uint *restrict tables,
                         __global const uint *restrict texels, __global uint *restrict paths,
                         __global uint *restrict shadows, __global const uint *restrict vertices,
                         __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    bool cast = state_load_float(shadows, stride, RAY_T_MAX, item) > 0.0f;
    bool visible = shadow_take(shadows, stride, item);
    Vec3 color = state_load_vec3(paths, stride, BD_CONTRIBUTION, item);
    if (cast && !visible)
        color = vec3_splat(0.0f);
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    chain_decide(scene, paths, splats, diagnostics, item, color, shift_ratio(paths, vertices, stride, item));
}

/* From: the chains. To: splats of the visits that are still pending, and where the chains have ended. */
__kernel void mlt_end(__global const FrameParams *restrict frame, __global const Guide *restrict guide,
                      __global const uint *restrict geometry, __global const uint *restrict tables,
                      __global const uint *restrict texels, __global uint *restrict paths,
                      __global uint *restrict splats, __global uint *restrict pass, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE_GUIDED(frame, guide, geometry, tables, texels);
    chain_splat_current(scene, paths, splats, diagnostics, item, state_load_float(paths, stride, CHAIN_PENDING, item),
                        chain_random(frame, item, state_load(paths, stride, CHAIN_STEP, item), CHAIN_BLOCK_DECIDE));
    uint key = state_load(paths, stride, CHAIN_KEY, item), d = chain_key_depth(key);
    pass_store(frame, pass, CHAIN_PASS_KEY, item, chain_key(d, chain_key_s(key)));
    pass_store(frame, pass, CHAIN_PASS_LUMINANCE, item, state_load(paths, stride, CHAIN_LUMINANCE, item));
    pass_store(frame, pass, CHAIN_PASS_STEP, item, state_load(paths, stride, CHAIN_STEP, item));
    pass_store(frame, pass, CHAIN_PASS_BAD, item, state_load(paths, stride, CHAIN_BAD, item));
    pass_store(frame, pass, CHAIN_PASS_RUN, item, state_load(paths, stride, CHAIN_RUN, item));
    pass_store(frame, pass, CHAIN_PASS_CELL, item,
               importance_cell(frame, chain_film_load(paths, stride, CHAIN_FILM, item)));
    for (uint i = 0u; i < MUTATION_COUNT; ++i)
        pass_store(frame, pass, CHAIN_PASS_TALLY + i, item, state_load(paths, stride, CHAIN_TALLY + i, item));
    if (frame->chains.keep == 0u)
        return;
    uint words = NUMBER_VERTICES + (d - 1u) * chain_vertex_numbers(frame);
    for (uint i = 0u; i < words; ++i)
        pass_store(frame, pass, CHAIN_PASS_NUMBERS + i, item, state_load(paths, stride, CHAIN_NUMBERS + i, item));
}

#endif
