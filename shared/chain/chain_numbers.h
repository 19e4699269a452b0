/* The coordinates of a chain (chain/chain.h), and how mutations change them.
 *
 * Coordinates are integers modulo 2^32. A small step adds an integer that is as probable as its negative, so detailed
 * balance holds exactly, and a coordinate that is left alone keeps its bits. A large step adds a uniform integer, which
 * makes the sum uniform. What is added is a function of (seed, chain, step), so a proposal replaces the current
 * coordinates in place, and is subtracted again if it is rejected. */
#ifndef TWINLIGHT_CHAIN_CHAIN_NUMBERS_H
#define TWINLIGHT_CHAIN_CHAIN_NUMBERS_H

#include "chain/chain.h"
#include "chain/pool.h"
#include "layout/item.h"
#include "layout/scene_view.h"
#include "path/bd_random.h"

/* ---- coordinates ------------------------------------------------------------------------------------------------- */

#define NUMBER_CAMERA 0u /* film, lens: 4 */
#define NUMBER_EMIT 4u /* point and direction on the light: 4 */
#define NUMBER_SELECT 8u /* of light_select_point, NUMBER_DISTANCE, aim: 3 */
#define NUMBER_DISTANCE 9u /* of the last segment, if the camera walk hits a light (s = 0); otherwise not used */
#define NUMBER_VERTICES 11u /* then those of every vertex between the ends of the path */

/* Coordinates per vertex: lobe and direction; in scenes that mix materials, also the choice among them; in scenes with
 * scattering media, last, the distance of the segment that leads to the vertex, as its own subpath makes it. */
SHARED_FUNCTION uint chain_vertex_numbers(__global const FrameParams *frame)
{
    ulong features = frame_features(frame);
    return 3u + ((features & FEATURE_MIX) != 0u ? 1u : 0u) + ((features & FEATURE_SCATTERING) != 0u ? 1u : 0u);
}

/* The slot of a vertex's coordinates. A path has d - 1 vertices between its ends, in this order: y_1, y_2 ..., from the
 * light to the camera, ... z_2, z_1. */
SHARED_FUNCTION uint chain_slot(uint side, uint d, uint i)
{
    return side == SIDE_LIGHT ? i - 1u : d - 1u - i;
}

/* The subpath (SUBPATH_*) that owns a slot of coordinates, in a path with s vertices from the light. */
SHARED_FUNCTION uint chain_slot_subpath(uint s, uint slot)
{
    return slot + 1u < s ? SUBPATH_LIGHT : SUBPATH_CAMERA;
}

/* ---- mutations --------------------------------------------------------------------------------------------------- */

#define MUTATION_ALL 0u /* small steps of all coordinates */
#define MUTATION_LIGHT 1u /* of the light subpath */
#define MUTATION_CAMERA 2u /* of the camera subpath */
#define MUTATION_LARGE 3u /* everything is new, s too */
#define MUTATION_COUNT 4u
#define MUTATION_REPLAY 4u /* no mutation: the current path is replayed */

/* Relative frequencies of the kinds of small steps, in eighths. A step of the light subpath alone does not move the
 * path on the film, so the film gains little from it; steps of the camera subpath are also the cheapest. */
#define MUTATION_CHANCE(kind) ((kind) == MUTATION_CAMERA ? 6u : 1u)

/* Blocks of random numbers of a step, of which there are 256. */
#define CHAIN_BLOCK_DECIDE 0u /* whether to accept; pixel and layer of the splat */
#define CHAIN_BLOCK_S 1u /* the new s of a large step */
#define CHAIN_BLOCK_SMALL 2u /* offsets of small steps, eight to a block */
#define CHAIN_BLOCK_LARGE 64u /* offsets of a large step, four to a block */

SHARED_FUNCTION Random4 chain_random(__global const FrameParams *frame, uint item, uint step, uint block)
{
    return random_four(frame->pass.first_item + item, step << 8 | block, frame->pass.sample_index, PATH_STREAM_CHAIN,
                       frame->pass.seed_low, frame->pass.seed_high);
}

/* Small steps of film and lens coordinates are up to 2^-4 of the range, those of all others, which bend the whole rest
 * of the path, up to half of that. A proposal has one scale for all of its coordinates: with a scale for each, the
 * longest of the many would decide, so all would have to be shorter. docs/TUNING.md */
