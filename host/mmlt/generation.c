/* A generation: a pool, the chains that start from it, path tracing, and their combination. */
#include "mmlt/mmlt.h"

#include "base/timing.h"
#include "render/layers.h"

#include "chain/chain.h"
#include "mmlt/tuning.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Keeps the chains' words for --dump-bad, before the pass overwrites them with their final states. */
static bool begun_keep(Mmlt *mmlt, uint count, Error *error)
{
    size_t bytes = (size_t)count * mmlt->chains.pass_fields * sizeof *mmlt->begun;
    free(mmlt->begun);
    mmlt->begun = malloc(bytes);
    if (!mmlt->begun)
        return error_memory(error, bytes, "where chains began");
    memcpy(mmlt->begun, mmlt->chains.pass_words, bytes);
    return true;
}

static bool chains_run(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams frame = mmlt_chain_frame(mmlt);
    uint64_t delivered = 0;
    if (!(mmlt_population(mmlt)->brightness > 0.0))
        return true; /* a black pool: the chains' expected contribution is zero, too */
    frame.pass.item_count = count;
    if (run->options->bad_chains && !begun_keep(mmlt, count, error))
        return false;
    SplatSink sink = render_run_sink(&mmlt->film);
    sink.whole = true;
    bool done =
        run->interface->run(run->backend, &frame, &mmlt->chains, &sink, render_run_stop(run), &delivered, error);
    *whole = delivered == count;
    if (!mmlt->scheme->renews) /* the next pass continues them from their coordinates */
        for (uint i = 0; i < count; ++i)
            mmlt->chains.pass_words[(size_t)CHAIN_PASS_ITEM * count + i] = NONE;
    return done;
}

/* Statistics of a finished pass of chains. */
static void chains_count(Mmlt *mmlt, uint count)
{
    const uint *words = mmlt->chains.pass_words;
    uint replica = (uint)mmlt_replica(mmlt, mmlt->generation);
    chain_statistics_pass(&mmlt->run->chains, words, count, mmlt->options.steps);
    chain_groups_add(&mmlt->groups, words, count, replica, mmlt->scheme->groups);
}

/* ---- path tracing ------------------------------------------------------------------------------------------------ */

/* Path tracing that accompanies `steps` steps of chains: whole samples of all pixels. In the first two generations of
 * either replica generation g ends with at least g + 1 of them, so that their variances become known. */
static bool paths_run(Mmlt *mmlt, uint64_t steps, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams *frame = &mmlt->paths_frame;
    double begin = timing_now();
    mmlt->paths_wanted += mmlt->paths_per_step * (double)steps / (double)run->crop_pixels;
    uint64_t target = (uint64_t)mmlt->paths_wanted, first = (uint64_t)mmlt->generation + 1;
    if (mmlt->generation < 2 * REPLICAS && target < first)
        target = first;
    film_clear(&mmlt->paths_film);
    mmlt->paths_delivered = 0;
    const SplatSink sink = render_run_sink(&mmlt->paths_film);
    mmlt_generation_frame(mmlt, frame);
    mmlt_film_params(&frame->film, &mmlt->paths_film);
    uint64_t items = target > mmlt->paths_done ? (target - mmlt->paths_done) * run->crop_pixels : 0;
    for (uint64_t next = 0; next < items && *whole; next += frame->pass.item_count) {
        uint64_t delivered = 0, left = items - next;
        frame->pass.sample_index = run->options->first_sample + (uint)(mmlt->paths_done + next / run->crop_pixels);
        frame->pass.first_item = (uint)(next % run->crop_pixels);
        frame->pass.item_count = left < PATHS_MAX ? (uint)left : PATHS_MAX;
        if (!run->interface->run(run->backend, frame, &mmlt->paths, &sink, render_run_stop(run), &delivered, error))
            return false;
        mmlt->paths_delivered += delivered;
        *whole = delivered == frame->pass.item_count;
    }
    mmlt->paths_done = target > mmlt->paths_done ? target : mmlt->paths_done;
    mmlt->paths_film.light_samples = items;
    run->chains.direct_seconds += timing_now() - begin;
    return true;
}

/* ---- all of it --------------------------------------------------------------------------------------------------- */

/* The next generation's plan, from what the replica that has just run knows: the other replica is next. */
static void plan_renew(Mmlt *mmlt, const Combination *combination)
{
    Plan plan = combination_plan(combination);
    if (plan.paths_per_step > 0.0) {
        mmlt->paths_per_step = plan.paths_per_step;
        mmlt->pool_per_step = fmax(plan.pool_per_step, POOL_PER_STEP);
    }
}

