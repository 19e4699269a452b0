#include "mmlt/mmlt.h"

#include "base/timing.h"
#include "chain/chain.h"
#include "mmlt/tuning.h"
#include "render/layers.h"

#include <float.h>

static void options_complete(ChainOptions *options, const MmltScheme *scheme, uint max_depth)
{
    options->chains_only = options->chains_only || !scheme->combines || max_depth < CHAIN_DEPTH_MIN;
    options->chains = options->chains ? options->chains : scheme->chains;
    options->pool = options->pool ? options->pool : scheme->pool_per_chain * options->chains;
    options->steps = options->steps ? options->steps : STEPS_DEFAULT;
    options->mutations = options->mutations ? options->mutations : 7u;
    if (!(options->large_step > 0.0))
        options->large_step = scheme->large_step;
}

/* Sets what passes of chains and pools share. */
static void frame_complete(const Mmlt *mmlt, FrameParams *frame)
{
    frame->path.min_depth = CHAIN_DEPTH_MIN;
    frame->path.mis_exponent = 1;
    frame->chains.mutations = mmlt->options.mutations | (mmlt->options.ungrouped ? 0u : MUTATION_GROUPED);
    frame->chains.large_step = mmlt->scheme->large_step > 0.0 ? (float)mmlt->options.large_step : 0.0f;
    frame->chains.shifts = mmlt->options.shiftless ? 0.0f : mmlt->scheme->shifts;
    frame->chains.keep = 1;
}

/* Whether paths are long enough for chains. */
static bool chains_needed(const Mmlt *mmlt)
{
    return mmlt->run->frame.path.max_depth >= CHAIN_DEPTH_MIN;
}

static bool estimators_init(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    const RenderLayers *layers = run->options->layers;
    bool alone = mmlt->options.chains_only;
    const Guide *guide = &mmlt->guide.shown;
    if (layers && (layers->wanted & LAYER_BIT(LAYER_BY_DEPTH)) != 0 &&
        !film_depths_reserve(run->film, run->frame.path.max_depth, error))
        return false;
    if (!paths_estimator_init(&mmlt->paths, run, alone, guide, error))
        return false;
    frame_complete(mmlt, &run->frame);
    return pool_estimator_init(&mmlt->pool, run, alone, guide, error) &&
           chains_estimator_init(&mmlt->chains, run, alone, error) &&
           (!chains_needed(mmlt) ||
            (pool_estimator_list(&mmlt->pool, run, error) &&
             chains_estimator_list(&mmlt->chains, run, mmlt->options.steps, guide, mmlt->scheme->groups, error)));
}

bool mmlt_init(Mmlt *mmlt, RenderRun *run, Error *error)
{
    *mmlt = (Mmlt){.run = run, .options = run->options->chains, .scheme = mmlt_scheme(run->options->chains.paper)};
    options_complete(&mmlt->options, mmlt->scheme, run->frame.path.max_depth);
    mmlt_guide_init(&mmlt->guide, run->guide);
    plan_init(&mmlt->plan, &mmlt->options, mmlt->scheme, run->crop_pixels, run->options->samples);
    if (!estimators_init(mmlt, error))
        return false;
    for (int replica = 0; replica < REPLICAS && !mmlt->options.chains_only; ++replica) {
        if (!combination_init(&mmlt->combinations[replica], run->film, error))
            return false;
        mmlt->combinations[replica].shown = mmlt->options.shown;
    }
    mmlt->generation = generation_at(run, mmlt->scheme, 0);
    return true;
}

void mmlt_destroy(Mmlt *mmlt)
{
    chains_estimator_destroy(&mmlt->chains);
    pool_estimator_destroy(&mmlt->pool);
    paths_estimator_destroy(&mmlt->paths);
    for (int replica = 0; replica < REPLICAS; ++replica)
        combination_destroy(&mmlt->combinations[replica]);
}

/* ---- passes ------------------------------------------------------------------------------------------------------ */

