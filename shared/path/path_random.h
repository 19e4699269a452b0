/* Which random numbers a path uses for what. A number is a function of (seed, pixel, sample, block of four): nothing is
 * stored, and any path can be replayed. */
#ifndef TWINLIGHT_PATH_PATH_RANDOM_H
#define TWINLIGHT_PATH_PATH_RANDOM_H

#include "layout/frame_params.h"
#include "math/rng.h"

/* Block 0 is the camera's: filter offset, lens. Three blocks follow for every vertex of the path. */
#define RANDOM_CAMERA 0u
#define RANDOM_LIGHT 1u /* x, y: which light (32 bits each). z, w: point on it */
#define RANDOM_SCATTER 2u /* x: lobe. y, z: direction. w: Russian roulette */
#define RANDOM_MIX 3u /* x: mix materials */
#define RANDOM_BLOCKS_PER_VERTEX 3u

SHARED_FUNCTION Random4 path_random(__global const FrameParams *frame, uint pixel, uint sample, uint block)
{
    return random_four(pixel, sample, block, PATH_STREAM_PT, frame->pass.seed_low, frame->pass.seed_high);
}

/* Block of the vertex that ends segment `depth` (1, 2, ...); `what` one of RANDOM_LIGHT, RANDOM_SCATTER, RANDOM_MIX. */
SHARED_FUNCTION uint path_random_block(uint depth, uint what)
{
    return (depth - 1u) * RANDOM_BLOCKS_PER_VERTEX + what;
}

#endif
