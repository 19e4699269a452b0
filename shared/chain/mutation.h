/* What a chain proposes and whether it accepts: Metropolis's rule with expected values, where each proposal and each
 * current path is splatted with the probability of its visit (Veach 1997, section 11.3.2). */
#ifndef TWINLIGHT_CHAIN_MUTATION_H
#define TWINLIGHT_CHAIN_MUTATION_H

#include "chain/chain_numbers.h"
#include "chain/shift.h"
#include "path/bd_connect.h"

/* The numbers that choose the mutation at `step`. If chains are grouped all get the same, so that the kernels of a
 * subpath that does not change have nothing to do. */
SHARED_FUNCTION Random4 mutation_random(__global const FrameParams *frame, uint item, uint step)
{
    uint who = (frame->chains.mutations & MUTATION_GROUPED) != 0u ? NONE : frame->pass.first_item + item;
    return random_four(who, step, frame->pass.sample_index, PATH_STREAM_MUTATION, frame->pass.seed_low,
                       frame->pass.seed_high);
}

/* The kind of mutation. random: mutation_random. */
SHARED_FUNCTION uint mutation_choose(__global const FrameParams *frame, Random4 random)
{
    if (random_float(random.x[0]) < frame->chains.large_step)
        return MUTATION_LARGE;
    uint chances = 0u, set = frame->chains.mutations;
    for (uint kind = 0u; kind < MUTATION_LARGE; ++kind)
        chances += (set >> kind & 1u) * MUTATION_CHANCE(kind);
    uint rest = (uint)((ulong)random.x[1] * chances >> 32);
    for (uint kind = 0u; kind < MUTATION_LARGE; ++kind) {
        uint chance = (set >> kind & 1u) * MUTATION_CHANCE(kind);
        if (rest < chance)
            return kind;
        rest -= chance;
    }
    return MUTATION_ALL; /* the set is empty */
}

/* The scale of the mutation's small steps. */
SHARED_FUNCTION uint mutation_scale(Random4 random)
{
    return (uint)((ulong)random.x[2] * STEP_SCALES >> 32);
}

/* The subpaths (SUBPATH_*) that the mutation changes: both, if one of them has no coordinates. */
SHARED_FUNCTION uint mutation_subpaths(uint mutation, uint d, uint s)
{
    bool light = s > 0u, camera = s < d;
    if (mutation == MUTATION_LIGHT && light && camera)
        return SUBPATH_LIGHT;
    if (mutation == MUTATION_CAMERA && light && camera)
        return SUBPATH_CAMERA;
    return SUBPATH_BOTH;
}

/* Chooses the next mutation and makes the proposal's coordinates. The first proposal of a pass is the current path. */
SHARED_FUNCTION void chain_propose(__global const FrameParams *frame, __global uint *restrict paths,
                                   __global const uint *restrict vertices, uint item)
{
    uint stride = frame->pass.stride, key = state_load(paths, stride, CHAIN_KEY, item), d = chain_key_depth(key);
    uint step = state_load(paths, stride, CHAIN_STEP, item), mutation = MUTATION_REPLAY, changed = SUBPATH_BOTH,
         scale = 0u;
    uint shift = 0u;
    if (state_load_float(paths, stride, CHAIN_LUMINANCE, item) != 0.0f) {
        state_store(paths, stride, CHAIN_STEP, item, ++step);
        Random4 random = mutation_random(frame, item, step);
        mutation = mutation_choose(frame, random);
        scale = mutation_scale(random);
        changed = mutation_subpaths(mutation, d, chain_key_s(key));
        if (mutation == MUTATION_CAMERA && random_float(random.x[3]) < frame->chains.shifts)
            shift = shift_kind(paths, vertices, stride, item);
    }
    if (mutation == MUTATION_LARGE) {
        uint bits = chain_random(frame, item, step, CHAIN_BLOCK_S).x[0];
        key = chain_key(d, (uint)((ulong)bits * (d + 1u) >> 32));
    }
    uint kept = SUBPATH_BOTH & ~changed, reached = chain_key_s(key) < 2u ? kept | SUBPATH_LIGHT : kept;
    uint banks = state_load(paths, stride, CHAIN_MOVE, item) & 0xfu << MOVE_BANKS;
    state_store(paths, stride, CHAIN_MOVE, item,
                banks | mutation << MOVE_MUTATION | changed << MOVE_CHANGED | reached << MOVE_REACHED |
                    scale << MOVE_SCALE | shift << MOVE_SHIFT);
    state_store(paths, stride, CHAIN_PROPOSED_KEY, item, key);
    if (mutation != MUTATION_REPLAY)
        chain_move_numbers(frame, paths, item, false);
}

