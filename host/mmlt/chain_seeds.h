/* Which of many paths chains begin with: drawn in proportion to what they are worth. */
#ifndef TWINLIGHT_MMLT_CHAIN_SEEDS_H
#define TWINLIGHT_MMLT_CHAIN_SEEDS_H

#include "base/error.h"
#include "math/platform.h"
#include "render/job.h"

/* Chooses `count` of the `candidates` paths by systematic resampling over the sum of all weights: one of weight w is
 * taken floor or ceil of count w / sum times, count w / sum on average over offset, uniform in [0, 1). keys: chain_key
 * of each; 0: there is none. seeds[i]: its number, in the order wanted; the same ones stand together. *sum: of the
 * weights. When it is zero nothing is chosen. */
bool chain_seeds_choose(const double *weights, const uint *keys, uint candidates, ChainOrder order, double offset,
                        uint count, uint *seeds, double *sum, Error *error);

#endif
