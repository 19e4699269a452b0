/* State of a Markov chain over the random numbers of one path (Hachisuka, Kaplanyan and Dachsbacher, "Multiplexed
 * Metropolis Light Transport", 2014), except its coordinates (chain/chain_numbers.h). One word per field, after the
 * fields of the walk under way (path/bd_state.h). */
#ifndef TWINLIGHT_CHAIN_CHAIN_H
#define TWINLIGHT_CHAIN_CHAIN_H

#include "chain/pool.h"
#include "path/strategy.h"

/* Shorter paths are left to path tracing. */
#define CHAIN_DEPTH_MIN SPLAT_DEPTH_MIN

/* ---- state ------------------------------------------------------------------------------------------------------- */

#define CHAIN_KEY BD_HEADER_WORDS /* chain_key of the current path; 0: the chain never began */
#define CHAIN_PROPOSED_KEY (BD_HEADER_WORDS + 1u)
#define CHAIN_STEP (BD_HEADER_WORDS + 2u) /* number of the proposal, which its random numbers depend on */
#define CHAIN_MOVE (BD_HEADER_WORDS + 3u) /* MOVE_*, four bits each */
#define CHAIN_LUMINANCE (BD_HEADER_WORDS + 4u) /* target f of the current path */
#define CHAIN_COLOR (BD_HEADER_WORDS + 5u) /* its contribution over f, 3 */
#define CHAIN_FILM (BD_HEADER_WORDS + 8u) /* its film position, 2 */
#define CHAIN_PENDING (BD_HEADER_WORDS + 10u) /* expected visits of the current path that have not been splatted yet */
#define CHAIN_PROPOSED_FILM (BD_HEADER_WORDS + 11u) /* 2 */
#define CHAIN_TALLY (BD_HEADER_WORDS + 13u) /* proposals | accepted << 16, for each kind of mutation, 4 */
#define CHAIN_BAD (BD_HEADER_WORDS + 17u) /* step of the first proposal whose f was not finite; NONE: none */
#define CHAIN_RUN (BD_HEADER_WORDS + 18u) /* proposals rejected in a row: run_after */
/* f that the first proposal of a pass must have, a replay of the current path; 0: not known. */
#define CHAIN_EXPECTED (BD_HEADER_WORDS + 19u)
/* What a connection needs to know of a subpath, in two banks for each side: chain_subpath. */
#define CHAIN_SUBPATHS (BD_HEADER_WORDS + 20u)
#define CHAIN_NUMBERS (CHAIN_SUBPATHS + 2u * (CHAIN_LIGHT_SUBPATH_WORDS + CHAIN_CAMERA_SUBPATH_WORDS))

/* Places of the bit fields in CHAIN_MOVE. */
#define MOVE_MUTATION 0u /* of the proposal: MUTATION_* */
#define MOVE_CHANGED 4u /* SUBPATH_*: those that the proposal does not share with the current path */
#define MOVE_REACHED 8u /* SUBPATH_*: those of the proposal that have reached their last vertex */
#define MOVE_BANKS 12u /* SUBPATH_*: those of the current path that are in bank 1 */
#define MOVE_SCALE 16u /* of the proposal's small steps: they are 2^-scale times the longest */
#define MOVE_SHIFT 20u /* SHIFT_STEP, SHIFT_KEEPS if the proposal is a shift (chain/shift.h) */

SHARED_FUNCTION uint chain_move(__global const uint *paths, uint stride, uint item, uint place)
{
    return state_load(paths, stride, CHAIN_MOVE, item) >> place & 0xfu;
}

SHARED_FUNCTION void chain_move_set(__global uint *paths, uint stride, uint item, uint place, uint value)
{
    uint word = state_load(paths, stride, CHAIN_MOVE, item);
    state_store(paths, stride, CHAIN_MOVE, item, (word & ~(0xfu << place)) | value << place);
}

#define CHAIN_SUBPATH_DELTA 0u /* bit i: vertex i scattered by a delta lobe */
#define CHAIN_SUBPATH_EMITTER_FLAGS 1u
#define CHAIN_SUBPATH_CONNECT 2u
#define CHAIN_LIGHT_SUBPATH_WORDS 3u
#define CHAIN_CAMERA_SUBPATH_WORDS 1u /* the first alone */

/* Bits of MOVE_SHIFT. */
#define SHIFT_STEP 0x1u
#define SHIFT_KEEPS 0x2u /* and the current path can be shifted: z_2 and z_3 stay where they are */

