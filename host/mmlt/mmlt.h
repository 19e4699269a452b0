/* Metropolis light transport under way: what its loop (mmlt/integrator_mmlt.c), a generation (mmlt/generation.c) and
 * its pool (mmlt/pool.c) weight. */
#ifndef TWINLIGHT_MMLT_MMLT_H
#define TWINLIGHT_MMLT_MMLT_H

#include "mmlt/chain_groups.h"
#include "mmlt/chain_list.h"
#include "mmlt/chain_population.h"
#include "mmlt/combination.h"
#include "mmlt/importance.h"
#include "render/integrator.h"
#include "render/run.h"

#include "chain/chain.h"

/* Samples of a pool for every step of a chain, at least. On a Cornell box a sample takes as long as four or five steps,
 * so pools take about a quarter of the time. */
#define POOL_PER_STEP (1.0 / 12.0)

/* Even generations and odd ones are two renderings that know of each other only what they have found out about the
 * scene: weights, plans and limits of one follow from what the other has seen. So neither weighs its own errors
 * directly, which its chains carry on from one generation to the next, and the images of both can be compared. By way
 * of the other its past does have a part in its weights, so a picture is consistent but not unbiased. */
#define REPLICAS 2

typedef struct Mmlt {
    RenderRun *run;
    ChainOptions options;
    FrameParams paths_frame;
    StepList paths, pool, chains;
    uint64_t paths_delivered; /* of the generation under way, samples of single pixels */
    uint64_t paths_done; /* whole samples of path tracing, of every pixel */
    double paths_wanted; /* as many, in all */
    double paths_per_step, pool_per_step; /* samples of path tracing and of pools for a step of a chain */
    uint64_t work_done, work_last; /* combination_work: what --samples and progress count; of the latest generation */
    uint next_sample; /* of the pool: numbers below it are used */
    uint pool_sample; /* the first of the latest pool */
    uint pool_pixel; /* where the latest pool began in the order in which they visit the pixels */
    uint pool_lights_first; /* of its samples: the first with a walk from the light */
    uint pool_next[REPLICAS + 1]; /* where the next of a half will; last: of all that visit every pixel alike */
    uint pool_turns[REPLICAS + 1]; /* how often they have visited them all, or how many that visit more there were */
    uint generation;
    uint pool_count; /* room for so many samples */
    uint *pool_words;
    uint *begun; /* words of the chains as their pass began, where somebody wants to know */
    ChainPopulation populations[REPLICAS];
    float importance[REPLICAS][IMPORTANCE_CELLS];
    Guide guide; /* what the passes under way go by */
    uint visits[REPLICAS][IMPORTANCE_CELLS + 1]; /* of pools: importance_visits */
    double visited[REPLICAS][IMPORTANCE_CELLS]; /* visits of a cell's pixels over those of all, summed over samples */
    double visited_all[REPLICAS]; /* samples of pools */
    ChainGroups groups;
    Film film, pool_film, paths_film; /* of the generation under way */
    Combination combinations[REPLICAS];
    double pilot_brightness; /* of the pool before the first; 0: there was none */
    double brightness; /* of the latest pool: mean worth of a sample (POOL_WEIGHT) */
    double brightness_sum[REPLICAS]; /* of all pools */
} Mmlt;

/* The lists of steps, films, and options as they are meant; run->film must have its quantum. To be destroyed whether it
 * fails or not. */
bool mmlt_init(Mmlt *mmlt, RenderRun *run, Error *error);
void mmlt_destroy(Mmlt *mmlt);

/* Chains of the generation under way. */
ChainPopulation *mmlt_population(Mmlt *mmlt);

/* For a pass whose splats go to `film`. */
void mmlt_frame_film(FrameParams *frame, const Film *film);

/* Which replica of the image a generation is for; `paper` has chains that never end. */
int mmlt_replica(const Mmlt *mmlt, uint generation);

/* What all passes of a generation have in common: importance and limit. */
void mmlt_generation_frame(Mmlt *mmlt, FrameParams *frame);

/* What passes of the latest pool, of `count` samples, and of chains from it are given. */
FrameParams mmlt_pool_frame(Mmlt *mmlt, uint count);
FrameParams mmlt_chain_frame(Mmlt *mmlt);

/* A small pool before the first, of which only its brightness is kept: so the first generation has a limit as later
 * ones do, and what it shows can be compared with them. `chains`: of the first generation. *whole becomes false when it
 * was stopped before its end. */
bool mmlt_pilot_run(Mmlt *mmlt, uint chains, bool *whole, Error *error);

/* A pool, and where `count` chains begin (the words of mmlt->chains). *whole becomes false when it was stopped before
 * its end. */
bool mmlt_seeds_run(Mmlt *mmlt, uint count, bool *whole, Error *error);

/* Takes down where the latest pool has been. */
void mmlt_visits_count(Mmlt *mmlt);

/* Writes what makes the bad ones of a pass of `count` chains again where somebody wants to know
 * (RenderOptions.bad_chains). */
void mmlt_bad_chains_write(const Mmlt *mmlt, uint count);

/* A pool, `count` chains from it, path tracing, and what they show to the film. Counts only as a whole: when it is
 * stopped before its end nothing of it is kept, but of the first the samples of path tracing that were finished. */
bool mmlt_generation_run(Mmlt *mmlt, uint count, Error *error);

#endif
