/* A Markov chain over the random numbers of one path (Hachisuka, Kaplanyan and Dachsbacher, "Multiplexed Metropolis
 * Light Transport", 2014): its coordinates, how they are mutated, and what else it keeps. One word a field, behind the
 * walk under way (bd_state.h).
 *
 * Coordinates are integers modulo 2^32. A small step adds an integer that is as probable as its negative, so detailed
 * balance holds exactly and a coordinate that is left alone keeps its bits. A large step adds one that is any with the same
 * probability, so that the sum is, too. What is added is a function of (seed, chain, step): a proposal stands where the
 * current coordinates stood, and one that is refused is taken away again. */
#ifndef TWINLIGHT_CHAIN_H
#define TWINLIGHT_CHAIN_H

#include "bd_random.h"
#include "item.h"
#include "pool.h"
#include "scene_view.h"

/* Paths of fewer segments are left to path tracing. */
#define CHAIN_DEPTH_MIN SPLAT_DEPTH_MIN

/* ---- state ------------------------------------------------------------------------------------------------------- */

#define CHAIN_KEY BD_HEADER_WORDS /* chain_key of the current path; 0: the chain never began */
#define CHAIN_PROPOSED_KEY (BD_HEADER_WORDS + 1u)
#define CHAIN_STEP (BD_HEADER_WORDS + 2u) /* number of the proposal, for its random numbers */
#define CHAIN_MOVE (BD_HEADER_WORDS + 3u) /* MOVE_*, four bits each */
#define CHAIN_LUMINANCE (BD_HEADER_WORDS + 4u) /* f of the current path */
#define CHAIN_COLOR (BD_HEADER_WORDS + 5u) /* its contribution over f, 3 */
#define CHAIN_FILM (BD_HEADER_WORDS + 8u) /* where the film sees it, 2 */
#define CHAIN_PENDING (BD_HEADER_WORDS + 10u) /* expected visits of the current path that the film has not got yet */
#define CHAIN_PROPOSED_FILM (BD_HEADER_WORDS + 11u) /* 2 */
#define CHAIN_TALLY (BD_HEADER_WORDS + 13u) /* proposals | accepted << 16 of each kind of mutation, 4 */
#define CHAIN_BAD (BD_HEADER_WORDS + 17u) /* number of the first proposal whose f was not finite; NONE: all were */
#define CHAIN_RUN (BD_HEADER_WORDS + 18u) /* proposals refused in a row: run_after */
/* What the connection has to know of a half of the path, twice for each side: chain_half. */
#define CHAIN_HALVES (BD_HEADER_WORDS + 19u)
#define CHAIN_NUMBERS (CHAIN_HALVES + 2u * (CHAIN_LIGHT_HALF_WORDS + CHAIN_CAMERA_HALF_WORDS))

/* Places in CHAIN_MOVE. */
#define MOVE_MUTATION 0u /* of the proposal: MUTATION_* */
#define MOVE_CHANGED 4u /* halves that the proposal has of its own: HALF_* */
#define MOVE_REACHED 8u /* halves of the proposal whose last vertex is there */
#define MOVE_BANKS 12u /* HALF_*: the current path's is in bank 1 */
#define MOVE_SCALE 16u /* of the proposal's small steps: they are 2^-scale times the longest */

SHARED_FUNCTION uint chain_move(__global const uint *paths, uint stride, uint t, uint place)
{
    return state_load(paths, stride, CHAIN_MOVE, t) >> place & 0xfu;
}

SHARED_FUNCTION void chain_move_set(__global uint *paths, uint stride, uint t, uint place, uint value)
{
    uint word = state_load(paths, stride, CHAIN_MOVE, t);
    state_store(paths, stride, CHAIN_MOVE, t, (word & ~(0xfu << place)) | value << place);
}

#define CHAIN_HALF_DELTA 0u /* bit i: vertex i scattered by a delta lobe */
#define CHAIN_HALF_EMITTER_FLAGS 1u
#define CHAIN_HALF_CONNECT 2u
#define CHAIN_LIGHT_HALF_WORDS 3u
#define CHAIN_CAMERA_HALF_WORDS 1u /* without the last two */

