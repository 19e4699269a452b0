/* The pool from which chains begin: independent bidirectional samples, each a pair of walks with all connections
 * between them, of which one path is kept in proportion to what it carries (a bundle of candidates, and one of them
 * drawn). But for frame->pool_lights of them they have the camera's walk alone, with what it meets and is connected
 * with of lights.
 *
 * The random numbers of a pool's sample are a chain's coordinates: the same light and the same point on the lens serve
 * every connection, and the film position is two of the numbers. So the path kept can be made again from the sample's
 * number, its depth d and its light vertices s. */
#ifndef TWINLIGHT_CHAIN_POOL_H
#define TWINLIGHT_CHAIN_POOL_H

#include "camera/film_splat.h"
#include "layout/item.h"
#include "path/bd_random.h"
#include "path/bd_start.h"

/* BUFFER_PASS of a pool: what a sample is worth, and the path kept of it (chain_key); 0: none. */
#define POOL_WEIGHT 0u /* sum of the luminances of all its paths, times their importance */
#define POOL_KEY 1u
#define POOL_LUMINANCE 2u /* f of the path kept, as a chain has it */
#define POOL_WORDS 3u

/* d segments, s of the vertices from the light. In the upper half a chain keeps what path tracing shows of the path. */
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
    return key >> 8 & 0xffu;
}

/* The camera's numbers of a pool's sample: its pixel is given, and the film position drawn from that pixel's filter, as
 * for every sample of an image. So a pool shows all pixels alike, which positions drawn from all of the film would not.
 * The density of a position is then film_splat_cover over film_reach_factor. *weight: of the pixel filter. */
SHARED_FUNCTION Random4 pool_camera(const SceneView *scene, __global const uint *paths, uint t, float *weight)
{
    __global const FrameParams *frame = scene->frame;
    Random4 random = pool_random(frame, paths, t, BD_RANDOM_CAMERA);
    uint pixel = state_load(paths, frame->stride, BD_PIXEL, t);
    uint row = pixel / frame->width, column = pixel % frame->width;
    Vec2 offset = pixel_filter_sample(scene, vec2(random_float(random.x[0]), random_float(random.x[1])), weight);
    FilmReach reach = film_reach(frame);
    random.x[0] = film_number((float)column + 0.5f + offset.x - reach.x, reach.width, random.x[0]);
    random.x[1] = film_number((float)row + 0.5f + offset.y - reach.y, reach.height, random.x[1]);
    return random;
}

/* Whether the pool's sample has a walk from the light: pool_lights of them from pool_lights_first on, behind the last
 * sample again from the first. */
SHARED_FUNCTION bool pool_has_light(__global const FrameParams *frame, uint item)
{
    uint first = frame->pool_lights_first, behind = frame->pool_items - first; /* the first of the pool */
    return (item < first ? item + behind : item - first) < frame->pool_lights;
}

/* Roulette goes by all that a sample's paths count for: what few samples have, a pixel rarely visited or a walk from
 * the light, it may not make rarer still. In the same time a glossy hall has 0.85 times the square error, and 0.6 times
 * with the worst thousandth of its pixels, which were paths that counted 128 times, so that fifty chains began with
 * one; beaten metal has 0.7 times, a door ajar 0.8 times with the worst, others the same. */
SHARED_FUNCTION void pool_roulette_weigh(__global const FrameParams *frame, __global uint *restrict paths, uint t,
                                         float density_ratio)
{
    uint stride = frame->stride;
    float counts = float_max(density_ratio, 1.0f) *
                   (pool_has_light(frame, frame->first_item + t) ? frame->pool_lights_weight : 1.0f);
    state_store_float(paths, stride, BD_ROULETTE_SCALE, t,
                      counts * state_load_float(paths, stride, BD_ROULETTE_SCALE, t));
}

/* The camera's first ray. What is gathered goes to the sample's pixel. */
SHARED_FUNCTION void pool_start_camera(const SceneView *scene, __global uint *restrict paths,
                                       __global uint *restrict rays, __global uint *restrict diagnostics, uint t)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->stride;
    float weight;
    Random4 random = pool_camera(scene, paths, t, &weight);
    Vec2 film = film_position(frame, random.x[0], random.x[1]);
    state_store_float(paths, stride, BD_COVER, t, film_splat_cover(scene, film));
    state_store_float(paths, stride, BD_IMPORTANCE, t, film_importance(frame, scene->guide, film));
    float density_ratio = pool_density_ratio(frame, scene->guide, state_load(paths, stride, BD_PIXEL, t));
    state_store_float(paths, stride, BD_WEIGHT, t, density_ratio * (weight / film_reach_factor(frame)));
    walk_start_film(scene, paths, rays, diagnostics, stride, t, random);
    pool_roulette_weigh(frame, paths, t, density_ratio);
}

/* A sample's path of the strategy (s, t) carries `contribution`, having survived roulette with probability `survival`;
 * `cover`, `importance`: film_splat_cover and the importance where the film sees it. It becomes the candidate with the
 * probability of its share in all so far. Returns what the film is shown of it, the part below the limit. */
SHARED_FUNCTION Vec3 reservoir_update(__global const FrameParams *frame, __global const Guide *guide,
                                      __global uint *restrict paths, uint item, uint s, uint t, float survival,
                                      float cover, float importance, Vec3 contribution)
{
    uint stride = frame->stride;
    float luminance = rgb_luminance(contribution) * importance;
    float f = luminance * cover * survival; /* of a chain there, which knows no roulette */
    float weight = s > 1u ? frame->pool_lights_weight : 1.0f; /* fewer items can have made it */
    if (!(f > 0.0f) || !float_finite(luminance))
        return vec3_scale(contribution, weight);
    /* Over the density of the numbers: those of a film position that the path does not have (t = 1) are uniform. */
    float worth = weight * luminance;
    worth *= t == 1u ? cover
                     : pool_density_ratio(frame, guide, state_load(paths, stride, BD_PIXEL, item)) /
                           film_reach_factor(frame);
    float sum = state_load_float(paths, stride, BD_CANDIDATE_SUM, item) + worth;
    state_store_float(paths, stride, BD_CANDIDATE_SUM, item, sum);
    Random4 random = bd_random(frame, paths, item, BD_RANDOM_CANDIDATES + s * 64u + t);
    if (random_float(random.x[0]) * sum < worth) {
        state_store(paths, stride, BD_CANDIDATE, item, chain_key(s + t - 1u, s));
        state_store_float(paths, stride, BD_CANDIDATE_LUMINANCE, item, f);
    }
    return vec3_scale(contribution, f > frame->clamp_threshold ? weight * (frame->clamp_threshold / f) : weight);
}

#endif
