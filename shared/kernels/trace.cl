/* Ray queries with the hierarchy in BUFFER_BVH, for backends that have none of their own. Rays with t_max <= 0 are not
 * traced, and their hits or visibility stay unchanged. */
#ifndef TWINLIGHT_TRACE_CL
#define TWINLIGHT_TRACE_CL

#include "geometry/bvh_traverse.h"
#include "layout/state.h"

__kernel void trace_closest(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global const uint *restrict bvh, __global const uint *restrict rays,
                            __global uint *restrict hits)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    Ray ray = ray_load(rays, stride, item);
    if (!(ray.t_max > 0.0f))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    hit_store(hits, stride, item, bvh_closest(scene, bvh, ray));
}

__kernel void trace_shadow(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                           __global const uint *restrict tables, __global const uint *restrict texels,
                           __global const uint *restrict bvh, __global uint *restrict shadows)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    Ray ray = ray_load(shadows, stride, item);
    if (!(ray.t_max > 0.0f))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    state_store(shadows, stride, SHADOW_OCCLUDED, item, bvh_occluded(scene, bvh, ray) ? 1u : 0u);
}

#endif
