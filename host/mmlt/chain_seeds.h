/* Chooses the paths that chains start from, with probability proportional to their weights. */
#ifndef TWINLIGHT_MMLT_CHAIN_SEEDS_H
#define TWINLIGHT_MMLT_CHAIN_SEEDS_H

#include "base/error.h"
#include "math/platform.h"
#include "render/job.h"

/* Chooses `count` of `candidates` paths by systematic resampling: with `sum` the sum of all weights, a path of weight w
 * is taken floor or ceil of count w / sum times, on average over `offset` (uniform in [0, 1)) exactly count w / sum
 * times.
 *
 * weights, keys: per candidate; keys[i] = chain_key, 0: no path. seeds[count]: receives the numbers of the chosen
 * candidates, sorted by `order`, duplicates adjacent. *sum: receives the sum of the weights; if it is zero, nothing is
 * chosen. Fails only when out of memory. */
bool chain_seeds_choose(const double *weights, const uint *keys, uint candidates, ChainOrder order, double offset,
                        uint count, uint *seeds, double *sum, Error *error);

#endif
