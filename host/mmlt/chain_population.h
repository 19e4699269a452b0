/* Chains that live on from one generation to the next where light is hard to find.
 *
 * A population estimates integrals of f: the sum over its chains of brightness / count times a function of where they
 * are. So does a pool, by independent samples. At a generation's end each answers for a part of path space: chains for
 * the part n / (n + m) f / (f + threshold) of every path, where n samples have made the population and the pool has m,
 * and the pool for the rest. The parts add up to the whole whatever the threshold, so nothing is lost or counted twice,
 * and population and pool are resampled together into the next population. A path that carries much less than the
 * threshold is taken from the new pool; one that carries much more, which pools meet rarely, is remembered, as the mean
 * of all pools has it. (Compare the resampling of Andrieu, Lee and Vihola, "Uniform ergodicity of the iterated
 * conditional SMC and geometric ergodicity of particle Gibbs samplers", 2018, whose chance to keep a state has the same
 * form but which is right only in the limit.) */
#ifndef TWINLIGHT_MMLT_CHAIN_POPULATION_H
#define TWINLIGHT_MMLT_CHAIN_POPULATION_H

#include "base/error.h"
#include "math/platform.h"
#include "mmlt/chain_seeds.h"
#include "render/chain_statistics.h"

typedef struct ChainPopulation {
    uint *words; /* BUFFER_PASS: CHAIN_PASS_* (chain/chain.h) of `count` chains, `fields` words each */
    uint fields;
    uint count;
    double samples; /* of all pools so far */
    double brightness; /* mean worth of a pool's sample (POOL_WEIGHT); 0: there are no chains */
} ChainPopulation;

void chain_population_init(ChainPopulation *population, uint fields);
void chain_population_destroy(ChainPopulation *population);

/* The next population, of `count` chains, ready for a pass: from this one, if it has chains, and from the pool_count
 * samples whose words are pool[POOL_* * pool_count ...] (chain/pool.h). change: of each cell, the importance that the
 * pool had and the next pass has over that of the pass before; NULL: it is what it was. order, offset:
 * mmlt/chain_seeds.h. `starts` (may be NULL) gets what they begin with. */
bool chain_population_renew(ChainPopulation *population, const uint *pool, uint pool_count, const float *change,
                            double threshold, ChainOrder order, double offset, uint count, ChainStarts *starts,
                            Error *error);

#endif