/* What BUFFER_VERTICES keeps of the camera subpath for shifts. */
#define SHIFT_VERTICES 2u /* z_1 and z_2 may get new directions */
#define SHIFT_POINTS 0u /* z_2, z_3: position, instance and primitive of each */
#define SHIFT_INSTANCE 3u
#define SHIFT_PRIMITIVE 4u
#define SHIFT_POINT_WORDS 5u
#define SHIFT_DENSITY 10u /* product of both, per area; 0: the path cannot be shifted */
#define SHIFT_WORDS 11u

#define SUBPATH_LIGHT 0x1u
#define SUBPATH_CAMERA 0x2u
#define SUBPATH_BOTH (SUBPATH_LIGHT | SUBPATH_CAMERA)

/* First field of the subpath of `side` (SIDE_*) in bank 0 or 1. */
SHARED_FUNCTION uint chain_subpath(uint side, uint bank)
{
    return CHAIN_SUBPATHS + (side == SIDE_LIGHT ? bank * CHAIN_LIGHT_SUBPATH_WORDS
                                                : 2u * CHAIN_LIGHT_SUBPATH_WORDS + bank * CHAIN_CAMERA_SUBPATH_WORDS);
}

/* The bank of the proposal's subpath: the current path's if they share it, else the other. */
SHARED_FUNCTION uint chain_bank(__global const uint *paths, uint stride, uint item, uint side)
{
    uint banks = chain_move(paths, stride, item, MOVE_BANKS) ^ chain_move(paths, stride, item, MOVE_CHANGED);
    return banks >> side & 1u;
}

/* BUFFER_VERTICES: the last vertex of either side, in two banks (each vertex of a walk overwrites the one before). Then
 * what shifts need to know of the camera subpath, in two banks. */
#define CHAIN_SHIFTS (4u * VERTEX_WORDS)
#define CHAIN_VERTEX_WORDS (CHAIN_SHIFTS + 2u * SHIFT_WORDS)

SHARED_FUNCTION uint chain_vertex_base(uint side, uint bank)
{
    return (2u * side + bank) * VERTEX_WORDS;
}

/* BUFFER_DENSITIES: one word per vertex, the compact form of path/strategy.h, d words in each of two banks. */
SHARED_FUNCTION uint chain_density(__global const FrameParams *frame, uint side, uint bank, uint s, uint i)
{
    return bank * frame->path.max_depth + (side == SIDE_LIGHT ? i : s + i - 1u);
}

SHARED_FUNCTION DensityView chain_density_view(__global const FrameParams *frame, __global const uint *paths,
                                               __global const uint *densities, uint item, uint s, uint camera)
{
    uint stride = frame->pass.stride;
    uint light_bank = chain_bank(paths, stride, item, SIDE_LIGHT),
         camera_bank = chain_bank(paths, stride, item, SIDE_CAMERA);
    DensityView view;
    view.light = densities + (size_t)chain_density(frame, SIDE_LIGHT, light_bank, s, 0u) * stride;
    view.camera = densities + (size_t)chain_density(frame, SIDE_CAMERA, camera_bank, s, 1u) * stride;
    view.stride = stride;
    view.item = item;
    view.light_delta = state_load(paths, stride, chain_subpath(SIDE_LIGHT, light_bank) + CHAIN_SUBPATH_DELTA, item);
    view.camera_delta = state_load(paths, stride, chain_subpath(SIDE_CAMERA, camera_bank) + CHAIN_SUBPATH_DELTA, item);
    view.compact = true;
    view.light_end = s >= 2u ? s - 2u : 0u;
    view.camera_end = camera >= 3u ? camera - 2u : 1u;
    return view;
}

/* ---- BUFFER_PASS of chains --------------------------------------------------------------------------------------- */

#define CHAIN_PASS_KEY 0u /* chain_key to start from; after the pass, of the current path */
#define CHAIN_PASS_ITEM 1u /* the pool's sample to start from; NONE: the coordinates are given */
#define CHAIN_PASS_LUMINANCE 2u /* f when the previous pass ended, 0: there was none; after the pass, f now */
#define CHAIN_PASS_TALLY 3u /* after the pass: CHAIN_TALLY, 4 */
#define CHAIN_PASS_STEP 7u /* steps made in earlier passes */
#define CHAIN_PASS_BAD 8u /* after the pass: CHAIN_BAD */
#define CHAIN_PASS_RUN 9u /* CHAIN_RUN of the previous pass, 0: there was none; after the pass, of this one */
#define CHAIN_PASS_CELL 10u /* after the pass: importance_cell of the path's film position */
#define CHAIN_PASS_NUMBERS 11u /* the coordinates, if the pass keeps them */

/* ---- runs of refused proposals ----------------------------------------------------------------------------------- */

/* The upper half of the word is the longest run of the pass; the lower half is the run under way, which may have begun
 * in an earlier pass. RUN_MOST means this many or more. */
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

#endif
