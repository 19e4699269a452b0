#include "mmlt/plan.h"

#include "mmlt/tuning.h"

#include <math.h>

static double steps_of(const Plan *plan, uint chains)
{
    return (double)((uint64_t)chains * plan->options->steps);
}

/* The work of a chain in a generation, with its part of the pool, and so many samples of path tracing and of
 * bidirectional path tracing per step. */
static double chain_work_with(const Plan *plan, double paths, double bidirectional)
{
    double steps = (double)plan->options->steps;
    const double samples[ESTIMATOR_COUNT] = {[ESTIMATOR_CHAINS] = steps,
                                             [ESTIMATOR_POOL] = plan->scheme->renews ? steps * plan->rates.pool : 0.0,
                                             [ESTIMATOR_PATHS] = steps * paths,
                                             [ESTIMATOR_BIDIRECTIONAL] = steps * bidirectional};
    return estimators_work(samples);
}

static double chain_work(const Plan *plan)
{
    return chain_work_with(plan, plan->rates.paths, plan->rates.bidirectional);
}

/* Chains that the remaining work is enough for, with their part of path tracing of both kinds. */
static double chains_left(const Plan *plan)
{
    return (double)(plan->total - plan->done) / chain_work(plan);
}

/* Whether `rate` samples per step of `chains` chains, and what is owed of before, are a whole sample of every pixel. */
static bool whole_sample(const Plan *plan, double owed, double chains, double rate)
{
    return rint(owed + chains * (double)plan->options->steps * rate / (double)plan->pixels) >= 1.0;
}

/* The same for the generations from `index` on, of which the first ones have path tracing at any rate: without it, if
 * what is left of it is no whole sample of every pixel, and without bidirectional path tracing in the same way. */
static double chains_left_from(const Plan *plan, uint index)
{
    const StepRates *rates = &plan->rates;
    double chains = chains_left(plan);
    bool paths = index < PATHS_FORCED || whole_sample(plan, plan->owed, chains, rates->paths),
         bidirectional = whole_sample(plan, plan->owed_bidirectional, chains, rates->bidirectional);
    return (double)(plan->total - plan->done) /
           chain_work_with(plan, paths ? rates->paths : 0.0, bidirectional ? rates->bidirectional : 0.0);
}

/* Chains that go with one sample of every pixel by path tracing, and one by bidirectional path tracing if it has any,
 * unless that exceeds a part of the work so far: generations without them show easy light badly. */
static uint chains_of_sample(const Plan *plan)
{
    const StepRates *rates = &plan->rates;
    double whole = (double)plan->pixels / (double)plan->options->steps, work = (double)plan->done / chain_work(plan);
    double paths = fmin(whole / rates->paths, WHOLE_SAMPLE_PART * work), bidirectional = 0.0;
    if (rates->bidirectional > 0.0)
        bidirectional = fmin(whole / rates->bidirectional, WHOLE_BIDIRECTIONAL_PART * work);
    return plan->options->chains_only ? 0 : (uint)fmin(fmax(paths, bidirectional), 0x1p26);
}

/* Plans the first generation, by the present rates. */
static void first_plan(Plan *plan)
{
    uint chains = plan->options->chains;
    uint64_t left = (uint64_t)ceil(chains_left(plan));
    if (plan->scheme->grows) {
        left = (left + 1) / 2;
        chains = chains < CHAINS_FIRST ? chains : CHAINS_FIRST;
    }
    plan->planned = chain_work(plan);
    plan->chains = left < chains ? (uint)left : chains;
}

void plan_init(Plan *plan, const ChainOptions *options, const MmltScheme *scheme, uint64_t pixels, uint64_t work)
{
    *plan = (Plan){.options = options,
                   .scheme = scheme,
                   .pixels = pixels,
                   .rates = {.pool = POOL_PER_STEP, .paths = options->chains_only ? PATHS_DIRECT : PATHS_FIRST},
                   .total = work > 0 ? work : UINT64_MAX / 2,
                   .bidirectional_most = HUGE_VAL,
                   .timed = work == 0};
    first_plan(plan);
}

void plan_rates_set(Plan *plan, StepRates rates)
{
    plan->rates = rates;
    first_plan(plan);
}

void plan_archive(Archive *archive, Plan *plan)
{
    step_rates_archive(archive, &plan->rates);
    ARCHIVE_FIELD(archive, plan->done);
    ARCHIVE_FIELD(archive, plan->last);
    archive_count(archive, &plan->chains, 1, plan->options->chains, "chains of a generation");
    ARCHIVE_FIELD(archive, plan->planned);
    archive_flags(archive, &plan->easy, 1, "whether path tracing may go on alone");
    archive_doubles(archive, &plan->alone, 1, (NumberRange){0.0, 0x1p32}, "samples of path tracing alone");
    archive_doubles(archive, &plan->alone_work, 1, (NumberRange){0.0, 0x1p80}, "the work of path tracing alone");
}