#define STEP_SHIFT_CAMERA 3u
#define STEP_SHIFT_OTHERS 4u
#define STEP_SCALES 4u

/* Length of the steps of a path of d segments, in units of 2^-16 of those of a path of three. */
SHARED_FUNCTION uint mutation_length(uint d)
{
    return ((CHAIN_DEPTH_MIN + 1u) << 16) / (d + 1u);
}

/* A small step from the random word `bits`: uniform up to 2^-(shift + 1) of the range, times `length`
 * (mutation_length), of either sign with equal probability. (Kelemen et al., 2002, have exponential sizes from 2^-10 to
 * 2^-6.) */
SHARED_FUNCTION uint mutation_offset(uint bits, uint shift, uint length)
{
    uint size = (uint)((ulong)(bits >> 1 >> shift) * length >> 16);
    return (bits & 1u) != 0u ? size : 0u - size;
}

/* One random word serves two small steps. Bits 0 and 16 are their signs, the 15 bits above each are the leading bits of
 * that step's size, and the trailing bits of one size are the leading bits of the other. Both steps take all their
 * sizes, and flipping both signs of the word negates both steps, so detailed balance is exact. place: which of the two,
 * 0 or 1. */
#define MUTATION_SIGNS 0x00010001u

SHARED_FUNCTION uint mutation_subpath_bits(uint word, uint place)
{
    uint turned = place == 0u ? word : word >> 16 | word << 16;
    return (turned & ~MUTATION_SIGNS) | (turned >> 16 & 1u);
}

/* The coordinates that a mutation changes: four from `first` on, the others from `second` on; `count` in all. */
typedef struct ChangedNumbers {
    uint first, second, count;
} ChangedNumbers;

SHARED_FUNCTION ChangedNumbers chain_changed(__global const FrameParams *frame, uint changed, uint d, uint s)
{
    uint words = chain_vertex_numbers(frame), camera = NUMBER_VERTICES + (s > 1u ? s - 1u : 0u) * words;
    uint end = NUMBER_VERTICES + (d - 1u) * words;
    ChangedNumbers numbers;
    numbers.first = changed == SUBPATH_LIGHT ? NUMBER_EMIT : NUMBER_CAMERA;
    numbers.second = changed == SUBPATH_CAMERA ? camera : numbers.first + 4u;
    numbers.count = 4u + (changed == SUBPATH_LIGHT ? camera : end) - numbers.second;
    return numbers;
}

/* Adds `offset` to the i-th of the changed coordinates, if there are as many. */
SHARED_FUNCTION void chain_number_add(__global uint *paths, uint stride, uint item, ChangedNumbers numbers, uint i,
                                      uint offset)
{
    uint field = CHAIN_NUMBERS + (i < 4u ? numbers.first + i : numbers.second + i - 4u);
    if (i < numbers.count)
        state_store(paths, stride, field, item, state_load(paths, stride, field, item) + offset);
}

SHARED_FUNCTION void chain_add_large(__global const FrameParams *frame, __global uint *paths, uint item, uint step,
                                     ChangedNumbers numbers, bool back)
{
    for (uint first = 0u; first < numbers.count; first += 4u) {
        Random4 random = chain_random(frame, item, step, CHAIN_BLOCK_LARGE + first / 4u);
        for (uint i = 0u; i < 4u; ++i)
            chain_number_add(paths, frame->pass.stride, item, numbers, first + i,
                             back ? 0u - random.x[i] : random.x[i]);
    }
}

/* How long small steps are. */
typedef struct StepSize {
    uint scale; /* mutation_scale */
    uint length; /* mutation_length */
} StepSize;

SHARED_FUNCTION void chain_add_small(__global const FrameParams *frame, __global uint *paths, uint item, uint step,
                                     ChangedNumbers numbers, StepSize size, bool back)
{
    uint film = size.scale + (numbers.first == NUMBER_CAMERA ? STEP_SHIFT_CAMERA : STEP_SHIFT_OTHERS);
    uint turn = back ? 1u : 0u;
    for (uint first = 0u; first < numbers.count; first += 8u) {
        Random4 random = chain_random(frame, item, step, CHAIN_BLOCK_SMALL + first / 8u);
        for (uint i = 0u; i < 8u; ++i) {
            uint shift = first + i < 4u ? film : size.scale + STEP_SHIFT_OTHERS;
            uint bits = mutation_subpath_bits(random.x[i / 2u], i % 2u) ^ turn;
            chain_number_add(paths, frame->pass.stride, item, numbers, first + i,
                             mutation_offset(bits, shift, size.length));
        }
    }
}

