/* Markov chains that continue from one generation to the next where light is hard to find.
 *
 * A population estimates integrals of the target f: the sum over its chains of brightness / count times the integrand
 * at their states. So does a pool, with independent samples. At the end of a generation both are combined by a
 * partition of unity over path space: of every path, the population contributes the part n / (n + m) f / (f +
 * threshold), where n is the number of pool samples behind it and m that of the new pool, and the pool contributes the
 * rest. This is unbiased for any threshold. Population and pool are then resampled together into the next population.
 * Paths with f well below the threshold come from the new pool; paths well above it, which pools rarely find, are kept,
 * with the mean weight that all pools so far have given them.
 *
 * Compare the resampling of Andrieu, Lee and Vihola, "Uniform ergodicity of the iterated conditional SMC and geometric
 * ergodicity of particle Gibbs samplers", 2018: its probability to keep a state has the same form, but it is right only
 * in the limit. */
#ifndef TWINLIGHT_MMLT_CHAIN_POPULATION_H
#define TWINLIGHT_MMLT_CHAIN_POPULATION_H

#include "base/archive.h"
#include "math/platform.h"
#include "mmlt/chain_seeds.h"
#include "render/chain_statistics.h"

typedef struct ChainPopulation {
    uint *words; /* BUFFER_PASS: CHAIN_PASS_* (chain/chain.h), [fields][count] */
    uint fields;
    uint count;
    double samples; /* number of samples of all pools so far */
    double brightness; /* mean contribution weight of a pool's sample (POOL_WEIGHT); 0: there are no chains */
} ChainPopulation;

/* An empty population. fields: words per chain, chain_pass_fields (mmlt/chain_list.h). */
void chain_population_init(ChainPopulation *population, uint fields);
void chain_population_destroy(ChainPopulation *population);

/* What a population can hold. */
typedef struct PopulationLimits {
    uint chains;
    uint depth; /* segments of a path */
} PopulationLimits;

/* Saves the chains, or restores them into a population with as many words per chain. Restoring fails unless all of them
 * can go on: with paths within the limits, finite luminances and existing cells. Any coordinates will do. */
void chain_population_archive(Archive *archive, ChainPopulation *population, PopulationLimits limits);

/* The samples of a pool. */
typedef struct PoolSamples {
    const uint *words; /* POOL_* (chain/pool.h), [POOL_WORDS][count] */
    uint count;
} PoolSamples;

/* Resamples this population, if it has chains, and a pool into the next population, ready for a pass. change: per cell,
 * the target importance of this pool and the next pass over that of the previous pass; NULL: unchanged. threshold: see
 * above, in units of f. starts: receives the counts of starting paths; may be NULL. Fails only when out of memory; the
 * population is then unchanged. */
bool chain_population_renew(ChainPopulation *population, const PoolSamples *pool, const float *change, double threshold,
                            const SystematicResampling *resampling, ChainStarts *starts, Error *error);

#endif
