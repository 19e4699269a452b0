/* Statistics of Markov chains: counted from the words that every pass leaves (chain/chain.h), and summed over
 * renderings. */
#ifndef TWINLIGHT_RENDER_CHAIN_STATISTICS_H
#define TWINLIGHT_RENDER_CHAIN_STATISTICS_H

#include "math/platform.h"

#include <stdint.h>

#define CHAIN_KINDS 4 /* MUTATION_* */
#define CHAIN_DEPTHS 32
#define CHAIN_WEIGHTS 4

typedef struct ChainStatistics {
    uint64_t pool_samples, seeds, steps;
    uint64_t proposals[CHAIN_KINDS][CHAIN_DEPTHS], accepted[CHAIN_KINDS][CHAIN_DEPTHS]; /* by depth */
    uint64_t longest_run[CHAIN_DEPTHS]; /* most proposals in a row that a chain rejected, across passes (CHAIN_RUN) */
    uint64_t starts[CHAIN_DEPTHS], distinct_starts[CHAIN_DEPTHS]; /* ChainStarts of all generations */
    /* smallest fraction of a generation's starting paths that were distinct; 0: there were none */
    double least_distinct;
    double r_hat[CHAIN_DEPTHS]; /* over groups of chains (mmlt/chain_groups.h); 0: not known */
    double pool_seconds, chain_seconds, direct_seconds, bidirectional_seconds;
    /* of chains, pool, path tracing and bidirectional path tracing in the latest generation's picture
     * (mmlt/combination.h); 0: not combined */
    double weights[CHAIN_WEIGHTS];
} ChainStatistics;

/* The starting paths of a generation's chains. A path of large weight starts several. */
typedef struct ChainStarts {
    uint kept; /* chains continued from the previous generation; the others start from the pool */
    uint chains[CHAIN_DEPTHS], distinct[CHAIN_DEPTHS]; /* by depth: all starts, and distinct paths among them */
} ChainStarts;

/* Adds the starts of a generation. */
void chain_statistics_starts(ChainStatistics *statistics, const ChainStarts *starts);

/* Adds a pass of `steps` steps. words: CHAIN_PASS_* of `count` chains. */
void chain_statistics_pass(ChainStatistics *statistics, const uint *words, uint count, uint steps);

/* Proposals at a depth, all kinds of mutation together. */
uint64_t chain_statistics_proposals(const ChainStatistics *statistics, int depth);

/* Adds another rendering's statistics: counts, seconds and weights are summed; of the others the worse value is
 * kept. */
void chain_statistics_add(ChainStatistics *sum, const ChainStatistics *other);

#endif
