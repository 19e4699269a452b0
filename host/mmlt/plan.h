/* What runs next, and for how long: the sizes of generations, and how many samples of the pool, of path tracing
 * and of bidirectional path tracing go with a step of a chain. */
#ifndef TWINLIGHT_MMLT_PLAN_H
#define TWINLIGHT_MMLT_PLAN_H

#include "mmlt/combination_rates.h"
#include "mmlt/scheme.h"
#include "render/job.h"

typedef struct Plan {
    const ChainOptions *options; /* complete: no zeros for defaults but `pool` */
    const MmltScheme *scheme;
    uint64_t pixels;
    StepRates rates; /* at present */
    bool bidirectional_first; /* bidirectional path tracing has at least BIDIRECTIONAL_FIRST of the work */
    uint64_t total; /* estimators_work that is wanted */
    bool timed; /* `total` is no limit: the time is */
    uint64_t done, last; /* estimators_work in all (what --samples and progress count) and of the latest generation */
    /* Samples per pixel that are due, which rounding has left to later generations: of path tracing, and of
     * bidirectional path tracing. */
    double owed, owed_bidirectional;
    double bidirectional_most; /* samples of a pixel by bidirectional path tracing in the next generation */
    uint width; /* of the backend (BackendStatistics.width); 0 until set */
    uint chains; /* in the next generation that has any */
    bool easy; /* path tracing alone does nearly as well as the best division of work */
    double alone; /* samples per pixel of the next generation if it is path tracing alone; 0: it has chains */
    double alone_work; /* estimators_work that path tracing may do alone before the next generation with chains */
    double planned; /* work of a chain, with its part of the others, by the rates of the latest generation */
} Plan;

/* Plans the first generation: few chains, for an early image, and at most half of the work. work: that is wanted
 * (estimators_work); 0: no limit. options, scheme: must outlive the plan. */
void plan_init(Plan *plan, const ChainOptions *options, const MmltScheme *scheme, uint64_t pixels, uint64_t work);

/* Begins with rates that are known. Before the first generation. */
void plan_rates_set(Plan *plan, StepRates rates);

/* Saves what was learnt and done, or restores it: not the limit, which may be another one. */
void plan_archive(Archive *archive, Plan *plan); /* but for bidirectional path tracing */
void plan_archive_bidirectional(Archive *archive, Plan *plan);

/* Adopts the best rates by what is known after generation `index`; no change until variances are known, nor between the
 * two generations of a pair. */
void plan_learn(Plan *plan, uint index, Combination *combination);

/* The part of bidirectional path tracing is at least BIDIRECTIONAL_FIRST if it comes first, now and whenever rates are
 * adopted, and otherwise none unless it is better. */
void plan_bidirectional_set(Plan *plan, bool first, bool better);

/* Counts a generation's work. owed: Plan.owed after it. */
void plan_count(Plan *plan, uint64_t work, double owed);

/* Plans the size of generation `index`, and whether it is path tracing alone. Both of a pair, one for each replica,
 * have the same, also the last one before a limit of work. With a limit of work the sizes depend on that alone, so
 * that the image does not depend on the clock. seconds: of the latest generation; elapsed: in all. */
void plan_next(Plan *plan, uint index, double seconds, double elapsed);

/* Shortens the next two generations, a pair, so that they end with about this much work in all (estimators_work), but
 * to no less than a path tracing sample of every pixel where that is little work. Before the first of them. */
void plan_shorten(Plan *plan, double work);

/* The seconds that the next generation takes, if the latest one took `seconds`; 0: there was none. */
double plan_seconds(const Plan *plan, double seconds);

/* Fits the next generation into what is left of the time, unless that is so little that none should follow (false).
 * With the published scheme, whose generations have one size, it is only whether there is time left. seconds: of the
 * latest generation, which tells what work takes. least: what the next one takes with any number of chains. limit: all
 * of the time. */
bool plan_fit(Plan *plan, double seconds, double least, double left, double limit);

/* Chains of the next generation; 0: it is path tracing alone. */
uint plan_chains(const Plan *plan);

/* Samples of a pool for `chains` chains: --mlt=pool, else by the rates, rounded to whole samples per pixel if that
 * gives at least one. */
uint plan_pool_samples(const Plan *plan, uint chains);

/* Samples of path tracing per pixel for `chains` chains: by the rates, but no more than the work that is left
 * allows. Of path tracing alone, with `chains` 0: Plan.alone. */
double plan_paths_samples(const Plan *plan, uint chains);

/* The same of bidirectional path tracing. */
double plan_bidirectional_samples(const Plan *plan, uint chains);

#endif