void plan_archive_bidirectional(Archive *archive, Plan *plan)
{
    step_rate_archive_bidirectional(archive, &plan->rates);
    archive_flags(archive, &plan->bidirectional_first, 1, "whether bidirectional path tracing comes first");
}

/* Raises the rate of bidirectional path tracing so that it has BIDIRECTIONAL_FIRST of the work. */
static void bidirectional_raise(Plan *plan)
{
    StepRates *rates = &plan->rates;
    const double others[ESTIMATOR_COUNT] = {
        [ESTIMATOR_CHAINS] = 1.0, [ESTIMATOR_POOL] = rates->pool, [ESTIMATOR_PATHS] = rates->paths};
    double least = BIDIRECTIONAL_FIRST / (1.0 - BIDIRECTIONAL_FIRST) * estimators_work(others) /
                   estimator_cost(ESTIMATOR_BIDIRECTIONAL);
    if (plan->bidirectional_first)
        rates->bidirectional = fmax(rates->bidirectional, least);
}

void plan_bidirectional_set(Plan *plan, bool first, bool better)
{
    plan->bidirectional_first = first;
    if (!better)
        plan->rates.bidirectional = 0.0;
    bidirectional_raise(plan);
}

void plan_learn(Plan *plan, uint index, Combination *combination)
{
    StepRates rates = combination_rates(combination);
    if (!(rates.paths > 0.0) || index % 2 == 0)
        return;
    plan->rates = rates;
    plan->rates.pool = fmax(rates.pool, POOL_PER_STEP);
    bidirectional_raise(plan);
    plan->easy = combination_alone_error(combination) < ALONE_ERROR;
}

void plan_count(Plan *plan, uint64_t work, double owed)
{
    plan->last = work;
    plan->done += work;
    plan->owed = owed;
    if (plan->alone > 0.0)
        plan->alone_work = fmax(plan->alone_work - (double)work, 0.0);
    else
        plan->alone_work = plan->easy ? plan->alone_work + ALONE_WORK * (double)work : 0.0;
}

/* The work of a sample of every pixel by bidirectional path tracing. */
static double bidirectional_work(const Plan *plan)
{
    return estimator_cost(ESTIMATOR_BIDIRECTIONAL) * (double)plan->pixels;
}

/* Such samples of the next generation. */
static double bidirectional_due(const Plan *plan)
{
    double samples = rint(plan->owed_bidirectional + plan_bidirectional_samples(plan, plan->chains));
    return plan->rates.bidirectional > 0.0 ? fmax(samples, plan->bidirectional_first ? 1.0 : 0.0) : 0.0;
}

/* The work of the next generation's chains with their part of the pool and of path tracing. */
static double next_chains_work(const Plan *plan)
{
    return chain_work_with(plan, plan->rates.paths, 0.0) * plan->chains;
}

/* The work of the next generation. */
static double next_work(const Plan *plan)
{
    return plan->alone > 0.0 ? estimator_cost(ESTIMATOR_PATHS) * plan->alone * (double)plan->pixels
                             : next_chains_work(plan) + bidirectional_due(plan) * bidirectional_work(plan);
}

/* Whole samples of every pixel that path tracing may make alone in each generation of a pair. */
static double alone_samples(const Plan *plan)
{
    double sample = estimator_cost(ESTIMATOR_PATHS) * (double)plan->pixels, left = (double)(plan->total - plan->done),
           most = fmax(GENERATION_PART * (double)plan->done, sample);
    return floor(fmin(most, 0.5 * fmin(plan->alone_work, left)) / sample);
}

/* How many times longer a generation of `next` chains takes than one of plan->chains, which with a limit of work does
 * not depend on the backend. Each takes as long as its chains and the backend's width together. */
static double growth(const Plan *plan, uint next)
{
    double width = plan->timed ? (double)plan->width : 0.0;
    return (width + (double)next) / (width + (double)plan->chains);
}

/* Twice as many chains if a generation may take that long; several times twice where it hardly takes longer.
 * after_alone: the latest generation was path tracing alone, which tells what work takes. */
static uint chains_grown(const Plan *plan, bool after_alone, double seconds, double elapsed)
{
    double part = plan->timed ? seconds / elapsed : (double)plan->last / (double)plan->done;
    if (after_alone)
        part *= chain_work(plan) * plan->chains / (double)plan->last;
    uint next = plan->chains;
    for (int i = 0; i < GROWTHS && next < plan->options->chains; ++i) {
        double longer = growth(plan, 2 * next);
        if (!(longer < GROWTH_FREE || (i == 0 && longer * part < GENERATION_PART)))
            break;
        next *= 2;
    }
    return next;
}

/* Fewer than `next` chains if the rates have changed so that these would do more work than before, and more than a path
 * tracing sample of every pixel may. */
