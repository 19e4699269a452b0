/* Where chains begin: paths of a pool, drawn in proportion to what they are worth. */
#ifndef TWINLIGHT_CHAIN_SEEDS_H
#define TWINLIGHT_CHAIN_SEEDS_H

#include "error.h"
#include "platform.h"

/* Chooses `count` of the `pool_count` samples whose words are pool[POOL_WEIGHT * pool_count ...] and
 * pool[POOL_KEY * pool_count ...] (pool.h) by systematic resampling over the sum of all weights: a sample of weight w is
 * taken floor or ceil of count w / sum times, count w / sum on average over offset, uniform in [0, 1). seeds[i]: its
 * number; keys[i]: its path. With `sorted`, in the order of depth and then strategy; without, in that of the pool.
 * *brightness: sum of weights / pool_count. Without any weight it is zero and nothing is chosen. */
bool chain_seeds_choose(const uint *pool, uint pool_count, bool sorted, double offset, uint count, uint *seeds,
                        uint *keys, double *brightness, Error *error);

#endif
