/* The partition of a path's contribution among MMLT's estimators.
 *
 * A path that carries much is a bright dot where the pool or path tracing meets it by chance. Each of these two shows as
 * much of a path as its threshold, and the chains, which visit many paths like it, show the rest: as its excess (what the
 * pool leaves) where an image is of chains and pool, as its rare part (what path tracing leaves) where it is of chains and
 * path tracing. For every path, what is shown and what is left are 1 together; whoever computes either computes it here.
 *
 * What a path carries depends on who meets it: in the pool it is f, the target of the chains (chain_target); by path
 * tracing its luminance over the sum of the densities of path tracing's own strategies, s = 0 and 1, times the target
 * importance. */
#ifndef TWINLIGHT_PATH_PARTITION_H
#define TWINLIGHT_PATH_PARTITION_H

#include "layout/scene_types.h"

/* Path tracing shows so many times as much of a path as the pool. */
#define RARE_OVER_CLAMP 4.0f

#define PARTITION_POOL 0u
#define PARTITION_PATHS 1u

/* Whether anything is left to the chains. */
SHARED_FUNCTION bool partition_clamps(__global const FrameParams *frame)
{
    return frame->clamp_threshold < FLOAT_MAX;
}

/* What a path may carry before the estimator (PARTITION_*) leaves a part of it. */
SHARED_FUNCTION float partition_threshold(__global const FrameParams *frame, uint estimator)
{
    return estimator == PARTITION_POOL ? frame->clamp_threshold : RARE_OVER_CLAMP * frame->clamp_threshold;
}

/* The part that is shown of a path that carries `carried`; 1 less that is left. Both may be divided by the same factor. */
SHARED_FUNCTION float partition_shown(float carried, float threshold)
{
    return carried > threshold ? threshold / carried : 1.0f;
}

/* The same by chance: whether a visit counts among what is shown, with that part as its probability. u: uniform in [0, 1). */
SHARED_FUNCTION bool partition_draw(float u, float carried, float threshold)
{
    return u * carried < threshold;
}

#endif