#define HALF_LIGHT 0x1u
#define HALF_CAMERA 0x2u
#define HALF_BOTH (HALF_LIGHT | HALF_CAMERA)

/* Fields of half `side` (SIDE_*) in bank 0 or 1. */
SHARED_FUNCTION uint chain_half(uint side, uint bank)
{
    return CHAIN_HALVES + (side == SIDE_LIGHT ? bank * CHAIN_LIGHT_HALF_WORDS
                                              : 2u * CHAIN_LIGHT_HALF_WORDS + bank * CHAIN_CAMERA_HALF_WORDS);
}

/* The bank of a half of the proposal: the one that the current path does not have where the half is its own. */
SHARED_FUNCTION uint chain_bank(__global const uint *paths, uint stride, uint t, uint side)
{
    uint banks = chain_move(paths, stride, t, MOVE_BANKS) ^ chain_move(paths, stride, t, MOVE_CHANGED);
    return banks >> side & 1u;
}

/* BUFFER_VERTICES: the last vertex of either side, twice. A walk's vertices take each other's place. */
#define CHAIN_VERTEX_WORDS (4u * VERTEX_WORDS)

SHARED_FUNCTION uint chain_vertex_base(uint side, uint bank)
{
    return (2u * side + bank) * VERTEX_WORDS;
}

/* BUFFER_DENSITIES: one word a vertex as in strategy.h, compact, d of them, twice. */
SHARED_FUNCTION uint chain_density(__global const FrameParams *frame, uint side, uint bank, uint s, uint i)
{
    return bank * frame->max_depth + (side == SIDE_LIGHT ? i : s + i - 1u);
}

SHARED_FUNCTION DensityView chain_density_view(__global const FrameParams *frame, __global const uint *paths,
                                               __global const uint *densities, uint t, uint s, uint camera)
{
    uint stride = frame->stride;
    uint light_bank = chain_bank(paths, stride, t, SIDE_LIGHT), camera_bank = chain_bank(paths, stride, t, SIDE_CAMERA);
    DensityView view;
    view.light = densities + (size_t)chain_density(frame, SIDE_LIGHT, light_bank, s, 0u) * stride;
    view.camera = densities + (size_t)chain_density(frame, SIDE_CAMERA, camera_bank, s, 1u) * stride;
    view.stride = stride;
    view.t = t;
    view.light_delta = state_load(paths, stride, chain_half(SIDE_LIGHT, light_bank) + CHAIN_HALF_DELTA, t);
    view.camera_delta = state_load(paths, stride, chain_half(SIDE_CAMERA, camera_bank) + CHAIN_HALF_DELTA, t);
    view.compact = true;
    view.light_end = s >= 2u ? s - 2u : 0u;
    view.camera_end = camera >= 3u ? camera - 2u : 1u;
    return view;
}

/* ---- BUFFER_PASS of chains --------------------------------------------------------------------------------------- */

#define CHAIN_PASS_KEY 0u /* where to begin; after the pass, where it ended */
#define CHAIN_PASS_ITEM 1u /* the pool's sample; NONE: the coordinates are given */
#define CHAIN_PASS_LUMINANCE 2u /* of the path when the pass before ended, 0: there was none; after it, of this one */
#define CHAIN_PASS_TALLY 3u /* after the pass, 4 */
#define CHAIN_PASS_STEP 7u /* steps made in earlier passes */
#define CHAIN_PASS_BAD 8u /* after the pass: CHAIN_BAD */
#define CHAIN_PASS_RUN 9u /* CHAIN_RUN of the pass before, 0: there was none; after the pass, of this one */
#define CHAIN_PASS_CELL 10u /* after the pass: importance_cell of where the film sees the path */
#define CHAIN_PASS_NUMBERS 11u /* the coordinates, where the pass keeps them */

/* ---- runs of refused proposals ----------------------------------------------------------------------------------- */

/* The longest run of the pass is in the upper half of a word, the one under way, which began maybe in a pass before, in the
 * lower. RUN_MOST means so many or more. */
#define RUN_MOST 0xffffu

SHARED_FUNCTION uint run_longest(uint run)
{
    return run >> 16;
}

