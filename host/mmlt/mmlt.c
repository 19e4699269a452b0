#include "mmlt/mmlt.h"

#include "base/timing.h"
#include "mmlt/tuning.h"
#include "render/layers.h"

#include <float.h>
#include <math.h>

/* Whether the generation has chains, and is not path tracing alone. */
static bool chains_due(const Mmlt *mmlt)
{
    return mmlt_chains_needed(mmlt) && plan_chains(&mmlt->plan) > 0;
}

/* Whether the generation is path tracing alone, with nothing to combine it with or to learn from. */
static bool complete_due(const Mmlt *mmlt)
{
    return mmlt->paths.completes && mmlt_chains_needed(mmlt) && !chains_due(mmlt);
}

/* ---- passes ------------------------------------------------------------------------------------------------------ */

/* The pools' clamping threshold, from the brightness of earlier pools. */
static void clamp_threshold_set(Mmlt *mmlt)
{
    Generation *generation = &mmlt->generation;
    generation->clamp_threshold =
        mmlt->options.chains_only
            ? FLT_MAX
            : (float)fmin(CLAMP_FACTOR * pool_estimator_brightness(&mmlt->pool, generation), (double)FLT_MAX);
}

bool mmlt_pilot_run(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    bool done = mmlt->options.chains_only || pool_estimator_pilot(&mmlt->pool, &mmlt->generation,
                                                                  plan_pool_samples(&mmlt->plan, count), whole, error);
    clamp_threshold_set(mmlt);
    return done;
}

bool mmlt_seeds_run(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    const Generation *generation = &mmlt->generation;
    const double samples[ESTIMATOR_COUNT] = {1.0, mmlt->plan.rates.pool, mmlt->plan.rates.paths};
    float change[IMPORTANCE_CELLS];
    bool changed = !mmlt->options.chains_only && mmlt_guide_due(generation);
    if (changed) {
        if (!mmlt_guide_renew(&mmlt->guide, generation, &mmlt->combinations[generation->other], samples, change, error))
            return false;
        pool_estimator_restart(&mmlt->pool, generation);
    }
    return pool_estimator_run(&mmlt->pool, generation, plan_pool_samples(&mmlt->plan, count), whole, error) &&
           (!*whole || chains_estimator_start(&mmlt->chains, generation, &mmlt->pool, changed ? change : NULL,
                                              mmlt->options.order, count, error));
}

/* Whether the generation draws a pool, from which chains start. */
static bool pool_due(const Mmlt *mmlt)
{
    return mmlt->scheme->renews || mmlt->generation.index == 0;
}

/* Tells how long the generation still takes after an estimator has run: by what was expected in the first half of its
 * work, then by the time that the work so far took. */
static void estimator_tell(Mmlt *mmlt, EstimatorKind kind)
{
    double taken = timing_now() - mmlt->begun, left = mmlt->expected - taken;
    mmlt->work += estimator_cost(kind) * mmlt->samples[kind];
    double rest = fmax(estimators_work(mmlt->samples) - mmlt->work, 0.0);
    if ((rest < mmlt->work || !(left > 0.0)) && mmlt->work > 0.0)
        left = taken * rest / mmlt->work;
    render_run_expect(mmlt->run, left);
    render_run_tell(mmlt->run);
}

/* Takes what an estimator has left in the film, which is then empty, into the generation's image. Without a combination
 * all estimators stay in the film. */
static void estimator_take(Mmlt *mmlt, EstimatorKind kind)
{
    if (!mmlt->options.chains_only)
        combined_image_take(&mmlt->combined, kind, &mmlt->film);
    estimator_tell(mmlt, kind);
}

static bool chains_follow(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    ChainStatistics *statistics = &mmlt->run->chains;
    double begin = timing_now();
    if (pool_due(mmlt) && !mmlt_seeds_run(mmlt, count, whole, error))
        return false;
    double seeded = timing_now();
    if (*whole && pool_due(mmlt))
        estimator_take(mmlt, ESTIMATOR_POOL);
    double begun = timing_now();
    if (*whole && !chains_estimator_run(&mmlt->chains, &mmlt->generation, &mmlt->pool, count, !mmlt->scheme->renews,
                                        whole, error))
        return false;
    statistics->pool_seconds += seeded - begin;
    statistics->chain_seconds += timing_now() - begun;
    if (*whole)
        estimator_take(mmlt, ESTIMATOR_CHAINS);
    return true;
}

/* The first generation begins with path tracing, after the pilot that gives its clamping threshold, so that there is
 * soon something to save, or to show after a stop: path tracing alone is in the image until the generation ends. */