/* ---- splats ------------------------------------------------------------------------------------------------------ */

/* The part of a path that path tracing shows is stored in the upper half of a chain's key, as a number from 0 to this.
 * Rounding omits or doubles less than 2^-16 of a path. */
#define KEY_SHOWN_ALL 0xffffu

/* The key of a proposal at `film` with contribution `color`; path_tracing: weight of path tracing's strategies. Path
 * tracing would contribute color / path_tracing, of which, times importance, it shows what is below its clamping
 * threshold, as in path_shown (kernels/pt.cl). Camera walks start with throughput film_reach_factor, which is divided
 * out here, since path tracing does not have it; nor do paths that the light walk connects to the lens (t = 1). */
SHARED_FUNCTION uint chain_key_shown(const SceneView *scene, uint key, Vec2 film, Vec3 color, float path_tracing)
{
    __global const FrameParams *frame = scene->frame;
    uint d = chain_key_depth(key), s = chain_key_s(key), shown = KEY_SHOWN_ALL;
    float limit = partition_threshold(frame, PARTITION_PATHS) * path_tracing;
    float worth = rgb_luminance(color) * film_importance(frame, scene->guide, film);
    if (s < d)
        worth /= film_reach_factor(frame);
    if (partition_clamps(frame) && worth > limit)
        shown = (uint)(partition_shown(worth, limit) * (float)KEY_SHOWN_ALL + 0.5f);
    return chain_key(d, s) | shown << 16;
}

/* Layers (SPLAT_*) of a whole splat, chosen at random: in expectation, the part of the path that the pool shows has
 * SPLAT_LIGHT and its excess SPLAT_EXCESS; the part that path tracing does not show also has SPLAT_RARE. */
SHARED_FUNCTION uint chain_splat_layers(__global const FrameParams *frame, uint key, float f, float u)
{
    bool by_pool = partition_draw(u, f, partition_threshold(frame, PARTITION_POOL));
    bool by_paths = partition_draw(u, (float)KEY_SHOWN_ALL, (float)(key >> 16));
    return (by_pool ? SPLAT_LIGHT : SPLAT_EXCESS) | (by_paths ? 0u : SPLAT_RARE);
}

/* A path at `film` whose contribution is f times `color`, for `visits` expected visits. */
typedef struct ChainSplat {
    uint key; /* chain_key_shown */
    Vec2 film;
    float f;
    Vec3 color;
    float visits;
} ChainSplat;

/* Splats a path. random: block CHAIN_BLOCK_DECIDE. A path's excess over the clamping threshold is kept apart
 * (host/mmlt/combination.h): all of a splat or nothing of it, at random. */
SHARED_FUNCTION void chain_splat(const SceneView *scene, __global uint *restrict splats,
                                 __global uint *restrict diagnostics, uint item, const ChainSplat *path, Random4 random)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, pixel = NONE;
    float weight = 0.0f;
    if (path->visits > 0.0f)
        pixel =
            film_splat_pixel(scene, path->film, vec2(random_float(random.x[1]), random_float(random.x[2])), &weight);
    if (pixel == NONE)
        state_store(splats, stride, SPLAT_PIXEL, item, NONE);
    else
        splat_store(splats, diagnostics, stride, item,
                    chain_splat_layers(frame, path->key, path->f, random_float(random.x[3])) | pixel |
                        splat_depth(frame->film.split_depths, chain_key_depth(path->key)),
                    splat_offset(&frame->film, pixel, path->film),
                    vec3_scale(path->color, path->visits * (weight * frame->chains.brightness)));
}

SHARED_FUNCTION Vec2 chain_film_load(__global const uint *restrict paths, uint stride, uint field, uint item)
{
    return vec2(state_load_float(paths, stride, field, item), state_load_float(paths, stride, field + 1u, item));
}

SHARED_FUNCTION void chain_splat_current(const SceneView *scene, __global const uint *restrict paths,
                                         __global uint *restrict splats, __global uint *restrict diagnostics, uint item,
                                         float visits, Random4 random)
{
    uint stride = scene->frame->pass.stride;
    ChainSplat path = {state_load(paths, stride, CHAIN_KEY, item), chain_film_load(paths, stride, CHAIN_FILM, item),
                       state_load_float(paths, stride, CHAIN_LUMINANCE, item),
                       state_load_vec3(paths, stride, CHAIN_COLOR, item), visits};
    chain_splat(scene, splats, diagnostics, item, &path, random);
}

/* ---- the rule ---------------------------------------------------------------------------------------------------- */

/* Makes the proposal, with target f and contribution `color`, the current path, with `visits` expected visits so
 * far. */