/* At the beginning of a pass. */
SHARED_FUNCTION uint run_begin(uint run)
{
    return run & RUN_MOST;
}

/* After a proposal. */
SHARED_FUNCTION uint run_after(uint run, bool taken)
{
    uint now = run & RUN_MOST, longest = run >> 16;
    now = taken ? 0u : now < RUN_MOST ? now + 1u : RUN_MOST;
    return now | (now > longest ? now : longest) << 16;
}

/* ---- coordinates ------------------------------------------------------------------------------------------------- */

#define NUMBER_CAMERA 0u /* film, lens: 4 */
#define NUMBER_EMIT 4u /* point and direction on the light: 4 */
#define NUMBER_SELECT 8u /* which light: 2 */
#define NUMBER_VERTICES 10u /* then those of every vertex between the ends */

/* Lobe and direction; where the scene mixes materials, also which. */
SHARED_FUNCTION uint chain_vertex_numbers(__global const FrameParams *frame)
{
    return (frame->features & FEATURE_MIX) != 0u ? 4u : 3u;
}

/* d - 1 vertices lie between the ends of a path: y_1, y_2 ... and then, from the light to the camera, ... z_2, z_1. */
SHARED_FUNCTION uint chain_slot(uint side, uint d, uint i)
{
    return side == SIDE_LIGHT ? i - 1u : d - 1u - i;
}

/* Whether the half owns the coordinate slot: of a path with s vertices from the light. */
SHARED_FUNCTION uint chain_slot_half(uint s, uint slot)
{
    return slot + 1u < s ? HALF_LIGHT : HALF_CAMERA;
}

/* ---- mutations --------------------------------------------------------------------------------------------------- */

#define MUTATION_ALL 0u /* small steps of all coordinates */
#define MUTATION_LIGHT 1u /* of the light's half */
#define MUTATION_CAMERA 2u /* of the camera's half */
#define MUTATION_LARGE 3u /* everything new, s too */
#define MUTATION_COUNT 4u
#define MUTATION_REPLAY 4u /* no mutation: the current path is made again */

/* Of eight small steps so many are of each kind. A step of the light's half alone leaves the path where it is on the film, so
 * the film has little of it; steps of the camera's half are also the cheapest. */
#define MUTATION_CHANCE(kind) ((kind) == MUTATION_CAMERA ? 6u : 1u)

/* Blocks of random numbers of one step, 256 of them. */
#define CHAIN_BLOCK_DECIDE 0u /* whether to accept; pixel of the splat */
#define CHAIN_BLOCK_S 1u /* the new s of a large step */
#define CHAIN_BLOCK_SMALL 2u /* offsets, eight to a block */
#define CHAIN_BLOCK_LARGE 64u /* four to a block */

SHARED_FUNCTION Random4 chain_random(__global const FrameParams *frame, uint t, uint step, uint block)
{
    return random_four(frame->first_item + t, step << 8 | block, frame->sample_index, PATH_STREAM_CHAIN,
                       frame->seed_low, frame->seed_high);
}

/* Steps on the film and the lens are up to 2^-4 of the whole range long, all others, which bend the whole rest of the path,
 * half as long. A proposal has one scale for all of its coordinates: it is short in all of them or long in all of them. With
 * a scale for each coordinate the longest decides, as there are many; and the more there are, the shorter all must be. For the
 * same work, a door ajar and a glossy hall have 1.15 times the square error where all depths have the same steps and none are
 * as short as the fourth scale, a relief 1.2 times; a lamp in glass and a pool's caustics the same or a little less. */
#define STEP_SHIFT_CAMERA 3u
#define STEP_SHIFT_OTHERS 4u
#define STEP_SCALES 4u

/* How long the steps of a path of d segments are, in units of 2^-16 of those of one of three. */
SHARED_FUNCTION uint mutation_length(uint d)
{
    return ((CHAIN_DEPTH_MIN + 1u) << 16) / (d + 1u);
}

/* A small step from the random word `bits`: uniform up to 2^-(shift + 1) of the whole range, times length (mutation_length),
 * either sign alike. (Kelemen et al., 2002, have exponential sizes from 2^-10 to 2^-6.) */
