/* Multiplexed Metropolis light transport (Hachisuka, Kaplanyan and Dachsbacher 2014; Frolov 2018): paths of one and two
 * segments by path tracing, longer ones by Markov chains.
 *
 * Rendering proceeds in generations: a pool of independent bidirectional samples, chains that start from samples drawn
 * in proportion to their contribution weights, and a number of steps of each. A generation's chains have the right mean
 * whatever their number and length, for chains that start with density proportional to f keep it (sampling-importance
 * resampling, Rubin 1987). Sizes, weights, clamping thresholds and target importance follow from earlier generations,
 * and the picture is a ratio of sums over all of them: it is consistent, not unbiased. */
#include "mmlt/mmlt_archive.h"

#include "base/timing.h"
#include "mmlt/tuning.h"
#include "render/error_watch.h"
#include "render/integrator.h"
#include "render/layers.h"
#include "render/shard.h"

#include <math.h>

/* Number of bits in BD_LIGHT_DELTA. */
#define MMLT_DEPTH_LIMIT 31

/* Whether another generation follows, of the planned size or of one that fits into the time that is left. */
static bool generation_follows(Mmlt *mmlt)
{
    const RenderRun *run = mmlt->run;
    double limit = run->options->seconds, left = limit - (timing_now() - run->start);
    if (*render_run_stop(run) || error_watch_reached(run))
        return false;
    return !(limit > 0.0) || plan_fit(&mmlt->plan, mmlt->seconds, mmlt_least_seconds(mmlt), left, limit);
}

static void weights_tell(const Mmlt *mmlt)
{
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        mmlt->run->chains.weights[s] = mmlt->combinations[0].weight[s];
}

/* Looks at the error after as many generations of one replica as of the other, and enough for both to know variances.
 * The next two are no longer than what reaches the goal. */
static bool look_if_due(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    if (mmlt->generation.index < PATHS_FORCED || mmlt->generation.index % REPLICAS != 0)
        return true;
    if (error_watch_due(run) && !error_watch_look(run, error))
        return false;
    plan_shorten(&mmlt->plan, error_watch_target(run));
    return true;
}

/* Runs a generation and plans the next one. */
static bool generation_next(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    Plan *plan = &mmlt->plan;
    double begin = timing_now();
    if (!mmlt_generation_run(mmlt, plan_chains(plan), error) ||
        !render_layers_sample(run, mmlt->paths.done * run->crop_pixels, error))
        return false;
    mmlt->seconds = timing_now() - begin;
    weights_tell(mmlt);
    render_run_expect(run, 0.0);
    run->pass_last = false;
    render_run_report(run, plan->timed ? 0.0 : (double)plan->done / (double)plan->total);
    if (!mmlt->whole)
        return true;
    plan_next(plan, mmlt->generation.index, mmlt->seconds, render_run_seconds(run));
    return look_if_due(mmlt, error) && mmlt_keep(mmlt, error);
}

static bool generations_run(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    const Plan *plan = &mmlt->plan;
    while (plan->done < plan->total) {
        if (!generation_next(mmlt, error))
            return false;
        if (!generation_follows(mmlt))
            break;
        render_run_save_if_due(run);
        checkpoint_save_if_due(run, mmlt_state(mmlt));
    }
    return true;
}

/* Goes on from a checkpoint, if one is resumed; false in *follows if there is nothing left to do. */
static bool generations_resume(Mmlt *mmlt, bool *follows, Error *error)
{
    RenderRun *run = mmlt->run;
    *follows = true;
    if (!run->resumed)
        return true;
    if (!checkpoint_restore(run, mmlt_state(mmlt), error) || !mmlt_keep(mmlt, error) ||
        !render_layers_sample(run, mmlt->paths.done * run->crop_pixels, error))
        return false;
    *follows = generation_follows(mmlt);
    return true;
}

/* In proportion to what the rendering takes. */
static unsigned mmlt_photons(const RenderOptions *options, uint64_t pixels)
{
    double count = PHOTONS_MOST_ALLOWED;
    if (options->seconds > 0.0)
        count = fmin(count, MMLT_PHOTONS_PER_SECOND * options->seconds);
    if (options->samples > 0)
        count = fmin(count, MMLT_PHOTONS_PER_SAMPLE * (double)shard_work(options, pixels));
    return (unsigned)fmax(count, MMLT_PHOTONS_MIN);
}

/* What depends on the backend; none of it changes the image of a number of samples. */
static void backend_adopt(Mmlt *mmlt)
{
    BackendStatistics statistics;
    mmlt->run->interface->statistics(mmlt->run->backend, &statistics);
    mmlt->plan.width = statistics.width;
    for (int replica = 0; replica < REPLICAS; ++replica)
        mmlt->combinations[replica].threads = statistics.threads;
}

static bool mmlt_render(RenderRun *run, Error *error)
{
    Mmlt mmlt;
    bool follows, done = mmlt_init(&mmlt, run, error);
    backend_adopt(&mmlt);
    done = done && mmlt_pilot_adopt(&mmlt, error) && generations_resume(&mmlt, &follows, error) &&
           (!follows || generations_run(&mmlt, error)) && checkpoint_end(run, mmlt_state(&mmlt), error);
    weights_tell(&mmlt);
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth)
        run->chains.r_hat[depth] = chain_groups_r_hat(&mmlt.chains.groups, depth);
    mmlt_destroy(&mmlt);
    return done;
}

const Integrator *integrator_mmlt(void)
{
    static const Integrator integrator = {.name = "mmlt",
                                          .summary = "multiplexed Metropolis light transport",
                                          .depth_limit = MMLT_DEPTH_LIMIT,
                                          .strategies = STRATEGIES_BDPT,
                                          .guides = true,
                                          .photons = true,
                                          .photons_default = mmlt_photons,
                                          .render = mmlt_render};
    return &integrator;
}
