/* The Markov chains: their populations, their pass, and what is counted of them. */
#ifndef TWINLIGHT_MMLT_CHAINS_ESTIMATOR_H
#define TWINLIGHT_MMLT_CHAINS_ESTIMATOR_H

#include "mmlt/chain_groups.h"
#include "mmlt/chain_population.h"
#include "mmlt/estimator.h"
#include "mmlt/generation.h"
#include "mmlt/pool_estimator.h"

typedef struct ChainsEstimator {
    Estimator own;
    ChainPopulation populations[REPLICAS];
    uint steps; /* of a chain in a pass */
    uint depth_most; /* segments of a path */
    uint *begun; /* the chains' words before the pass; only with --dump-bad */
    ChainGroups groups;
    uint groups_each; /* of a replica's chains in `groups` */
} ChainsEstimator;

/* film: the generation's. */
void chains_estimator_init(ChainsEstimator *chains, Film *film);
void chains_estimator_destroy(ChainsEstimator *chains);

/* Makes the list, for paths of run->frame and passes of `steps`. guide: for passes. groups: MmltScheme.groups. */
bool chains_estimator_list(ChainsEstimator *chains, const RenderRun *run, uint steps, const Guide *guide, uint groups,
                           Error *error);

/* Saves what the next generation needs, or restores it. most: chains that a population may have. */
void chains_estimator_archive(Archive *archive, ChainsEstimator *chains, uint most);

/* Forgets all chains. */
void chains_estimator_clear(ChainsEstimator *chains);

/* The replica's chains go on where the latest pass, or what was restored, left them, without chains_estimator_start. */
void chains_estimator_continue(ChainsEstimator *chains, const Generation *generation);

/* Resamples `count` chains from the replica's population and the latest pool. change, order: as for
 * chain_population_renew. */
bool chains_estimator_start(ChainsEstimator *chains, const Generation *generation, const PoolEstimator *pool,
                            const float *change, ChainOrder order, uint count, Error *error);

/* Whether the replica has chains; no: all of its pools were black, and the chains' expected contribution is zero,
 * too. */
bool chains_estimator_alive(const ChainsEstimator *chains, const Generation *generation);

/* Runs a pass of the replica's `count` chains, if it has any. continues: the next pass starts where this one ends,
 * without chains_estimator_start. *whole: set to false if stopped before the end. */
bool chains_estimator_run(ChainsEstimator *chains, const Generation *generation, const PoolEstimator *pool, uint count,
                          bool continues, bool *whole, Error *error);

/* The frame of a pass of the replica's chains. */
FrameParams chains_estimator_frame(const ChainsEstimator *chains, const Generation *generation,
                                   const PoolEstimator *pool);

/* Adds a finished pass of `count` chains to statistics and groups and, with --dump-bad, writes what reproduces those
 * that met a non-finite contribution (RenderOptions.bad_chains). */
void chains_estimator_count(ChainsEstimator *chains, const Generation *generation, const PoolEstimator *pool,
                            uint count);

#endif
