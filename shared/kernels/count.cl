/* Counts live rays: for the statistics, and to see when no path continues. */
#ifndef TWINLIGHT_COUNT_CL
#define TWINLIGHT_COUNT_CL

#include "layout/frame_params.h"
#include "layout/state.h"

/* Adds the live rays among those of counting item g: rays g, g + groups, g + 2 groups ..., so that neighbouring items
 * read neighbouring words. */
SHARED_FUNCTION void rays_count(__global const FrameParams *frame, __global const uint *rays, __global uint *counter,
                                uint g)
{
    uint count = frame->pass.item_count, groups = (count + COUNT_RAYS - 1u) / COUNT_RAYS, live = 0u;
    if (g >= groups)
        return;
    for (uint item = g; item < count; item += groups)
        live += state_load_float(rays, frame->pass.stride, RAY_T_MAX, item) > 0.0f ? 1u : 0u;
    if (live != 0u)
        counter_add(counter, live);
}

/* From: rays to trace. To: their number added to counts[COUNT_CLOSEST]. */
__kernel void count_closest(__global const FrameParams *frame, __global const uint *rays, __global uint *counts)
{
    rays_count(frame, rays, counts + COUNT_CLOSEST, (uint)get_global_id(0));
}

/* From: shadow rays to trace. To: their number added to counts[COUNT_SHADOW]. */
__kernel void count_shadow(__global const FrameParams *frame, __global const uint *shadows, __global uint *counts)
{
    rays_count(frame, shadows, counts + COUNT_SHADOW, (uint)get_global_id(0));
}

#endif
