/* The list of steps of a pass of chains. */
#ifndef TWINLIGHT_MMLT_CHAIN_LIST_H
#define TWINLIGHT_MMLT_CHAIN_LIST_H

#include "backend/backend.h"

/* `steps` proposals for every chain, after the current path itself. To be freed by step_list_destroy. The words of the
 * pass are the caller's to set: CHAIN_PASS_* (chain/chain.h), chain_pass_fields of them. */
bool chain_list(const FrameParams *frame, uint steps, StepList *list, Error *error);

/* Fields of BUFFER_PASS. */
uint chain_pass_fields(const FrameParams *frame);

/* Words of a chain's own: its coordinates and what it knows of its current path; and in all, with the walk under way
 * and the buffers of rays and vertices. Densities, one word a vertex, twice. */
typedef struct ChainWords {
    uint state, densities, all;
} ChainWords;

ChainWords chain_words(const FrameParams *frame);

/* The bytes of `chains` of them, on standard output. */
void chain_memory_print(const FrameParams *frame, unsigned chains);

/* Chains at a time where nobody asks for a number. */
#define CHAINS_DEFAULT 524288u
#define PAPER_CHAINS_DEFAULT 16384u

#endif
