/* The bootstrap pool: which pixels its samples visit, its pass, and its brightness. */
#ifndef TWINLIGHT_MMLT_POOL_ESTIMATOR_H
#define TWINLIGHT_MMLT_POOL_ESTIMATOR_H

#include "mmlt/estimator.h"
#include "mmlt/generation.h"

typedef struct PoolEstimator {
    Estimator own;
    const Guide *guide; /* for the passes under way */
    bool lights_all; /* every sample has a light subpath */
    uint next_sample; /* the next unused sample number */
    /* of the latest pool: */
    uint count; /* samples */
    uint sample; /* first sample number */
    uint pixel; /* first position in the order in which pools visit pixels */
    uint lights_first; /* index of the first sample with a light subpath */
    uint *words; /* POOL_* of sample i at [POOL_* * count + i] (chain/pool.h) */
    uint capacity; /* of words, samples */
    double brightness; /* mean contribution weight (POOL_WEIGHT) */
    /* position of the next pool in the order of pixels: of each replica's own visits; last: of all that visit every
     * pixel alike */
    uint next[REPLICAS + 1];
    /* rounds of the pixels completed in each order; for pools longer than a round, the number of pools */
    uint turns[REPLICAS + 1];
    double pilot_brightness; /* brightness by the pilot pool; 0: there was none */
    double brightness_sum[REPLICAS]; /* summed over the replica's pools ... */
    uint pools[REPLICAS]; /* ... which are so many */
} PoolEstimator;

/* film: the generation's. chains_only: the pool is not shown, and every sample has a light subpath. */
void pool_estimator_init(PoolEstimator *pool, const RenderRun *run, Film *film, bool chains_only, const Guide *guide);
void pool_estimator_destroy(PoolEstimator *pool);

/* Saves what the next pool and the next generation need, or restores it: not the latest pool's words. */
void pool_estimator_archive(Archive *archive, PoolEstimator *pool);

/* Makes the list, for paths of run->frame. */
bool pool_estimator_list(PoolEstimator *pool, const RenderRun *run, Error *error);

/* Runs a small pilot pool of up to `most` samples before the first generation and keeps only its brightness, so that
 * the first generation has a clamping threshold as later ones do and its variances compare with theirs. *whole: set to
 * false if stopped before the end. The film is empty again. */
bool pool_estimator_pilot(PoolEstimator *pool, const Generation *generation, uint most, bool *whole, Error *error);

/* Runs a pool. *whole: set to false if stopped before the end. */
bool pool_estimator_run(PoolEstimator *pool, const Generation *generation, uint count, bool *whole, Error *error);

/* The frame of a pass of the latest pool. */
FrameParams pool_estimator_frame(const PoolEstimator *pool, const Generation *generation);

/* Sets what the latest pool and the chains that start from it share. */
void pool_estimator_share(const PoolEstimator *pool, const Generation *generation, FrameParams *frame);

/* The replica visits its pixels anew, from a random position on: its visits have changed. */
void pool_estimator_restart(PoolEstimator *pool, const Generation *generation);

/* Counts the latest pool among the replica's. */
void pool_estimator_count(PoolEstimator *pool, const Generation *generation);

/* Mean brightness of the other replica's pools so far; at first the pilot's. */
double pool_estimator_brightness(const PoolEstimator *pool, const Generation *generation);

#endif