/* Adds the generation to the picture and its layers. */
static bool generation_take(Mmlt *mmlt, Error *error)
{
    RenderLayers *layers = mmlt->run->options->layers;
    Film *const estimators[ESTIMATOR_COUNT] = {
        [ESTIMATOR_CHAINS] = &mmlt->film, [ESTIMATOR_POOL] = &mmlt->pool_film, [ESTIMATOR_PATHS] = &mmlt->paths_film};
    if (mmlt->options.chains_only) {
        mmlt->paths_film.light_samples = 0; /* it has direct light only, in `sums` */
        if (!film_merge(&mmlt->film, &mmlt->paths_film, error))
            return false;
    } else {
        int replica = mmlt_replica(mmlt, mmlt->generation);
        const atomic_int *stop = render_run_stop(mmlt->run);
        mmlt_visits_count(mmlt);
        if (!combination_generation(&mmlt->combinations[replica], &mmlt->combinations[1 - replica], estimators, stop,
                                    error))
            return false;
        if (!*stop)
            plan_renew(mmlt, &mmlt->combinations[replica]);
    }
    return film_merge(mmlt->run->film, &mmlt->film, error) &&
           (!layers || render_layers_add(layers, &mmlt->film, mmlt->generation % 2, error));
}

static bool chains_follow(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    double begin = timing_now();
    bool anew = mmlt->scheme->renews || mmlt->generation == 0;
    if (anew && !mmlt_seeds_run(mmlt, count, whole, error))
        return false;
    double seeded = timing_now();
    if (*whole && !chains_run(mmlt, count, whole, error))
        return false;
    run->chains.pool_seconds += seeded - begin;
    run->chains.chain_seconds += timing_now() - seeded;
    return true;
}

/* The work of the generation that has run: its steps, its pool (if it had its own) and its path tracing. */
static uint64_t generation_work(const Mmlt *mmlt, uint64_t steps)
{
    bool pool = steps > 0 && (mmlt->scheme->renews || mmlt->generation == 0);
    const double samples[ESTIMATOR_COUNT] = {[ESTIMATOR_CHAINS] = (double)steps,
                                             [ESTIMATOR_POOL] = pool ? (double)mmlt->pool_film.light_samples : 0.0,
                                             [ESTIMATOR_PATHS] = (double)mmlt->paths_film.light_samples};
    double work = combination_work(samples);
    return work > 1.0 ? (uint64_t)work : 1;
}

/* Runs all passes of a generation. The first generation starts with path tracing, after the pilot that gives its
 * clamping threshold, so that a stop soon has something to show. Later ones end with path tracing, which needs the
 * target importance that is renewed before the pool. */
static bool generation_passes(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    uint64_t steps = (uint64_t)count * mmlt->options.steps;
    bool chains = mmlt->run->frame.path.max_depth >= CHAIN_DEPTH_MIN, first = mmlt->generation == 0;
    if (first &&
        ((chains && !mmlt_pilot_run(mmlt, count, whole, error)) || (*whole && !paths_run(mmlt, steps, whole, error))))
        return false;
    if (chains && *whole && !chains_follow(mmlt, count, whole, error))
        return false;
    return first || !*whole || paths_run(mmlt, steps, whole, error);
}

/* A first generation that was stopped: its finished path tracing samples go to the film as samples of their pixels.
 * Light above the clamping threshold, which chains would have shown, is missing. */
static bool stopped_take(Mmlt *mmlt, Error *error)
{
    Film *film = &mmlt->paths_film;
    for (size_t i = 0; i < 3 * film_pixels(film); ++i) {
        film->sums[i] =
            film_sum_rounded((double)film_sum_shown(film->sums[i]) + (double)film_sum_shown(film->light_sums[i]));
        film->light_sums[i] = 0;
    }
    film->light_samples = 0;
    mmlt->run->done = mmlt->paths_delivered;
    return film_merge(mmlt->run->film, film, error);
}

static void generation_count(Mmlt *mmlt, uint count, uint64_t work)
{
    mmlt->brightness_sum[mmlt_replica(mmlt, mmlt->generation)] += mmlt->brightness;
    if (mmlt->run->frame.path.max_depth >= CHAIN_DEPTH_MIN && mmlt_population(mmlt)->brightness > 0.0) {
        chains_count(mmlt, count);
        mmlt_bad_chains_write(mmlt, count);
    }
    mmlt->work_last = work;
    mmlt->run->done = mmlt->work_done += work;
}

bool mmlt_generation_run(Mmlt *mmlt, uint count, Error *error)
{
    uint64_t steps = (uint64_t)count * mmlt->options.steps;
    bool whole = true;
    film_clear(&mmlt->film);
    if (!generation_passes(mmlt, count, &whole, error))
        return false;
    if (whole) {
        mmlt->film.light_samples = steps;
        uint64_t work = generation_work(mmlt, mmlt->run->frame.path.max_depth >= CHAIN_DEPTH_MIN ? steps : 0);
        if (!generation_take(mmlt, error))
            return false;
        generation_count(mmlt, count, work);
    } else if (mmlt->generation == 0 && !stopped_take(mmlt, error)) {
        return false;
    }
    ++mmlt->generation;
    return true;
}