static bool first_paths_run(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    Film *film = &mmlt->film, *image = mmlt->run->film;
    if ((mmlt_chains_needed(mmlt) && !mmlt_pilot_run(mmlt, count, whole, error)) ||
        (*whole && !paths_estimator_run(&mmlt->paths, &mmlt->generation, false, whole, error)))
        return false;
    mmlt->run->done = mmlt->paths.delivered;
    if (!*whole)
        paths_estimator_alone(&mmlt->paths);
    film->light_samples = *whole && !mmlt->options.chains_only ? mmlt->paths.own.samples : 0;
    if (!film_merge(image, film, error))
        return false;
    if (!*whole)
        return true;
    if (!render_layers_sample(mmlt->run, mmlt->paths.own.samples, error))
        return false;
    render_run_report(mmlt->run, mmlt->plan.timed ? 0.0 : (double)mmlt->run->done / (double)mmlt->plan.total);
    render_run_save_if_due(mmlt->run);
    estimator_take(mmlt, ESTIMATOR_PATHS);
    return true;
}

static bool bidirectional_follows(Mmlt *mmlt, bool *whole, Error *error)
{
    if (!(mmlt->samples[ESTIMATOR_BIDIRECTIONAL] > 0.0))
        return true;
    if (!bidirectional_estimator_run(&mmlt->bidirectional, &mmlt->generation, whole, error))
        return false;
    if (*whole)
        estimator_take(mmlt, ESTIMATOR_BIDIRECTIONAL);
    return true;
}

/* Runs all passes of a generation. Later generations end with path tracing, which needs the target importance that is
 * renewed before the pool. */
static bool generation_passes(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    bool first = mmlt->generation.index == 0;
    if (first && !first_paths_run(mmlt, count, whole, error))
        return false;
    if (chains_due(mmlt) && *whole && !chains_follow(mmlt, count, whole, error))
        return false;
    if (*whole && !bidirectional_follows(mmlt, whole, error))
        return false;
    return first || !*whole || paths_estimator_run(&mmlt->paths, &mmlt->generation, complete_due(mmlt), whole, error);
}

/* ---- a generation ------------------------------------------------------------------------------------------------ */

static void bidirectional_begin(Mmlt *mmlt)
{
    bidirectional_estimator_begin(&mmlt->bidirectional, &mmlt->plan, mmlt->run,
                                  mmlt->paths.seconds / (double)mmlt->paths.fresh);
    plan_bidirectional_set(&mmlt->plan, mmlt->generation.index < mmlt->bidirectional.whole.forced_end, false);
}

/* Sets the samples of each estimator in a generation of `count` chains: its steps, its pool (if it has its own) and its
 * path tracing of both kinds. */
static void generation_samples(Mmlt *mmlt, uint count)
{
    bool chains = chains_due(mmlt), known = mmlt->combinations[0].ready[ESTIMATOR_BIDIRECTIONAL] &&
                                            mmlt->combinations[1].ready[ESTIMATOR_BIDIRECTIONAL];
    double *samples = mmlt->samples;
    if (mmlt->generation.index == 1 && mmlt->paths.fresh > 0)
        bidirectional_begin(mmlt);
    samples[ESTIMATOR_BIDIRECTIONAL] =
        bidirectional_estimator_plan(&mmlt->bidirectional, &mmlt->generation, &mmlt->plan, chains ? count : 0, known);
    mmlt->paths.beside = mmlt->bidirectional.whole.fresh;
    paths_estimator_plan(&mmlt->paths, &mmlt->generation, plan_paths_samples(&mmlt->plan, count));
    mmlt->chains.own.samples = (uint64_t)count * mmlt->options.steps; /* also if no path is long enough for any */
    samples[ESTIMATOR_CHAINS] = chains ? (double)mmlt->chains.own.samples : 0.0;
    samples[ESTIMATOR_POOL] = chains && pool_due(mmlt) ? (double)plan_pool_samples(&mmlt->plan, count) : 0.0;
    samples[ESTIMATOR_PATHS] = (double)mmlt->paths.own.samples;
    for (int replica = 0; replica < REPLICAS; ++replica)
        mmlt->combinations[replica].bidirectional_trial = mmlt->bidirectional.trial > 0;
}

/* Tells how long the generation will take, which begins now. */
static void generation_tell(Mmlt *mmlt)
{
    const Plan *plan = &mmlt->plan;
    mmlt->begun = timing_now();
    mmlt->expected = plan_seconds(plan, mmlt->seconds);
    mmlt->work = 0.0;
    mmlt->run->pass_last = !plan->timed && (double)plan->done + estimators_work(mmlt->samples) >= (double)plan->total;
    render_run_expect(mmlt->run, mmlt->expected);
    render_run_tell(mmlt->run);
}

static void generation_begin(Mmlt *mmlt)
{
    const Generation *generation = &mmlt->generation;
    generation_tell(mmlt);
    mmlt_guide_show(&mmlt->guide, generation->replica);
    clamp_threshold_set(mmlt);
    film_clear(&mmlt->film);
    PathsChange *change = &mmlt->changes[generation->replica];
    mmlt->combined.change = change->values && generation->index < PATHS_REPLACED ? change : NULL;
    if (!mmlt->options.chains_only && !complete_due(mmlt))
        combined_image_begin(&mmlt->combined, &mmlt->combinations[generation->replica],
                             &mmlt->combinations[generation->other], mmlt->samples);
}

