/* Which random number a bidirectional path uses for what: like path_random.h, one function of (seed, pixel, sample,
 * block). */
#ifndef TWINLIGHT_BD_RANDOM_H
#define TWINLIGHT_BD_RANDOM_H

#include "bd_state.h"
#include "rng.h"

#define BD_RANDOM_CAMERA 0u /* filter offset, lens */
#define BD_RANDOM_LIGHT 1u /* x, y: which light */
#define BD_RANDOM_EMIT 2u /* point and direction on it */
/* Two blocks for every vertex of either side: scattering (lobe, direction, roulette) and the choice of mix materials. */
#define BD_RANDOM_VERTICES 4u
#define BD_RANDOM_SCATTER 0u
#define BD_RANDOM_MIX 1u
/* One block for every connection: s = 1: which light (x, y), point on it; t = 1: lens, pixel. */
#define BD_RANDOM_CONNECTIONS 0x1000u

#define PATH_STREAM_BD 1u

SHARED_FUNCTION Random4 bd_random(__global const FrameParams *frame, __global const uint *paths, uint t, uint block)
{
    uint stride = frame->stride;
    return random_four(state_load(paths, stride, BD_PIXEL, t), state_load(paths, stride, BD_SAMPLE, t), block,
                       PATH_STREAM_BD, frame->seed_low, frame->seed_high);
}

/* Block of vertex i of a side. */
SHARED_FUNCTION uint bd_random_vertex(uint side, uint i, uint what)
{
    return BD_RANDOM_VERTICES + (2u * i + side) * 2u + what;
}

SHARED_FUNCTION uint bd_random_connection(uint s, uint t)
{
    return BD_RANDOM_CONNECTIONS + s * 64u + t;
}

#endif
