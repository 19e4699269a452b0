/* A Metropolis rendering under way: its estimators, what guides them, what combines them, and what is planned. Its
 * main loop is in mmlt/integrator_mmlt.c. */
#ifndef TWINLIGHT_MMLT_MMLT_H
#define TWINLIGHT_MMLT_MMLT_H

#include "mmlt/bidirectional_estimator.h"
#include "mmlt/chains_estimator.h"
#include "mmlt/combined_image.h"
#include "mmlt/guide.h"
#include "mmlt/paths_estimator.h"
#include "mmlt/plan.h"
#include "mmlt/pool_estimator.h"

typedef struct Mmlt {
    RenderRun *run;
    const MmltScheme *scheme;
    ChainOptions options; /* complete */
    ChainsEstimator chains;
    PoolEstimator pool;
    PathsEstimator paths;
    BidirectionalEstimator bidirectional;
    Film film; /* of the estimator that runs; at the end, of the generation */
    Combination combinations[REPLICAS];
    CombinedImage combined;
    /* By path tracing alone in the first generations of each, as long as it may be shown. */
    PathsChange changes[REPLICAS];
    MmltGuide guide;
    Plan plan;
    Generation generation; /* under way */
    double seconds; /* that the latest generation took */
    /* Of the generation under way: samples of each estimator, when it began (timing_now), the seconds that it was then
     * expected to take (0: not known), and its work so far (estimators_work). */
    double samples[ESTIMATOR_COUNT], begun, expected, work;
    bool whole; /* the latest generation was not stopped before its end */
    ArchiveMemory
        kept; /* the state between generations for a checkpoint (mmlt/mmlt_archive.h); empty before the first */
} Mmlt;

/* Makes all parts and fills in default options; plans the first generation. run->film must have its quantum. *mmlt must
 * stay where it is. Call mmlt_destroy even on failure. */
bool mmlt_init(Mmlt *mmlt, RenderRun *run, Error *error);
void mmlt_destroy(Mmlt *mmlt);

/* Whether paths are long enough for chains. */
bool mmlt_chains_needed(const Mmlt *mmlt);

/* Begins to keep what path tracing alone would change in the first generations, if it may be shown; or forgets it. */
bool mmlt_changes_init(Mmlt *mmlt, Error *error);
void mmlt_changes_forget(Mmlt *mmlt);

/* Runs the pilot pool of a first generation of `count` chains (pool_estimator_pilot), if there is a clamping threshold
 * to set. *whole: set to false if stopped before the end. */
bool mmlt_pilot_run(Mmlt *mmlt, uint count, bool *whole, Error *error);

/* Runs a pool and resamples `count` chains from it. *whole: set to false if stopped before the end. */
bool mmlt_seeds_run(Mmlt *mmlt, uint count, bool *whole, Error *error);

/* Runs a generation (a pool, `count` chains from it, path tracing, and bidirectional path tracing if it is planned; 0:
 * path tracing alone) and adds their combination to the film. All or nothing: a generation that is stopped is discarded,
 * except that of the first the finished path tracing samples are kept. */
bool mmlt_generation_run(Mmlt *mmlt, uint count, Error *error);

/* The seconds that the next generation takes with any number of chains, as far as the latest one tells: path tracing in
 * the first ones. */
double mmlt_least_seconds(const Mmlt *mmlt);

#endif
