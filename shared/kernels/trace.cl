/* Ray queries with the hierarchy in BUFFER_BVH, for backends that have none of their own. Rays with t_max <= 0 are not
 * traced, and their hits or visibility stay unchanged. In scenes with media a ray goes on behind interfaces
 * (geometry/media_walk.h), and a shadow ray needs its closest hits for that. */
#ifndef TWINLIGHT_TRACE_CL
#define TWINLIGHT_TRACE_CL

#include "geometry/bvh_traverse.h"
#include "geometry/media_walk.h"
#include "layout/state.h"

__kernel void trace_closest(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global const uint *restrict bvh, __global const uint *restrict rays,
                            __global uint *restrict hits, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    Ray ray = ray_load(rays, stride, item);
    if (!(ray.t_max > 0.0f))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    if (!SCENE_HAS(scene, FEATURE_MEDIUM)) {
        hit_store(hits, stride, item, bvh_closest(scene, bvh, ray));
        return;
    }
    MediaWalk walk = media_walk_load(scene, rays, stride, item);
    Hit hit;
    do
        hit = bvh_closest(scene, bvh, ray);
    while (media_walk_on(scene, &ray, &hit, &walk));
    media_walk_end(hits, diagnostics, stride, item, ray, &walk, &hit);
    hit_store(hits, stride, item, hit);
}

__kernel void trace_shadow(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                           __global const uint *restrict tables, __global const uint *restrict texels,
                           __global const uint *restrict bvh, __global uint *restrict shadows,
                           __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    Ray ray = ray_load(shadows, stride, item);
    if (!(ray.t_max > 0.0f))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    if (!SCENE_HAS(scene, FEATURE_MEDIUM)) {
        state_store(shadows, stride, SHADOW_OCCLUDED, item, bvh_occluded(scene, bvh, ray) ? 1u : 0u);
        return;
    }
    MediaWalk walk = media_walk_begin(state_load(shadows, stride, SHADOW_MEDIUM, item));
    Hit hit;
    do
        hit = bvh_closest(scene, bvh, ray);
    while (media_walk_on(scene, &ray, &hit, &walk));
    shadow_walk_end(shadows, diagnostics, stride, item, &walk, &hit);
}

#endif
