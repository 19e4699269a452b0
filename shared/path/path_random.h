/* Which random numbers a path uses for what. A number is a function of (seed, pixel, sample, block of four): nothing is
 * stored, and any path can be replayed. With PathParams.sobol, samples of a pixel are stratified in the four dimensions
 * of every block (math/sobol.h); of different pixels, blocks and seeds they are independent. */
#ifndef TWINLIGHT_PATH_PATH_RANDOM_H
#define TWINLIGHT_PATH_PATH_RANDOM_H

#include "layout/frame_params.h"
#include "math/sobol.h"

/* Block 0 is the camera's: filter offset, lens. Three blocks follow for every vertex of the path. */
#define RANDOM_CAMERA 0u
#define RANDOM_LIGHT 1u /* z, w: which light, and point on it; x: light_select_point */
#define RANDOM_SCATTER 2u /* x: lobe. y, z: direction. w: Russian roulette */
#define RANDOM_MIX 3u /* x: mix materials; y: the distance of the segment that ends there */
#define RANDOM_BLOCKS_PER_VERTEX 3u

/* The block of a pixel's sample, of the integrator `stream`. pair: the first of two numbers that are best stratified
 * together. */
SHARED_FUNCTION Random4 sample_random(__global const FrameParams *frame, uint pixel, uint sample, uint block,
                                      uint stream, uint pair)
{
    uint low = frame->pass.seed_low, high = frame->pass.seed_high;
    uint behind = frame->path.sobol;
    if (behind == 0u)
        return random_four(pixel, sample, block, stream, low, high);
    return sobol_four(sample + 1u - behind, random_four(pixel, 0u - behind, block, stream, low, high), pair);
}

SHARED_FUNCTION Random4 path_random(__global const FrameParams *frame, uint pixel, uint sample, uint block)
{
    uint what = block % RANDOM_BLOCKS_PER_VERTEX;
    return sample_random(frame, pixel, sample, block, PATH_STREAM_PT,
                         what == RANDOM_LIGHT     ? 2u
                         : what == RANDOM_SCATTER ? 1u
                                                  : 0u);
}

/* Block of the vertex that ends segment `depth` (1, 2, ...); `what` one of RANDOM_LIGHT, RANDOM_SCATTER, RANDOM_MIX. */
SHARED_FUNCTION uint path_random_block(uint depth, uint what)
{
    return (depth - 1u) * RANDOM_BLOCKS_PER_VERTEX + what;
}

#endif
