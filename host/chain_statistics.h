/* What Markov chains did: counted from the words that every pass leaves (chain.h), and summed over several renderings. */
#ifndef TWINLIGHT_CHAIN_STATISTICS_H
#define TWINLIGHT_CHAIN_STATISTICS_H

#include "platform.h"

#include <stdint.h>

#define CHAIN_KINDS 4 /* MUTATION_* */
#define CHAIN_DEPTHS 32

typedef struct ChainStatistics {
    uint64_t pool_samples, seeds, steps;
    uint64_t proposals[CHAIN_KINDS][CHAIN_DEPTHS], accepted[CHAIN_KINDS][CHAIN_DEPTHS]; /* by depth */
    uint64_t longest_run[CHAIN_DEPTHS]; /* proposals that one chain refused in a row, over passes (CHAIN_RUN) */
    double pool_seconds, chain_seconds, direct_seconds;
    double shares[3]; /* of chains, pool and path tracing in the latest generation (blend.h); 0: not blended */
} ChainStatistics;

/* Adds what `count` chains did in a pass of so many steps: its words, CHAIN_PASS_* of each chain. */
void chain_statistics_pass(ChainStatistics *statistics, const uint *words, uint count, uint steps);

/* Of all kinds, at a depth. */
uint64_t chain_statistics_proposals(const ChainStatistics *statistics, int depth);

/* Adds those of another rendering: counts, seconds and shares their sum, of runs the longer one. */
void chain_statistics_add(ChainStatistics *sum, const ChainStatistics *other);

#endif
