/* What Markov chains did: counted from the words that every pass leaves (chain/chain.h), and summed over several
 * renderings. */
#ifndef TWINLIGHT_RENDER_CHAIN_STATISTICS_H
#define TWINLIGHT_RENDER_CHAIN_STATISTICS_H

#include "math/platform.h"

#include <stdint.h>

#define CHAIN_KINDS 4 /* MUTATION_* */
#define CHAIN_DEPTHS 32

typedef struct ChainStatistics {
    uint64_t pool_samples, seeds, steps;
    uint64_t proposals[CHAIN_KINDS][CHAIN_DEPTHS], accepted[CHAIN_KINDS][CHAIN_DEPTHS]; /* by depth */
    uint64_t longest_run[CHAIN_DEPTHS]; /* proposals that one chain refused in a row, over passes (CHAIN_RUN) */
    uint64_t starts[CHAIN_DEPTHS], distinct_starts[CHAIN_DEPTHS]; /* ChainStarts of all generations */
    double least_distinct; /* the smallest part of a generation's starts that were different paths; 0: there was none */
    double r_hat[CHAIN_DEPTHS]; /* over groups of chains (mmlt/chain_groups.h); 0: not known */
    double pool_seconds, chain_seconds, direct_seconds;
    double weights
        [3]; /* of chains, pool and path tracing in the latest generation (mmlt/combination.h); 0: not combined */
} ChainStatistics;

/* How the chains of a generation begin: a path that is worth much begins many. */
typedef struct ChainStarts {
    uint kept; /* chains that go on from the generation before; the others begin with samples of the pool */
    uint chains[CHAIN_DEPTHS], distinct[CHAIN_DEPTHS]; /* by depth: all, and different paths that they begin with */
} ChainStarts;

void chain_statistics_starts(ChainStatistics *statistics, const ChainStarts *starts);

/* Adds what `count` chains did in a pass of so many steps: its words, CHAIN_PASS_* of each chain. */
void chain_statistics_pass(ChainStatistics *statistics, const uint *words, uint count, uint steps);

/* Of all kinds, at a depth. */
uint64_t chain_statistics_proposals(const ChainStatistics *statistics, int depth);

/* Adds those of another rendering: counts, seconds and weights their sum, of the others the worse one. */
void chain_statistics_add(ChainStatistics *sum, const ChainStatistics *other);

#endif
