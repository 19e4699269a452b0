/* The list of steps for a pass of Markov chains. */
#ifndef TWINLIGHT_MMLT_CHAIN_LIST_H
#define TWINLIGHT_MMLT_CHAIN_LIST_H

#include "backend/backend.h"

/* Records a pass in which every chain first replays its current path, then makes `steps` proposals. Free `list` with
 * step_list_destroy. The caller sets list->pass_words: CHAIN_PASS_* (chain/chain.h), chain_pass_fields of them per
 * chain. */
bool chain_list(const FrameParams *frame, uint steps, StepList *list, Error *error);

/* Words per chain in BUFFER_PASS. */
uint chain_pass_fields(const FrameParams *frame);

/* State size per chain, in 32-bit words. state: coordinates and what is known of the current path. densities: one per
 * vertex, for the current path and the proposal. all: these plus the walk under way and the buffers of vertices, rays,
 * hits and splats. */
typedef struct ChainWords {
    uint state, densities, all;
} ChainWords;

ChainWords chain_words(const FrameParams *frame);

/* Prints the memory that `chains` chains take to standard output. */
void chain_memory_print(const FrameParams *frame, unsigned chains);

#endif
