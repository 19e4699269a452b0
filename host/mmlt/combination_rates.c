#include "mmlt/combination_rates.h"

#include "mmlt/combination_rare.h"
#include "mmlt/combination_tile.h"
#include "mmlt/tuning.h"

#include <math.h>
#include <string.h>

/* A division of work, and the error of the picture by it. */
typedef struct SearchBest {
    double samples[ESTIMATOR_COUNT], error;
} SearchBest;

/* Adopts a division of work if it has less error. work: parts of the estimators. */
static void search_try(const Combination *combination, size_t every, const double work[ESTIMATOR_COUNT],
                       SearchBest *best)
{
    SearchBest tried;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        tried.samples[s] = work[s] / estimator_cost((EstimatorKind)s);
    tried.error = combination_error(combination, tried.samples, true, every);
    if (tried.error < best->error)
        *best = tried;
}

static int search_threads(const Combination *combination)
{
    return combination_tile_count(combination) < PLAN_TILES ? 1 : combination->threads;
}

/* The best division of work for each part of path tracing. Chains and pools have one part each or more, or half a part
 * each. */
typedef struct RatesSearch {
    const Combination *combination;
    size_t every;
    SearchBest best[PLAN_PARTS];
} RatesSearch;

static void rates_of_paths(void *context, size_t paths)
{
    RatesSearch *search = context;
    search->best[paths].error = HUGE_VAL;
    const size_t rest = PLAN_PARTS - paths, most = rest > 1 ? rest - 1 : 1;
    for (size_t pool = 1; paths > 0 && pool <= most; ++pool) {
        const double part = rest > 1 ? (double)pool : 0.5;
        const double work[ESTIMATOR_COUNT] = {(double)rest - part, part, (double)paths};
        search_try(search->combination, search->every, work, &search->best[paths]);
    }
}

/* More than any samples of an estimator per step of a chain: of PLAN_PARTS parts chains have more than one in
 * PLAN_PARTS of a part. */
static double rate_most(EstimatorKind kind)
{
    return PLAN_PARTS * PLAN_PARTS * estimator_cost(ESTIMATOR_CHAINS) / estimator_cost(kind);
}

void step_rates_archive(Archive *archive, StepRates *rates)
{
    const double least = estimator_cost(ESTIMATOR_CHAINS) / (PLAN_PARTS * estimator_cost(ESTIMATOR_PATHS));
    archive_doubles(archive, &rates->paths, 1, (NumberRange){least, rate_most(ESTIMATOR_PATHS)},
                    "samples of path tracing per step");
    archive_doubles(archive, &rates->pool, 1, (NumberRange){POOL_PER_STEP, rate_most(ESTIMATOR_POOL)},
                    "samples of a pool per step");
}

void step_rate_archive_bidirectional(Archive *archive, StepRates *rates)
{
    archive_doubles(archive, &rates->bidirectional, 1, (NumberRange){0.0, rate_most(ESTIMATOR_BIDIRECTIONAL)},
                    "samples of bidirectional path tracing per step");
}

/* The best division of work for each part of bidirectional path tracing, at least one. Chains and pools divide what path
 * tracing leaves as they do without it. */
typedef struct BidirectionalSearch {
    const Combination *combination;
    size_t every;
    double chains; /* their part of what chains and pools have together */
    SearchBest best[PLAN_PARTS];
} BidirectionalSearch;

static void rates_of_bidirectional(void *context, size_t parts)
{
    BidirectionalSearch *search = context;
    search->best[parts].error = HUGE_VAL;
    for (size_t paths = 1; parts > 0 && parts + paths < PLAN_PARTS; ++paths) {
        const double rest = (double)(PLAN_PARTS - parts - paths);
        const double work[ESTIMATOR_COUNT] = {search->chains * rest, (1.0 - search->chains) * rest, (double)paths,
                                              (double)parts};
        search_try(search->combination, search->every, work, &search->best[parts]);
    }
}

/* Divides work anew if that with bidirectional path tracing is better. */
static void bidirectional_divide(Combination *combination, size_t every, SearchBest *best)
{
    const double chains = estimator_cost(ESTIMATOR_CHAINS) * best->samples[ESTIMATOR_CHAINS],
                 pool = estimator_cost(ESTIMATOR_POOL) * best->samples[ESTIMATOR_POOL],
                 least = (combination->opened ? BIDIRECTIONAL_ERROR_OPENED : BIDIRECTIONAL_ERROR) * best->error;
    BidirectionalSearch search = {.combination = combination, .every = every, .chains = chains / (chains + pool)};
    combination->bidirectional_better = false;
    if (!combination->ready[ESTIMATOR_BIDIRECTIONAL])
        return;
    parallel_run(PLAN_PARTS, search_threads(combination), rates_of_bidirectional, &search);
    for (size_t parts = 1; parts < PLAN_PARTS; ++parts)
        if (search.best[parts].error < best->error && search.best[parts].error < least) {
            *best = search.best[parts];
            combination->bidirectional_better = true;
        }
}

StepRates combination_rates(Combination *combination)
{
    /* odd, so that it is no divisor of most widths */
    RatesSearch search = {.combination = combination, .every = combination_tile_count(combination) / PLAN_TILES | 1u};
    size_t best = 0;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        if (s != ESTIMATOR_BIDIRECTIONAL && !combination->ready[s])
            return (StepRates){0};
    parallel_run(PLAN_PARTS, search_threads(combination), rates_of_paths, &search);
    for (size_t paths = 1; paths < PLAN_PARTS; ++paths)
        if (search.best[paths].error < search.best[best].error)
            best = paths;
    if (best == 0)
        return (StepRates){0};
    const double *samples = search.best[best].samples;
    memcpy(combination->best_others, samples, sizeof search.best[best].samples);
    bidirectional_divide(combination, search.every, &search.best[best]);
    memcpy(combination->best, samples, sizeof search.best[best].samples);
    return (StepRates){.paths = samples[ESTIMATOR_PATHS] / samples[ESTIMATOR_CHAINS],
                       .pool = samples[ESTIMATOR_POOL] / samples[ESTIMATOR_CHAINS],
                       .bidirectional = samples[ESTIMATOR_BIDIRECTIONAL] / samples[ESTIMATOR_CHAINS]};
}

double combination_alone_error(const Combination *combination)
{
    const double *best = combination->best,
                 alone[ESTIMATOR_COUNT] = {[ESTIMATOR_PATHS] = estimators_work(best) / estimator_cost(ESTIMATOR_PATHS)};
    if (!(best[ESTIMATOR_PATHS] > 0.0) || combination_rare_hidden(combination))
        return HUGE_VAL;
    return combination_error(combination, alone, true, 1) /
           fmax(combination_error(combination, best, true, 1), SPREAD_MIN);
}