SHARED_FUNCTION uint mutation_offset(uint bits, uint shift, uint length)
{
    uint size = (uint)((ulong)(bits >> 1 >> shift) * length >> 16);
    return (bits & 1u) != 0u ? size : 0u - size;
}

/* One random word serves two small steps: its bits 0 and 16 are their signs, the 15 bits above each what counts most in the
 * size of one, and what is below those in one is in the other's upper half. Both have all their sizes, and the word with
 * both signs turned has both steps turned, so detailed balance is exact. place: 0 or 1, which of the two. */
#define MUTATION_SIGNS 0x00010001u

SHARED_FUNCTION uint mutation_half_bits(uint word, uint place)
{
    uint turned = place == 0u ? word : word >> 16 | word << 16;
    return (turned & ~MUTATION_SIGNS) | (turned >> 16 & 1u);
}

/* The coordinates that a mutation changes: four from `first` on and the others from `second` on. */
typedef struct ChangedNumbers {
    uint first, second, count;
} ChangedNumbers;

SHARED_FUNCTION ChangedNumbers chain_changed(__global const FrameParams *frame, uint changed, uint d, uint s)
{
    uint words = chain_vertex_numbers(frame), camera = NUMBER_VERTICES + (s > 1u ? s - 1u : 0u) * words;
    uint end = NUMBER_VERTICES + (d - 1u) * words;
    ChangedNumbers numbers;
    numbers.first = changed == HALF_LIGHT ? NUMBER_EMIT : NUMBER_CAMERA;
    numbers.second = changed == HALF_CAMERA ? camera : numbers.first + 4u;
    numbers.count = 4u + (changed == HALF_LIGHT ? camera : end) - numbers.second;
    return numbers;
}

/* Adds `offset` to the changed coordinate i. */
SHARED_FUNCTION void chain_number_add(__global uint *paths, uint stride, uint t, ChangedNumbers numbers, uint i,
                                      uint offset)
{
    uint field = CHAIN_NUMBERS + (i < 4u ? numbers.first + i : numbers.second + i - 4u);
    if (i < numbers.count)
        state_store(paths, stride, field, t, state_load(paths, stride, field, t) + offset);
}

SHARED_FUNCTION void chain_add_large(__global const FrameParams *frame, __global uint *paths, uint t, uint step,
                                     ChangedNumbers numbers, bool back)
{
    for (uint first = 0u; first < numbers.count; first += 4u) {
        Random4 random = chain_random(frame, t, step, CHAIN_BLOCK_LARGE + first / 4u);
        for (uint i = 0u; i < 4u; ++i)
            chain_number_add(paths, frame->stride, t, numbers, first + i, back ? 0u - random.x[i] : random.x[i]);
    }
}

SHARED_FUNCTION void chain_add_small(__global const FrameParams *frame, __global uint *paths, uint t, uint step,
                                     ChangedNumbers numbers, uint scale, uint length, bool back)
{
    uint film = scale + (numbers.first == NUMBER_CAMERA ? STEP_SHIFT_CAMERA : STEP_SHIFT_OTHERS);
    uint turn = back ? 1u : 0u;
    for (uint first = 0u; first < numbers.count; first += 8u) {
        Random4 random = chain_random(frame, t, step, CHAIN_BLOCK_SMALL + first / 8u);
        for (uint i = 0u; i < 8u; ++i) {
            uint shift = first + i < 4u ? film : scale + STEP_SHIFT_OTHERS;
            uint bits = mutation_half_bits(random.x[i / 2u], i % 2u) ^ turn;
            chain_number_add(paths, frame->stride, t, numbers, first + i, mutation_offset(bits, shift, length));
        }
    }
}

