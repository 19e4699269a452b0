/* The pool from which chains begin: independent bidirectional samples, each a pair of walks with all connections between
 * them, of which one path is kept in proportion to what it carries (a bundle of candidates, and one of them drawn).
 *
 * The random numbers of a pool's sample are a chain's coordinates: the same light and the same point on the lens serve
 * every connection, and the film position is two of the numbers. So the path kept can be made again from the sample's
 * number, its depth d and its light vertices s. */
#ifndef TWINLIGHT_POOL_H
#define TWINLIGHT_POOL_H

#include "bd_random.h"
#include "bd_start.h"
#include "film_splat.h"

/* BUFFER_PASS of a pool: what a sample is worth, and the path kept of it (chain_key); 0: none. */
#define POOL_WEIGHT 0u /* sum of the luminances of all its paths */
#define POOL_KEY 1u
#define POOL_LUMINANCE 2u /* of the path kept, as a chain sees it */
#define POOL_WORDS 3u

/* d segments, s of the vertices from the light. */
SHARED_FUNCTION uint chain_key(uint d, uint s)
{
    return d | s << 8;
}

SHARED_FUNCTION uint chain_key_depth(uint key)
{
    return key & 0xffu;
}

SHARED_FUNCTION uint chain_key_s(uint key)
{
    return key >> 8;
}

/* The camera's first ray, and the pixel that the sample's gathered light goes to. */
SHARED_FUNCTION void pool_start_camera(const SceneView *scene, __global uint *restrict paths,
                                       __global uint *restrict rays, __global uint *restrict diagnostics, uint t)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->stride;
    Random4 random = bd_random(frame, paths, t, BD_RANDOM_CAMERA);
    Random4 aim = bd_random(frame, paths, t, BD_RANDOM_PIXEL);
    float weight;
    uint pixel = film_splat_pixel(scene, film_position(frame, random.x[0], random.x[1]),
                                  vec2(random_float(aim.x[0]), random_float(aim.x[1])), &weight);
    state_store(paths, stride, BD_SPLAT, t, pixel == NONE ? NONE : SPLAT_FROM_LIGHT | pixel);
    state_store_float(paths, stride, BD_WEIGHT, t, weight);
    walk_start_film(scene, paths, rays, diagnostics, stride, t, random);
}

/* The part of a pool's path that the film is shown. */
SHARED_FUNCTION Vec3 pool_limited(__global const FrameParams *frame, Vec3 contribution)
{
    float luminance = rgb_luminance(contribution);
    return luminance > frame->limit ? vec3_scale(contribution, frame->limit / luminance) : contribution;
}

/* The path of the strategy (s, t) carries `contribution`, having survived roulette with that probability: it becomes the
 * candidate with the probability of its share in all so far. */
SHARED_FUNCTION void candidate_offer(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                     uint s, uint t, float survival, Vec3 contribution)
{
    uint stride = frame->stride;
    float luminance = rgb_luminance(contribution);
    if (!(luminance > 0.0f) || !float_finite(luminance))
        return;
    float sum = state_load_float(paths, stride, BD_CANDIDATE_SUM, item) + luminance;
    state_store_float(paths, stride, BD_CANDIDATE_SUM, item, sum);
    Random4 random = bd_random(frame, paths, item, BD_RANDOM_CANDIDATES + s * 64u + t);
    if (random_float(random.x[0]) * sum < luminance) {
        state_store(paths, stride, BD_CANDIDATE, item, chain_key(s + t - 1u, s));
        state_store_float(paths, stride, BD_CANDIDATE_LUMINANCE, item, luminance * survival);
    }
}

#endif
