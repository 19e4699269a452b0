/* The partition of a path's contribution among MMLT's estimators.
 *
 * A path with a large contribution shows as a bright dot if the pool or path tracing finds it by chance. Each of these
 * two shows a path up to its clamping threshold, and the chains, which visit many paths like it, show the rest: as its
 * excess (what the pool leaves) where an image combines chains and pool, as its rare part (what path tracing leaves)
 * where it combines chains and path tracing. The part shown and the part left of a path add up to one; both are
 * computed here alone.
 *
 * What a path carries depends on the estimator: in the pool it is f, the target of the chains (chain_target); in path
 * tracing it is its luminance over the sum of the densities of path tracing's own strategies, s = 0 and 1, times the
 * target importance. */
#ifndef TWINLIGHT_PATH_PARTITION_H
#define TWINLIGHT_PATH_PARTITION_H

#include "layout/frame_params.h"

/* Clamping threshold of path tracing over that of the pool. */
#define RARE_OVER_CLAMP 4.0f

#define PARTITION_POOL 0u
#define PARTITION_PATHS 1u

/* Whether anything is left to the chains. */
SHARED_FUNCTION bool partition_clamps(__global const FrameParams *frame)
{
    return frame->partition.clamp_threshold < FLOAT_MAX;
}

/* The clamping threshold: what a path may carry before the estimator (PARTITION_*) leaves a part of it to the
 * chains. */
SHARED_FUNCTION float partition_threshold(__global const FrameParams *frame, uint estimator)
{
    return estimator == PARTITION_POOL ? frame->partition.clamp_threshold
                                       : RARE_OVER_CLAMP * frame->partition.clamp_threshold;
}

/* The part shown of a path that carries `carried`; the rest is left. Both arguments may be divided by the same
 * factor. */
SHARED_FUNCTION float partition_shown(float carried, float threshold)
{
    return carried > threshold ? threshold / carried : 1.0f;
}

/* partition_shown at random: whether a visit counts as shown, with that part as its probability. u: uniform in [0,
 * 1). */
SHARED_FUNCTION bool partition_draw(float u, float carried, float threshold)
{
    return u * carried < threshold;
}

#endif
