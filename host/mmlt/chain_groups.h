/* Whether groups of Markov chains that know nothing of each other agree: the potential scale reduction of Gelman and
 * Rubin, R-hat (base/sample_statistics.h), for each depth.
 *
 * Groups are the two halves of the image, whose populations begin with pools of their own; with --mlt-scheme=paper,
 * whose chains never begin again, parts of the chains, of each depth those that stand together, which began with few
 * strategies. Their draws are the paths at which chains end a pass. Of a path count the logarithm of what it carries,
 * for the luminance itself may have no variance, and, where it begins at the camera, the two coordinates of its place
 * on the film; R-hat is the largest of the three. By chance alone it is about 1 + 1 / (2 n) where a group has as much
 * to say as n independent paths. What no chain has met it does not see. */
#ifndef TWINLIGHT_MMLT_CHAIN_GROUPS_H
#define TWINLIGHT_MMLT_CHAIN_GROUPS_H

#include "base/sample_statistics.h"
#include "render/chain_statistics.h"

#define CHAIN_GROUPS 8
#define CHAIN_QUANTITIES 3

typedef struct ChainGroups {
    SampleMoments moments[CHAIN_DEPTHS][CHAIN_QUANTITIES][CHAIN_GROUPS];
} ChainGroups;

/* Adds where `count` chains are, from their words after a pass (chain/chain.h), coordinates included: to the groups
 * first ... first + parts - 1, each an equal part of the chains of a depth in their order. */
void chain_groups_add(ChainGroups *groups, const uint *words, uint count, uint first, uint parts);

/* 0: not known, for fewer than two groups have two draws each, or nothing differs. May be infinite: draws differ
 * between groups alone. */
double chain_groups_r_hat(const ChainGroups *groups, int depth);

#endif
