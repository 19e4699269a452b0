/* Which random numbers a bidirectional path uses for what; as in path/path_random.h, a function of (seed, pixel,
 * sample, block). */
#ifndef TWINLIGHT_PATH_BD_RANDOM_H
#define TWINLIGHT_PATH_BD_RANDOM_H

#include "layout/scene_view.h"
#include "path/bd_state.h"
#include "path/path_random.h"

#define BD_RANDOM_CAMERA 0u /* filter offset, lens */
#define BD_RANDOM_LIGHT 1u /* x: light_select_point; z: aim */
#define BD_RANDOM_EMIT 2u /* which light and point on it, direction */
#define BD_RANDOM_PIXEL 3u /* of a pool: film numbers of paths that do not start on the film (t = 1) */
/* Two blocks for every vertex of either side: scattering (lobe, direction, roulette) and the choice of mix
 * materials. */
#define BD_RANDOM_VERTICES 4u
#define BD_RANDOM_SCATTER 0u
#define BD_RANDOM_MIX 1u
/* One block per connection. */
#define BD_RANDOM_CONNECTIONS 0x1000u

/* One block per connection of a pool, to draw the candidate (chain/pool.h); s * 64 + t. */
#define BD_RANDOM_CANDIDATES 0x2000u

/* The first of two numbers of a block that belong together (sample_random). */
SHARED_FUNCTION uint bd_random_pair(uint block)
{
    if (block >= BD_RANDOM_CONNECTIONS)
        return block < BD_RANDOM_CONNECTIONS + 2u * 64u ? 2u : 0u; /* s = 1: light_select_point */
    return block >= BD_RANDOM_VERTICES && (block & 1u) == BD_RANDOM_SCATTER ? 1u : 0u;
}

SHARED_FUNCTION Random4 bd_random_of(__global const FrameParams *frame, __global const uint *paths, uint item,
                                     uint block, uint stream)
{
    uint stride = frame->pass.stride;
    return sample_random(frame, state_load(paths, stride, BD_PIXEL, item), state_load(paths, stride, BD_SAMPLE, item),
                         block, stream, bd_random_pair(block));
}

SHARED_FUNCTION Random4 bd_random(__global const FrameParams *frame, __global const uint *paths, uint item, uint block)
{
    return bd_random_of(frame, paths, item, block, frame->pool.enabled != 0u ? PATH_STREAM_POOL : PATH_STREAM_BD);
}

/* bd_random of the pool sample whose pixel and sample number the item holds. */
SHARED_FUNCTION Random4 pool_random(__global const FrameParams *frame, __global const uint *paths, uint item,
                                    uint block)
{
    return bd_random_of(frame, paths, item, block, PATH_STREAM_POOL);
}

/* The block of vertex i of a side. */
SHARED_FUNCTION uint bd_random_vertex(uint side, uint i, uint what)
{
    return BD_RANDOM_VERTICES + (2u * i + side) * 2u + what;
}

/* The number that decides mix materials at the vertex after `depth` segments of a side; a constant in scenes without
 * mix materials. */
SHARED_FUNCTION float bd_random_mix(const SceneView *scene, __global const uint *paths, uint item, uint side,
                                    uint depth)
{
    if (!SCENE_HAS(scene, FEATURE_MIX))
        return 0.5f;
    return random_float(bd_random(scene->frame, paths, item, bd_random_vertex(side, depth, BD_RANDOM_MIX)).x[0]);
}

/* The number that draws the distance of segment `depth` of a side; in scenes without scattering media it is not
 * used. */
SHARED_FUNCTION uint bd_random_distance(const SceneView *scene, __global const uint *paths, uint item, uint side,
                                        uint depth)
{
    if (!SCENE_HAS(scene, FEATURE_SCATTERING))
        return 0u;
    return bd_random(scene->frame, paths, item, bd_random_vertex(side, depth, BD_RANDOM_MIX)).x[1];
}

/* A chain has one lens point and one light for all its connections. Turns its coordinates (camera: film, lens) into the
 * numbers of a connection to the lens, where `random` has those of the pixel ... */
SHARED_FUNCTION Random4 connection_random_lens(Random4 random, Random4 camera)
{
    random.x[0] = camera.x[2];
    random.x[1] = camera.x[3];
    return random;
}

/* ... and (choice: which light; emit: point on it, direction) into the numbers of a connection to a light. */
SHARED_FUNCTION Random4 connection_random_light(Random4 choice, Random4 emit)
{
    choice.x[2] = emit.x[0];
    choice.x[3] = emit.x[1];
    return choice;
}

/* The numbers of connection (s, t). s = 1: light_select_point; t = 1: lens, pixel. */
SHARED_FUNCTION Random4 bd_random_connection(__global const FrameParams *frame, __global const uint *paths, uint item,
                                             uint s, uint t)
{
    Random4 random = bd_random(frame, paths, item, BD_RANDOM_CONNECTIONS + s * 64u + t);
    if (frame->pool.enabled != 0u && t == 1u)
        return connection_random_lens(random, bd_random(frame, paths, item, BD_RANDOM_CAMERA));
    if (frame->pool.enabled != 0u && s == 1u)
        return connection_random_light(bd_random(frame, paths, item, BD_RANDOM_LIGHT),
                                       bd_random(frame, paths, item, BD_RANDOM_EMIT));
    return random;
}

#endif
