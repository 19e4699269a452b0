/* Chooses the paths that chains start from, with probability proportional to their weights. */
#ifndef TWINLIGHT_MMLT_CHAIN_SEEDS_H
#define TWINLIGHT_MMLT_CHAIN_SEEDS_H

#include "base/error.h"
#include "math/platform.h"
#include "render/job.h"

/* Paths that chains may start from. */
typedef struct SeedCandidates {
    const double *weights;
    const uint *keys; /* chain_key; 0: no path */
    uint count;
} SeedCandidates;

/* Systematic resampling: with `sum` the sum of all weights, a path of weight w is taken floor or ceil of count w / sum
 * times, on average over `offset` exactly count w / sum times. */
typedef struct SystematicResampling {
    uint count; /* of chains */
    double offset; /* of the comb, in units of its spacing: uniform in [0, 1) */
    ChainOrder order; /* of the candidates along the comb */
} SystematicResampling;

/* seeds[resampling->count]: receives the numbers of the chosen candidates, sorted by `order`, duplicates adjacent.
 * *sum: receives the sum of the weights; if it is zero, nothing is chosen. Fails only when out of memory. */
bool chain_seeds_choose(const SeedCandidates *candidates, const SystematicResampling *resampling, uint *seeds,
                        double *sum, Error *error);

#endif