/* Whether the next generation has bidirectional path tracing. */
static void bidirectional_adopt(Mmlt *mmlt)
{
    const Combination *replicas = mmlt->combinations;
    plan_bidirectional_set(&mmlt->plan, mmlt->generation.index + 1 < mmlt->bidirectional.whole.forced_end,
                           replicas[0].bidirectional_better && replicas[1].bidirectional_better);
}

/* Makes one film of the estimators: mmlt->film. Whether variances have been learnt from them. */
static bool films_combine(Mmlt *mmlt)
{
    const Generation *generation = &mmlt->generation;
    Combination *own = &mmlt->combinations[generation->replica];
    if (generation->index == 0) /* its direct light has been in the image until now */
        film_swap_own(&mmlt->film, mmlt->run->film);
    else
        combined_image_add(&mmlt->combined, ESTIMATOR_PATHS, &mmlt->film);
    combined_image_finish(&mmlt->combined, &mmlt->film);
    /* Without chains, what is known of path tracing tells nothing new of the others. */
    if (mmlt_chains_needed(mmlt) && !chains_due(mmlt))
        return false;
    mmlt_guide_count(&mmlt->guide, generation->replica, own, (double)mmlt->pool.own.samples);
    if (*render_run_stop(mmlt->run) && !mmlt->run->checkpoint) /* no generation follows */
        return false;
    combination_variances_update(own, &mmlt->combinations[generation->other]);
    plan_learn(&mmlt->plan, generation->index, own); /* the other replica is next, and learns from this one */
    bidirectional_adopt(mmlt);
    return true;
}

/* Where the generation tells that light is easy enough, path tracing alone is shown in the first generations of the
 * other replica, whose weights were not those of known variances. What is shown must not be chosen by its own
 * errors: light that it has missed would make it look good. learnt: otherwise what is known comes from the other
 * replica itself. */
static void first_paths_show(Mmlt *mmlt, bool learnt)
{
    PathsChange *change = &mmlt->changes[mmlt->generation.other];
    if (learnt && change->values &&
        combination_alone_error(&mmlt->combinations[mmlt->generation.replica]) < ALONE_ERROR_FIRST) {
        film_light_add(mmlt->run->film, change->values, change->samples);
        paths_change_forget(change);
    }
    if (mmlt->generation.index + 1 >= PATHS_KEPT)
        mmlt_changes_forget(mmlt);
}

/* Adds the generation to the picture and its layers. */
static bool generation_take(Mmlt *mmlt, Error *error)
{
    RenderLayers *layers = mmlt->run->options->layers;
    Film *film = &mmlt->film;
    bool learnt = false;
    if (mmlt->options.chains_only)
        film->light_samples = mmlt->chains.own.samples;
    else if (!complete_due(mmlt))
        learnt = films_combine(mmlt);
    if (mmlt->generation.index == 0)
        film_clear(mmlt->run->film);
    if (!film_merge(mmlt->run->film, film, error) ||
        (layers && !render_layers_add(layers, film, mmlt->generation.index % 2, error)))
        return false;
    first_paths_show(mmlt, learnt);
    return true;
}

static void generation_count(Mmlt *mmlt, uint count, uint64_t work)
{
    const Generation *generation = &mmlt->generation;
    if (count > 0)
        pool_estimator_count(&mmlt->pool, generation);
    if (chains_due(mmlt) && chains_estimator_alive(&mmlt->chains, generation))
        chains_estimator_count(&mmlt->chains, generation, &mmlt->pool, count);
    mmlt->plan.owed_bidirectional = paths_estimator_owed(&mmlt->bidirectional.whole);
    plan_count(&mmlt->plan, work, paths_estimator_owed(&mmlt->paths));
    mmlt->run->done = mmlt->plan.done;
}

bool mmlt_generation_run(Mmlt *mmlt, uint count, Error *error)
{
    bool whole = true;
    generation_samples(mmlt, count);
    generation_begin(mmlt);
    if (!generation_passes(mmlt, count, &whole, error))
        return false;
    if (whole) {
        double work = fmax(estimators_work(mmlt->samples), 1.0);
        if (!generation_take(mmlt, error))
            return false;
        generation_count(mmlt, count, (uint64_t)work);
    }
    mmlt->whole = whole;
    mmlt->generation = generation_at(mmlt->run, mmlt->scheme, mmlt->generation.index + 1);
    return true;
}

double mmlt_least_seconds(const Mmlt *mmlt)
{
    const PathsEstimator *paths = &mmlt->paths;
    double due = (double)paths_estimator_due(paths, &mmlt->generation, 0.0);
    return paths->fresh > 0 ? paths->seconds * due / (double)paths->fresh : 0.0;
}