/* Whether a shift chooses the direction at z_i, in a path of d segments with s vertices from the light: the directions
 * to z_2 and z_3. */
SHARED_FUNCTION bool shift_draws(uint i, uint d, uint s)
{
    return i <= SHIFT_VERTICES && i + s < d;
}

/* The field of coordinate k (0 or 1) of the direction at z_i. */
SHARED_FUNCTION uint shift_number(__global const FrameParams *frame, uint d, uint i, uint k)
{
    return CHAIN_NUMBERS + NUMBER_VERTICES + chain_slot(SIDE_CAMERA, d, i) * chain_vertex_numbers(frame) + 1u + k;
}

/* Saves the coordinates that the walk of a shift will overwrite; back: restores them. */
SHARED_FUNCTION void shift_numbers_keep(__global const FrameParams *frame, __global uint *paths, uint item, uint d,
                                        uint s, bool back)
{
    uint stride = frame->pass.stride;
    for (uint i = 1u; shift_draws(i, d, s); ++i)
        for (uint k = 0u; k < 2u; ++k) {
            uint kept = BD_SHIFT_NUMBERS + 2u * (i - 1u) + k, number = shift_number(frame, d, i, k);
            state_store(paths, stride, back ? number : kept, item,
                        state_load(paths, stride, back ? kept : number, item));
        }
}

/* Turns the current coordinates into the proposal's; back: the reverse. */
SHARED_FUNCTION void chain_move_numbers(__global const FrameParams *frame, __global uint *paths, uint item, bool back)
{
    uint stride = frame->pass.stride, move = state_load(paths, stride, CHAIN_MOVE, item);
    uint step = state_load(paths, stride, CHAIN_STEP, item), key = state_load(paths, stride, CHAIN_PROPOSED_KEY, item);
    uint d = chain_key_depth(key), s = chain_key_s(key);
    ChangedNumbers numbers = chain_changed(frame, move >> MOVE_CHANGED & 0xfu, d, s);
    StepSize size = {move >> MOVE_SCALE & 0xfu, mutation_length(d)};
    if ((move >> MOVE_SHIFT & SHIFT_KEEPS) != 0u) {
        numbers.first = NUMBER_CAMERA;
        numbers.count = 4u;
        shift_numbers_keep(frame, paths, item, d, s, back);
    }
    if ((move >> MOVE_MUTATION & 0xfu) == MUTATION_LARGE)
        chain_add_large(frame, paths, item, step, numbers, back);
    else
        chain_add_small(frame, paths, item, step, numbers, size, back);
}

SHARED_FUNCTION Random4 chain_numbers(__global const FrameParams *frame, __global const uint *paths, uint item,
                                      uint first, uint count)
{
    Random4 numbers;
    for (uint i = 0u; i < 4u; ++i)
        numbers.x[i] = i < count ? state_load(paths, frame->pass.stride, CHAIN_NUMBERS + first + i, item) : 0u;
    return numbers;
}

SHARED_FUNCTION Random4 chain_camera(__global const FrameParams *frame, __global const uint *paths, uint item)
{
    return chain_numbers(frame, paths, item, NUMBER_CAMERA, 4u);
}

SHARED_FUNCTION Random4 chain_emit(__global const FrameParams *frame, __global const uint *paths, uint item)
{
    return chain_numbers(frame, paths, item, NUMBER_EMIT, 4u);
}

SHARED_FUNCTION Random4 chain_select(__global const FrameParams *frame, __global const uint *paths, uint item)
{
    return chain_numbers(frame, paths, item, NUMBER_SELECT, 3u);
}

/* x: lobe, direction, direction, mix. */
SHARED_FUNCTION Random4 chain_vertex(__global const FrameParams *frame, __global const uint *paths, uint item,
                                     uint side, uint d, uint i)
{
    uint count = chain_vertex_numbers(frame);
    return chain_numbers(frame, paths, item, NUMBER_VERTICES + chain_slot(side, d, i) * count, count);
}

/* The coordinate of the distance of the segment to vertex i: that vertex's last or, if the camera walk hits a light
 * there (s = 0, i = d), one that no other path uses. */
