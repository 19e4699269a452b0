/* The state of a Metropolis rendering, shared by its main loop (mmlt/integrator_mmlt.c), a generation
 * (mmlt/generation.c) and its pool (mmlt/pool.c). */
#ifndef TWINLIGHT_MMLT_MMLT_H
#define TWINLIGHT_MMLT_MMLT_H

#include "mmlt/chain_groups.h"
#include "mmlt/chain_list.h"
#include "mmlt/chain_population.h"
#include "mmlt/combination.h"
#include "mmlt/importance.h"
#include "mmlt/scheme.h"
#include "render/integrator.h"
#include "render/run.h"

#include "chain/chain.h"

typedef struct Mmlt {
    RenderRun *run;
    ChainOptions options;
    const MmltScheme *scheme;
    FrameParams paths_frame;
    StepList paths, pool, chains;
    uint64_t paths_delivered; /* single-pixel samples of path tracing in the generation under way */
    uint64_t paths_done; /* path tracing samples of every pixel so far */
    double paths_wanted; /* the same according to the plan, fractions included */
    double paths_per_step, pool_per_step; /* the current plan */
    /* combination_work, in all (what --samples and progress count) and of the latest generation */
    uint64_t work_done, work_last;
    uint next_sample; /* the next unused sample number for pools */
    uint pool_sample; /* first sample number of the latest pool */
    uint pool_pixel; /* first position of the latest pool in the order in which pools visit pixels */
    uint pool_lights_first; /* index of the latest pool's first sample with a light subpath */
    /* pixel order position of the next pool: of each replica's own visits; last: of all that visit every pixel
     * equally */
    uint pool_next[REPLICAS + 1];
    /* rounds of the pixels completed in each order; for pools longer than a round, the number of pools */
    uint pool_turns[REPLICAS + 1];
    uint generation;
    uint pool_count; /* capacity of pool_words, samples */
    uint *pool_words;
    uint *begun; /* the chains' words before the pass; only with --dump-bad */
    ChainPopulation populations[REPLICAS];
    float importance[REPLICAS][IMPORTANCE_CELLS];
    Guide guide; /* for the passes under way */
    uint visits[REPLICAS][IMPORTANCE_CELLS + 1]; /* of each replica's pools: importance_visits */
    double visited[REPLICAS][IMPORTANCE_CELLS]; /* visits per pixel over the mean, summed over samples */
    double visited_all[REPLICAS]; /* pool samples in `visited` */
    ChainGroups groups;
    Film film, pool_film, paths_film; /* of the generation under way */
    Combination combinations[REPLICAS];
    double pilot_brightness; /* brightness by the pilot pool; 0: there was none */
    double brightness; /* of the latest pool: mean contribution weight (POOL_WEIGHT) */
    double brightness_sum[REPLICAS]; /* summed over the replica's pools */
} Mmlt;

/* Creates step lists and films and fills in default options. run->film must have its quantum. Call mmlt_destroy even on
 * failure. */
bool mmlt_init(Mmlt *mmlt, RenderRun *run, Error *error);
void mmlt_destroy(Mmlt *mmlt);

/* The population of the replica whose generation is under way. */
ChainPopulation *mmlt_population(Mmlt *mmlt);

/* Prepares the frame of a pass whose splats go to `film`. */
void mmlt_film_params(FilmParams *params, const Film *film);

/* The replica that a generation belongs to; always 0 with --mlt-scheme=paper, whose chains never restart. */
int mmlt_replica(const Mmlt *mmlt, uint generation);

/* Sets what all passes of a generation share: target importance (in mmlt->guide) and clamping threshold. */
void mmlt_generation_frame(Mmlt *mmlt, FrameParams *frame);

/* Frames for passes of the latest pool, of `count` samples, and of chains that start from it. */
FrameParams mmlt_pool_frame(Mmlt *mmlt, uint count);
FrameParams mmlt_chain_frame(Mmlt *mmlt);

/* Runs a small pilot pool before the first generation and keeps only its brightness, so that the first generation has a
 * clamping threshold as later ones do and its variances compare with theirs. chains: of the first generation. *whole:
 * set to false if stopped before the end. */
bool mmlt_pilot_run(Mmlt *mmlt, uint chains, bool *whole, Error *error);

/* Runs a pool and resamples `count` chains from it (the words of mmlt->chains). *whole: set to false if stopped before
 * the end. */
bool mmlt_seeds_run(Mmlt *mmlt, uint count, bool *whole, Error *error);

/* Adds the latest pool's visits to `visited`. */
void mmlt_visits_count(Mmlt *mmlt);

/* Only with --dump-bad: writes what reproduces the chains, of a pass of `count`, that had a non-finite contribution
 * (RenderOptions.bad_chains). */
void mmlt_bad_chains_write(const Mmlt *mmlt, uint count);

/* Runs a generation (a pool, `count` chains from it, path tracing) and adds their combination to the film. All or
 * nothing: a generation that is stopped is discarded, except that of the first the finished path tracing samples are
 * kept. */
bool mmlt_generation_run(Mmlt *mmlt, uint count, Error *error);

#endif