/* The pools' clamping threshold, from the brightness of earlier pools. */
static void clamp_threshold_set(Mmlt *mmlt)
{
    Generation *generation = &mmlt->generation;
    generation->clamp_threshold = mmlt->options.chains_only
                                      ? FLT_MAX
                                      : (float)(CLAMP_FACTOR * pool_estimator_brightness(&mmlt->pool, generation));
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

static bool chains_follow(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    ChainStatistics *statistics = &mmlt->run->chains;
    double begin = timing_now();
    if (pool_due(mmlt) && !mmlt_seeds_run(mmlt, count, whole, error))
        return false;
    double seeded = timing_now();
    if (*whole && !chains_estimator_run(&mmlt->chains, &mmlt->generation, &mmlt->pool, count, !mmlt->scheme->renews,
                                        whole, error))
        return false;
    statistics->pool_seconds += seeded - begin;
    statistics->chain_seconds += timing_now() - seeded;
    return true;
}

/* Runs all passes of a generation. The first generation starts with path tracing, after the pilot that gives its
 * clamping threshold, so that a stop soon has something to show. Later ones end with path tracing, which needs the
 * target importance that is renewed before the pool. */
static bool generation_passes(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    const double paths = plan_paths_samples(&mmlt->plan, count);
    bool chains = chains_needed(mmlt), first = mmlt->generation.index == 0;
    if (first && ((chains && !mmlt_pilot_run(mmlt, count, whole, error)) ||
                  (*whole && !paths_estimator_run(&mmlt->paths, &mmlt->generation, paths, whole, error))))
        return false;
    if (chains && *whole && !chains_follow(mmlt, count, whole, error))
        return false;
    return first || !*whole || paths_estimator_run(&mmlt->paths, &mmlt->generation, paths, whole, error);
}

/* ---- a generation ------------------------------------------------------------------------------------------------ */

/* Joins the estimators' films in that of the chains. */
static bool films_combine(Mmlt *mmlt, Error *error)
{
    const Generation *generation = &mmlt->generation;
    const atomic_int *stop = render_run_stop(mmlt->run);
    Combination *own = &mmlt->combinations[generation->replica];
    Film *const films[ESTIMATOR_COUNT] = {[ESTIMATOR_CHAINS] = &mmlt->chains.own.film,
                                          [ESTIMATOR_POOL] = &mmlt->pool.own.film,
                                          [ESTIMATOR_PATHS] = &mmlt->paths.own.film};
    if (mmlt->options.chains_only) {
        mmlt->paths.own.film.light_samples = 0; /* it has direct light only, in `sums` */
        return film_merge(&mmlt->chains.own.film, &mmlt->paths.own.film, error);
    }
    mmlt_guide_count(&mmlt->guide, generation->replica, own, (double)mmlt->pool.own.film.light_samples);
    if (!combination_generation(own, &mmlt->combinations[generation->other], films, stop, error))
        return false;
    if (!*stop) /* the other replica is next, and learns from this one */
        plan_learn(&mmlt->plan, generation->index, own);
    return true;
}

/* Adds the generation to the picture and its layers. */
static bool generation_take(Mmlt *mmlt, Error *error)
{
    RenderLayers *layers = mmlt->run->options->layers;
    Film *film = &mmlt->chains.own.film;
    return films_combine(mmlt, error) && film_merge(mmlt->run->film, film, error) &&
           (!layers || render_layers_add(layers, film, mmlt->generation.index % 2, error));
}

/* The work of the generation that has run: its steps, its pool (if it had its own) and its path tracing. */
static uint64_t generation_work(const Mmlt *mmlt)
{
    double steps = (double)mmlt->chains.own.film.light_samples;
    bool chains = chains_needed(mmlt);
    const double samples[ESTIMATOR_COUNT] = {
        [ESTIMATOR_CHAINS] = chains ? steps : 0.0,
        [ESTIMATOR_POOL] = chains && steps > 0.0 && pool_due(mmlt) ? (double)mmlt->pool.own.film.light_samples : 0.0,
        [ESTIMATOR_PATHS] = (double)mmlt->paths.own.film.light_samples};
    double work = estimators_work(samples);
    return work > 1.0 ? (uint64_t)work : 1;
}

static void generation_count(Mmlt *mmlt, uint count, uint64_t work)
{
    const Generation *generation = &mmlt->generation;
    pool_estimator_count(&mmlt->pool, generation);
    if (chains_needed(mmlt) && chains_estimator_alive(&mmlt->chains, generation))
        chains_estimator_count(&mmlt->chains, generation, &mmlt->pool, count);
    plan_count(&mmlt->plan, work);
    mmlt->run->done = mmlt->plan.done;
}

/* A first generation that was stopped: its finished path tracing samples go to the image. */
static bool stopped_take(Mmlt *mmlt, Error *error)
{
    paths_estimator_alone(&mmlt->paths);
    mmlt->run->done = mmlt->paths.delivered;
    return film_merge(mmlt->run->film, &mmlt->paths.own.film, error);
}

bool mmlt_generation_run(Mmlt *mmlt, uint count, Error *error)
{
    bool whole = true;
    mmlt_guide_show(&mmlt->guide, mmlt->generation.replica);
    clamp_threshold_set(mmlt);
    film_clear(&mmlt->chains.own.film);
    if (!generation_passes(mmlt, count, &whole, error))
        return false;
    if (whole) {
        mmlt->chains.own.film.light_samples = (uint64_t)count * mmlt->options.steps;
        uint64_t work = generation_work(mmlt);
        if (!generation_take(mmlt, error))
            return false;
        generation_count(mmlt, count, work);
    } else if (mmlt->generation.index == 0 && !stopped_take(mmlt, error)) {
        return false;
    }
    mmlt->generation = generation_at(mmlt->run, mmlt->scheme, mmlt->generation.index + 1);
    return true;
}