SHARED_FUNCTION uint chain_distance_number(__global const FrameParams *frame, uint side, uint d, uint i)
{
    uint count = chain_vertex_numbers(frame);
    return i == d ? NUMBER_DISTANCE : NUMBER_VERTICES + chain_slot(side, d, i) * count + count - 1u;
}

/* The medium and the distance of the walk's stored ray, which leads to vertex i of `side` in a path of d segments. */
SHARED_FUNCTION_APART void chain_ray_media(const SceneView *scene, Walk walk, uint side, uint d, uint i, uint medium)
{
    __global const FrameParams *frame = scene->frame;
    uint bits = 0u;
    if (SCENE_HAS(scene, FEATURE_SCATTERING))
        bits = state_load(walk.paths, walk.stride, CHAIN_NUMBERS + chain_distance_number(frame, side, d, i), walk.item);
    walk_ray_media(scene, walk.rays, walk.stride, walk.item, medium, bits);
}

SHARED_FUNCTION void chain_store_numbers(__global uint *paths, uint stride, uint item, uint first, uint count,
                                         Random4 numbers)
{
    for (uint i = 0u; i < count; ++i)
        state_store(paths, stride, CHAIN_NUMBERS + first + i, item, numbers.x[i]);
}

SHARED_FUNCTION void chain_store_number(__global uint *paths, uint stride, uint item, uint which, uint number)
{
    state_store(paths, stride, CHAIN_NUMBERS + which, item, number);
}

/* ---- how a chain starts ------------------------------------------------------------------------------------------ */

/* The number that draws the distance of segment i of a side of the pool's sample. */
SHARED_FUNCTION uint pool_distance(__global const FrameParams *frame, __global const uint *paths, uint item, uint side,
                                   uint i)
{
    return pool_random(frame, paths, item, bd_random_vertex(side, i, BD_RANDOM_MIX)).x[1];
}

/* Sets the coordinates of the path that the pool kept of one of its samples. */
SHARED_FUNCTION void chain_numbers_of_pool(const SceneView *scene, __global uint *paths, uint item, uint key,
                                           uint pool_item)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, count = chain_vertex_numbers(frame), d = chain_key_depth(key),
         s = chain_key_s(key);
    ItemPlace place = pool_item_place(frame, scene->guide, pool_item);
    state_store(paths, stride, BD_PIXEL, item, place.pixel);
    state_store(paths, stride, BD_SAMPLE, item, place.sample);
    float weight;
    Random4 camera = pool_camera(scene, paths, item, &weight);
    if (s == d) {
        Random4 film = pool_random(frame, paths, item, BD_RANDOM_PIXEL);
        camera.x[0] = film.x[0];
        camera.x[1] = film.x[1];
    }
    chain_store_numbers(paths, stride, item, NUMBER_CAMERA, 4u, camera);
    chain_store_numbers(paths, stride, item, NUMBER_EMIT, 4u, pool_random(frame, paths, item, BD_RANDOM_EMIT));
    chain_store_numbers(paths, stride, item, NUMBER_SELECT, 3u, pool_random(frame, paths, item, BD_RANDOM_LIGHT));
    if (SCENE_HAS(scene, FEATURE_SCATTERING) && s == 0u)
        chain_store_number(paths, stride, item, NUMBER_DISTANCE, pool_distance(frame, paths, item, SIDE_CAMERA, d));
    for (uint slot = 0u; slot + 1u < d; ++slot) {
        uint side = slot + 1u < s ? SIDE_LIGHT : SIDE_CAMERA;
        uint i = side == SIDE_LIGHT ? slot + 1u : d - 1u - slot;
        Random4 numbers = pool_random(frame, paths, item, bd_random_vertex(side, i, BD_RANDOM_SCATTER));
        uint first = NUMBER_VERTICES + slot * count;
        if (SCENE_HAS(scene, FEATURE_MIX))
            numbers.x[3] = pool_random(frame, paths, item, bd_random_vertex(side, i, BD_RANDOM_MIX)).x[0];
        chain_store_numbers(paths, stride, item, first, count < 4u ? count : 4u, numbers);
        if (SCENE_HAS(scene, FEATURE_SCATTERING))
            chain_store_number(paths, stride, item, first + count - 1u, pool_distance(frame, paths, item, side, i));
    }
}

#endif