SHARED_FUNCTION void chain_take(__global const FrameParams *frame, __global uint *restrict paths, uint item, float f,
                                Vec3 color, float visits)
{
    uint stride = frame->pass.stride;
    Vec2 film = chain_film_load(paths, stride, CHAIN_PROPOSED_FILM, item);
    state_store(paths, stride, CHAIN_KEY, item, state_load(paths, stride, CHAIN_PROPOSED_KEY, item));
    chain_move_set(paths, stride, item, MOVE_BANKS,
                   chain_move(paths, stride, item, MOVE_BANKS) ^ chain_move(paths, stride, item, MOVE_CHANGED));
    state_store_float(paths, stride, CHAIN_LUMINANCE, item, f);
    state_store_vec3(paths, stride, CHAIN_COLOR, item, vec3_scale(color, 1.0f / f));
    state_store_float(paths, stride, CHAIN_FILM, item, film.x);
    state_store_float(paths, stride, CHAIN_FILM + 1u, item, film.y);
    state_store_float(paths, stride, CHAIN_PENDING, item, visits);
}

/* The target function f of chains: luminance of a contribution, times how far the pixels' filters cover its film
 * position, times the target importance there. */
SHARED_FUNCTION float chain_target(const SceneView *scene, Vec2 film, Vec3 color)
{
    float f = rgb_luminance(color);
    if (f > 0.0f)
        f *= film_splat_cover(scene, film) * film_importance(scene->frame, scene->guide, film);
    return f;
}

/* Decides on the proposal, whose contribution is `color`. Accepts with probability a = min(1, f' / f * change), where
 * `change` is the Jacobian of a shift (shift_ratio), 1 for steps. The film gets expected values: a of the proposal and
 * 1 - a of the current path, which is summed up until the chain leaves it. So each step makes one splat: of the path
 * that the chain leaves, or of the rejected proposal. */
SHARED_FUNCTION void chain_decide(const SceneView *scene, __global uint *restrict paths, __global uint *restrict splats,
                                  __global uint *restrict diagnostics, uint item, Vec3 color, float change)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, mutation = chain_move(paths, stride, item, MOVE_MUTATION);
    float f = chain_target(scene, chain_film_load(paths, stride, CHAIN_PROPOSED_FILM, item), color);
    float current = state_load_float(paths, stride, CHAIN_LUMINANCE, item);
    if (!float_finite(f)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_NOT_FINITE);
        if (state_load(paths, stride, CHAIN_BAD, item) == NONE)
            state_store(paths, stride, CHAIN_BAD, item, state_load(paths, stride, CHAIN_STEP, item));
        f = 0.0f;
    }
    f = float_max(f, 0.0f);
    if (mutation == MUTATION_REPLAY) {
        uint expected = state_load(paths, stride, CHAIN_EXPECTED, item);
        state_store(splats, stride, SPLAT_PIXEL, item, NONE);
        if (expected != 0u && expected != float_bits(f))
            diagnostic_count(diagnostics, DIAGNOSTIC_REPLAY);
        if (f > 0.0f)
            chain_take(frame, paths, item, f, color, 0.0f);
        else
            diagnostic_count(diagnostics, DIAGNOSTIC_LOST_CHAIN);
        return;
    }
    float ratio = f > 0.0f ? f / current * change : 0.0f, accept = float_min(ratio, 1.0f),
          pending = state_load_float(paths, stride, CHAIN_PENDING, item);
    Random4 random = chain_random(frame, item, state_load(paths, stride, CHAIN_STEP, item), CHAIN_BLOCK_DECIDE);
    bool taken = f > 0.0f && random_float(random.x[0]) < accept;
    uint tally = state_load(paths, stride, CHAIN_TALLY + mutation, item);
    state_store(paths, stride, CHAIN_TALLY + mutation, item, tally + 1u + (taken ? 0x10000u : 0u));
    state_store(paths, stride, CHAIN_RUN, item, run_after(state_load(paths, stride, CHAIN_RUN, item), taken));
    if (taken) {
        chain_splat_current(scene, paths, splats, diagnostics, item, pending + (1.0f - accept), random);
        chain_take(frame, paths, item, f, color, accept);
    } else {
        if (f > 0.0f)
            color = vec3_scale(color, 1.0f / f);
        ChainSplat path = {state_load(paths, stride, CHAIN_PROPOSED_KEY, item),
                           chain_film_load(paths, stride, CHAIN_PROPOSED_FILM, item), f, color, accept};
        chain_splat(scene, splats, diagnostics, item, &path, random);
        state_store_float(paths, stride, CHAIN_PENDING, item, pending + (1.0f - accept));
        chain_move_numbers(frame, paths, item, true);
    }
}

#endif