static uint chains_limited(const Plan *plan, uint next)
{
    double most = fmax(plan->planned * (double)next, WHOLE_SAMPLE_PART * (double)plan->done);
    return (uint)fmax(fmin((double)next, most / chain_work(plan)), 1.0);
}

void plan_next(Plan *plan, uint index, double seconds, double elapsed)
{
    uint most = plan->options->chains, whole = chains_of_sample(plan), next = plan->chains;
    bool after_alone = plan->alone > 0.0;
    plan->bidirectional_most = HUGE_VAL;
    if (!plan->scheme->grows || plan->done >= plan->total)
        return;
    if (index % 2 == 0)
        plan->alone = alone_samples(plan);
    if (plan->alone > 0.0)
        return;
    if (index % 2 == 0) {
        next = chains_limited(plan, chains_grown(plan, after_alone, seconds, elapsed));
        next = next < whole ? whole : next;
    }
    plan->planned = chain_work(plan);
    next = next < most ? next : most;
    uint64_t left = (uint64_t)ceil(chains_left_from(plan, index));
    left = index % 2 == 0 ? (left + 1) / 2 : left;
    plan->chains = left < next ? (uint)left : next;
}

void plan_shorten(Plan *plan, double work)
{
    double each = fmax(0.5 * (work - (double)plan->done), 0.0);
    double sample = estimator_cost(ESTIMATOR_PATHS) * (double)plan->pixels;
    double least = fmax(ceil(each / chain_work(plan)), fmax((double)chains_of_sample(plan), 1.0));
    if (plan->alone > 0.0)
        plan->alone = fmax(fmin(plan->alone, ceil(each / sample)), 1.0);
    else if (plan->scheme->grows)
        plan->chains = (uint)fmin((double)plan->chains, least);
}

double plan_seconds(const Plan *plan, double seconds)
{
    return plan->last > 0 ? seconds * next_work(plan) / (double)plan->last : 0.0;
}

/* Fits path tracing alone into the time, unless no whole sample fits: then the generation has chains. */
static bool alone_fit(Plan *plan, double seconds, double left)
{
    double expected = plan_seconds(plan, seconds);
    if (plan->alone > 0.0 && left < expected)
        plan->alone = floor(plan->alone * left / expected);
    return plan->alone > 0.0;
}

/* Fits the next generation into `work`: whole samples by bidirectional path tracing first. */
static void chains_fit(Plan *plan, double work)
{
    double due = fmin(bidirectional_due(plan), floor(work / bidirectional_work(plan))),
           part = (work - due * bidirectional_work(plan)) / next_chains_work(plan);
    if (plan->rates.bidirectional > 0.0)
        plan->bidirectional_most = due;
    plan->chains = (uint)fmax(plan->chains * fmin(part, 1.0), 1.0);
}

bool plan_fit(Plan *plan, double seconds, double least, double left, double limit)
{
    if (left > 0.0 && alone_fit(plan, seconds, left))
        return true;
    double expected = plan_seconds(plan, seconds);
    if (left <= 0.0 || (plan->scheme->grows && (left < LAST_PART * expected || least > left + LATE_PART * limit)))
        return false;
    if (plan->scheme->grows && left < expected)
        chains_fit(plan, left / expected * next_work(plan));
    return true;
}

uint plan_chains(const Plan *plan)
{
    return plan->alone > 0.0 ? 0 : plan->chains;
}

uint plan_pool_samples(const Plan *plan, uint chains)
{
    double pixels = (double)plan->pixels, steps = steps_of(plan, chains),
           whole = rint(plan->rates.pool * steps / pixels);
    double wanted = whole >= 1.0 ? whole * pixels : plan->rates.pool * steps;
    if (plan->options->pool)
        wanted = (double)plan->options->pool;
    return (uint)fmin(fmax(wanted, 1.0), 0x1p30);
}

double plan_paths_samples(const Plan *plan, uint chains)
{
    double samples = plan->rates.paths * steps_of(plan, chains);
    if (plan->alone > 0.0)
        return plan->alone;
    if (plan->scheme->grows) {
        double left = (double)plan->total - (double)plan->done -
                      (double)chains * chain_work_with(plan, 0.0, plan->rates.bidirectional);
        samples = fmin(samples, fmax(left, 0.0) / estimator_cost(ESTIMATOR_PATHS));
    }
    return samples / (double)plan->pixels;
}

double plan_bidirectional_samples(const Plan *plan, uint chains)
{
    double left = (double)(plan->total - plan->done) / estimator_cost(ESTIMATOR_BIDIRECTIONAL),
           samples = fmin(plan->rates.bidirectional * steps_of(plan, chains), left) / (double)plan->pixels;
    return fmin(samples, plan->bidirectional_most - plan->owed_bidirectional);
}
