/* The pool from which chains start: independent bidirectional samples, each a pair of walks with all connections
 * between them, of which one path is kept with probability proportional to its contribution weight (reservoir
 * sampling). Only frame->pool.lights of them have a light walk; the others have only a camera walk, which hits lights
 * or is connected to them.
 *
 * The random numbers of a sample are coordinates of a chain: all connections share one light and one point on the lens,
 * and the film position is two of the numbers. So the kept path can be rebuilt from the sample's number, its depth d
 * and its number s of light vertices. */
#ifndef TWINLIGHT_CHAIN_POOL_H
#define TWINLIGHT_CHAIN_POOL_H

#include "camera/film_splat.h"
#include "camera/splat_offset.h"
#include "layout/item.h"
#include "path/bd_random.h"
#include "path/bd_start.h"
#include "path/partition.h"

/* BUFFER_PASS of a pool: the contribution weight of a sample, and the path kept of it (chain_key); 0: none. */
#define POOL_WEIGHT 0u /* contribution weight: the sum over all paths of the sample */
#define POOL_KEY 1u
#define POOL_LUMINANCE 2u /* target f of the kept path, as a chain has it */
#define POOL_WORDS 3u

/* A path of d segments with s vertices from the light. In the upper 16 bits a chain stores which part of it path
 * tracing shows. */
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

/* The camera's numbers of a pool's sample. Its pixel is given, and the film position is drawn from that pixel's filter,
 * as in every sample of an image; positions drawn uniformly over the film would not sample all pixels alike. The
 * density of a position is film_splat_cover / film_reach_factor. *weight: of the pixel filter. */
SHARED_FUNCTION Random4 pool_camera(const SceneView *scene, __global const uint *paths, uint item, float *weight)
{
    __global const FrameParams *frame = scene->frame;
    Random4 random = pool_random(frame, paths, item, BD_RANDOM_CAMERA);
    uint pixel = state_load(paths, frame->pass.stride, BD_PIXEL, item);
    uint row = pixel / frame->film.width, column = pixel % frame->film.width;
    Vec2 offset = pixel_filter_sample(scene, vec2(random_float(random.x[0]), random_float(random.x[1])), weight);
    FilmReach reach = film_reach(frame);
    random.x[0] = film_number((float)column + 0.5f + offset.x - reach.x, reach.width, random.x[0]);
    random.x[1] = film_number((float)row + 0.5f + offset.y - reach.y, reach.height, random.x[1]);
    return random;
}

/* Whether a pool's sample has a light walk: pool_lights of them do, from pool_lights_first on, wrapping around at the
 * pool's end. */
SHARED_FUNCTION bool pool_has_light(__global const FrameParams *frame, uint item)
{
    uint first = frame->pool.lights_first, behind = frame->pool.items - first; /* samples from `first` to the end */
    return (item < first ? item + behind : item - first) < frame->pool.lights;
}

/* Scales the throughput that Russian roulette uses by the weights of the sample's paths (density ratio, weight of light
 * walks), so that roulette does not make paths even rarer that few samples can make. docs/TUNING.md */
SHARED_FUNCTION void pool_roulette_weigh(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                         float density_ratio)
{
    uint stride = frame->pass.stride;
    float counts = float_max(density_ratio, 1.0f) *
                   (pool_has_light(frame, frame->pass.first_item + item) ? frame->pool.lights_weight : 1.0f);
    state_store_float(paths, stride, BD_ROULETTE_SCALE, item,
                      counts * state_load_float(paths, stride, BD_ROULETTE_SCALE, item));
}

/* The first ray of the camera walk. What it gathers goes to the sample's pixel. */
SHARED_FUNCTION void pool_start_camera(const SceneView *scene, Walk walk)
{
    __global const FrameParams *frame = scene->frame;
    __global uint *paths = walk.paths;
    uint stride = walk.stride, item = walk.item;
    float weight;
    Random4 random = pool_camera(scene, paths, item, &weight);
    Vec2 film = film_position(frame, random.x[0], random.x[1]);
    state_store(paths, stride, BD_OFFSET, item,
                splat_offset(&frame->film, state_load(paths, stride, BD_PIXEL, item), film));
    state_store_float(paths, stride, BD_COVER, item, film_splat_cover(scene, film));
    state_store_float(paths, stride, BD_IMPORTANCE, item, film_importance(frame, scene->guide, film));
    float density_ratio = pool_density_ratio(frame, scene->guide, state_load(paths, stride, BD_PIXEL, item));
    state_store_float(paths, stride, BD_WEIGHT, item, density_ratio * (weight / film_reach_factor(frame)));
    walk_start_film(scene, walk, random);
    pool_roulette_weigh(frame, paths, item, density_ratio);
}

/* A path of strategy (s, t) that is offered to the reservoir of its sample. */
typedef struct Candidate {
    uint s, t;
    float survival; /* probability with which it survived roulette */
    float cover, importance; /* film_splat_cover and target importance at its film position */
    Vec3 contribution; /* after roulette */
} Candidate;

/* Offers a path to the sample's reservoir, whose candidate it becomes with probability proportional to its contribution
 * weight. Returns what the film shows of it: the part below the clamping threshold. */
SHARED_FUNCTION Vec3 reservoir_update(__global const FrameParams *frame, __global const Guide *guide,
                                      __global uint *restrict paths, uint item, Candidate path)
{
    uint stride = frame->pass.stride, s = path.s, t = path.t;
    float luminance = rgb_luminance(path.contribution) * path.importance;
    float f = luminance * path.cover * path.survival; /* as a chain has it: without roulette */
    float weight = s > 1u ? frame->pool.lights_weight : 1.0f; /* fewer items have a light walk */
    if (!(f > 0.0f) || !float_finite(luminance))
        return vec3_scale(path.contribution, weight);
    /* Divided by the density of the random numbers. A path with t = 1 does not use the film's two, which are
     * uniform. */
    float worth = weight * luminance;
    worth *= t == 1u ? path.cover
                     : pool_density_ratio(frame, guide, state_load(paths, stride, BD_PIXEL, item)) /
                           film_reach_factor(frame);
    float sum = state_load_float(paths, stride, BD_CANDIDATE_SUM, item) + worth;
    state_store_float(paths, stride, BD_CANDIDATE_SUM, item, sum);
    Random4 random = bd_random(frame, paths, item, BD_RANDOM_CANDIDATES + s * 64u + t);
    if (random_float(random.x[0]) * sum < worth) {
        state_store(paths, stride, BD_CANDIDATE, item, chain_key(s + t - 1u, s));
        state_store_float(paths, stride, BD_CANDIDATE_LUMINANCE, item, f);
    }
    return vec3_scale(path.contribution, weight * partition_shown(f, partition_threshold(frame, PARTITION_POOL)));
}

#endif
