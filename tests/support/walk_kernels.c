/* Compiled and looped over as the CPU backend does its own kernels, but for buffers of any stride. */
#define KERNEL_ANY_STRIDE
#include "kernel_loop.h"

#include "support/walk_kernels.h"

#include "geometry/surface.h"
#include "layout/diagnostics.h"
#include "layout/state.h"
#include "math/rng.h"
#include "math/warp.h"

#define WALK_STREAM 0x77616c6bu

SHARED_FUNCTION uint walk_hash(uint h, uint word)
{
    h = (h ^ word) * 0x01000193u; /* FNV-1a on words */
    return h ^ (h >> 15);
}

SHARED_FUNCTION Random4 walk_random(__global const FrameParams *frame, uint item, uint step)
{
    return random_four(frame->pass.first_item + item, frame->pass.sample_index, step, WALK_STREAM, frame->pass.seed_low,
                       frame->pass.seed_high);
}

/* To: a ray from the middle of the scene in a uniform direction. */
__kernel void walk_start(__global const FrameParams *frame, __global uint *paths, __global uint *rays)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    Random4 random = walk_random(frame, item, 0u);
    Vec3 d = warp_sphere(vec2(random_float(random.x[0]), random_float(random.x[1])));
    state_store(paths, stride, WALK_STEP, item, 1u);
    state_store(paths, stride, WALK_HASH, item, 0x811c9dc5u);
    state_store_vec3(paths, stride, WALK_POINT, item, frame->scene.world_center);
    state_store_vec3(paths, stride, WALK_NG, item, vec3_splat(0.0f));
    ray_store(rays, stride, item, ray_spawn(frame->scene.world_center, vec3_splat(0.0f), d));
}

/* From: a hit. To: the next ray, and a shadow ray to the previous point. A walk that misses starts again. */
__kernel void walk_extend(__global const FrameParams *frame, __global const uint *geometry, __global const uint *tables,
                          __global const uint *texels, __global uint *paths, __global uint *rays,
                          __global const uint *hits, __global uint *shadows)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    uint step = state_load(paths, stride, WALK_STEP, item), h = state_load(paths, stride, WALK_HASH, item);
    for (uint field = 0; field < HIT_WORDS; ++field)
        h = walk_hash(h, state_load(hits, stride, field, item));
    Ray ray = ray_load(rays, stride, item);
    Hit hit = hit_load(hits, stride, item);
    Random4 random = walk_random(frame, item, step);
    Vec3 d = warp_sphere(vec2(random_float(random.x[0]), random_float(random.x[1])));
    Vec3 p = frame->scene.world_center, ng = vec3_splat(0.0f);
    if (hit.primitive != NONE) {
        Surface surface = surface_from_hit(scene, &ray, hit);
        p = surface.p;
        ng = surface.ng;
    }
    ray_store(shadows, stride, item,
              ray_between(p, ng, state_load_vec3(paths, stride, WALK_POINT, item),
                          state_load_vec3(paths, stride, WALK_NG, item)));
    ray_store(rays, stride, item, ray_spawn(p, ng, d));
    state_store_vec3(paths, stride, WALK_POINT, item, p);
    state_store_vec3(paths, stride, WALK_NG, item, ng);
    state_store(paths, stride, WALK_STEP, item, step + 1u);
    state_store(paths, stride, WALK_HASH, item, h);
}

/* To: the hash as a colour, and the last shadow ray's answer. */
__kernel void walk_splat(__global const FrameParams *frame, __global const uint *paths, __global const uint *shadows,
                         __global uint *splats, __global uint *diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint h = state_load(paths, stride, WALK_HASH, item);
    bool traced = state_load_float(shadows, stride, RAY_T_MAX, item) > 0.0f;
    if (!traced)
        diagnostic_count(diagnostics, DIAGNOSTIC_ZERO_DIRECTION);
    uint occluded = traced ? state_load(shadows, stride, SHADOW_OCCLUDED, item) : 2u;
    state_store(splats, stride, SPLAT_PIXEL, item, frame->pass.first_item + item);
    state_store_vec3(splats, stride, SPLAT_COLOR, item, vec3((float)(h >> 16), (float)(h & 0xffffu), (float)occluded));
}

KERNEL_LOOP(walk_start, 3, BUFFER_FRAME, BUFFER_PATHS, BUFFER_RAYS)
KERNEL_LOOP(walk_extend, 8, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,
            BUFFER_HITS, BUFFER_SHADOWS)
KERNEL_LOOP(walk_splat, 5, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SHADOWS, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)
