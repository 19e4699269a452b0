/* Convergence diagnostic: do independent groups of Markov chains agree? Computes the potential scale reduction factor
 * R-hat of Gelman and Rubin (base/sample_statistics.h) for each path depth.
 *
 * The groups are the two replicas, whose populations start from separate pools. With --mlt=scheme=paper, whose chains
 * never restart, the chains of each depth are instead cut into consecutive groups, each of which started from only a
 * few strategies.
 *
 * One draw per chain is the path it holds at the end of a pass. Three scalars are compared: log luminance (luminance
 * itself may have infinite variance) and, for paths with a camera subpath, the two film coordinates. R-hat is the
 * largest of the three. If each group is worth n independent paths, chance alone gives about 1 + 1 / (2 n). R-hat
 * cannot detect a mode that no chain has visited. */
#ifndef TWINLIGHT_MMLT_CHAIN_GROUPS_H
#define TWINLIGHT_MMLT_CHAIN_GROUPS_H

#include "base/sample_statistics.h"
#include "render/chain_statistics.h"

#define CHAIN_GROUPS 8
#define CHAIN_QUANTITIES 3

typedef struct ChainGroups {
    SampleMoments moments[CHAIN_DEPTHS][CHAIN_QUANTITIES][CHAIN_GROUPS];
} ChainGroups;

/* Adds the states of `count` chains, given by the words of a finished pass (CHAIN_PASS_* in chain/chain.h, coordinates
 * included). The chains of each depth are cut, in order, into `parts` equal parts, which go to groups first ... first +
 * parts - 1. */
void chain_groups_add(ChainGroups *groups, const uint *words, uint count, uint first, uint parts);

/* R-hat of a depth; 0: unknown, because fewer than two groups have two draws each, or all draws are equal. Infinite if
 * draws differ between groups but not within them. */
double chain_groups_r_hat(const ChainGroups *groups, int depth);

#endif