/* The current coordinates become the proposal's; back: the other way. */
SHARED_FUNCTION void chain_move_numbers(__global const FrameParams *frame, __global uint *paths, uint t, bool back)
{
    uint stride = frame->stride, move = state_load(paths, stride, CHAIN_MOVE, t);
    uint step = state_load(paths, stride, CHAIN_STEP, t), key = state_load(paths, stride, CHAIN_PROPOSED_KEY, t);
    uint d = chain_key_depth(key);
    ChangedNumbers numbers = chain_changed(frame, move >> MOVE_CHANGED & 0xfu, d, chain_key_s(key));
    if ((move >> MOVE_MUTATION & 0xfu) == MUTATION_LARGE)
        chain_add_large(frame, paths, t, step, numbers, back);
    else
        chain_add_small(frame, paths, t, step, numbers, move >> MOVE_SCALE & 0xfu, mutation_length(d), back);
}

SHARED_FUNCTION Random4 chain_numbers(__global const FrameParams *frame, __global const uint *paths, uint t, uint first,
                                      uint count)
{
    Random4 numbers;
    for (uint i = 0u; i < 4u; ++i)
        numbers.x[i] = i < count ? state_load(paths, frame->stride, CHAIN_NUMBERS + first + i, t) : 0u;
    return numbers;
}

SHARED_FUNCTION Random4 chain_camera(__global const FrameParams *frame, __global const uint *paths, uint t)
{
    return chain_numbers(frame, paths, t, NUMBER_CAMERA, 4u);
}

SHARED_FUNCTION Random4 chain_emit(__global const FrameParams *frame, __global const uint *paths, uint t)
{
    return chain_numbers(frame, paths, t, NUMBER_EMIT, 4u);
}

SHARED_FUNCTION Random4 chain_select(__global const FrameParams *frame, __global const uint *paths, uint t)
{
    return chain_numbers(frame, paths, t, NUMBER_SELECT, 2u);
}

/* x: lobe, direction, direction, mix. */
SHARED_FUNCTION Random4 chain_vertex(__global const FrameParams *frame, __global const uint *paths, uint t, uint side,
                                     uint d, uint i)
{
    uint count = chain_vertex_numbers(frame);
    return chain_numbers(frame, paths, t, NUMBER_VERTICES + chain_slot(side, d, i) * count, count);
}

SHARED_FUNCTION void chain_store_numbers(__global uint *paths, uint stride, uint t, uint first, uint count,
                                         Random4 numbers)
{
    for (uint i = 0u; i < count; ++i)
        state_store(paths, stride, CHAIN_NUMBERS + first + i, t, numbers.x[i]);
}

/* ---- how a chain begins ------------------------------------------------------------------------------------------ */

/* The coordinates that the pool's sample had for the path it kept. */
SHARED_FUNCTION void chain_numbers_of_pool(const SceneView *scene, __global uint *paths, uint t, uint key, uint item)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->stride, count = chain_vertex_numbers(frame), d = chain_key_depth(key), s = chain_key_s(key);
    ItemPlace place = item_place_of(frame, item);
    state_store(paths, stride, BD_PIXEL, t, place.pixel);
    state_store(paths, stride, BD_SAMPLE, t, place.sample);
    float weight;
    Random4 camera = pool_camera(scene, paths, t, &weight);
    if (s == d) {
        Random4 film = pool_random(frame, paths, t, BD_RANDOM_PIXEL);
        camera.x[0] = film.x[0];
        camera.x[1] = film.x[1];
    }
    chain_store_numbers(paths, stride, t, NUMBER_CAMERA, 4u, camera);
    chain_store_numbers(paths, stride, t, NUMBER_EMIT, 4u, pool_random(frame, paths, t, BD_RANDOM_EMIT));
    chain_store_numbers(paths, stride, t, NUMBER_SELECT, 2u, pool_random(frame, paths, t, BD_RANDOM_LIGHT));
    for (uint slot = 0u; slot + 1u < d; ++slot) {
        uint side = slot + 1u < s ? SIDE_LIGHT : SIDE_CAMERA;
        uint i = side == SIDE_LIGHT ? slot + 1u : d - 1u - slot;
        Random4 numbers = pool_random(frame, paths, t, bd_random_vertex(side, i, BD_RANDOM_SCATTER));
        if (count > 3u)
            numbers.x[3] = pool_random(frame, paths, t, bd_random_vertex(side, i, BD_RANDOM_MIX)).x[0];
        chain_store_numbers(paths, stride, t, NUMBER_VERTICES + slot * count, count, numbers);
    }
}

#endif
