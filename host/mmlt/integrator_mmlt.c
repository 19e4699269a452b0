/* Multiplexed Metropolis light transport (Hachisuka, Kaplanyan and Dachsbacher 2014; Frolov 2018): paths of one and two
 * segments by path tracing, longer ones by Markov chains.
 *
 * Rendering proceeds in generations: a pool of independent bidirectional samples, chains that start from samples drawn
 * in proportion to their contribution weights, and a number of steps of each. A generation's chains have the right mean
 * whatever their number and length, for chains that start with density proportional to f keep it (sampling-importance
 * resampling, Rubin 1987). Sizes, weights, clamping thresholds and target importance follow from earlier generations,
 * and the picture is a ratio of sums over all of them: it is consistent, not unbiased. */
#include "mmlt/mmlt.h"

#include "backend/step_recorder.h"
#include "base/timing.h"
#include "mmlt/tuning.h"
#include "render/bd_fields.h"
#include "render/layers.h"

#include <math.h>
#include <stdlib.h>

/* Number of bits in BD_LIGHT_DELTA. */
#define MMLT_DEPTH_LIMIT 31

/* ---- all of them ------------------------------------------------------------------------------------------------- */

/* The work of a chain in a generation, with its part of the pool and of path tracing. */
static double chain_work(const Mmlt *mmlt)
{
    double steps = (double)mmlt->options.steps;
    const double samples[ESTIMATOR_COUNT] = {[ESTIMATOR_CHAINS] = steps,
                                             [ESTIMATOR_POOL] =
                                                 mmlt->scheme->renews ? steps * mmlt->pool_per_step : 0.0,
                                             [ESTIMATOR_PATHS] = steps * mmlt->paths_per_step};
    return combination_work(samples);
}

/* How many chains the remaining work is enough for, rounded up. */
static uint64_t chains_left(const Mmlt *mmlt, uint64_t total)
{
    return (uint64_t)ceil((double)(total - mmlt->work_done) / chain_work(mmlt));
}

/* Chains that go with one path tracing sample of every pixel, unless that exceeds WHOLE_SAMPLE_PART of the work so far:
 * generations without path tracing show easy light badly. */
static uint chains_of_sample(const Mmlt *mmlt)
{
    double whole = (double)mmlt->run->crop_pixels / (mmlt->paths_per_step * (double)mmlt->options.steps);
    double most = WHOLE_SAMPLE_PART * (double)mmlt->work_done / chain_work(mmlt);
    return mmlt->options.chains_only ? 0 : (uint)fmin(fmin(whole, most), 0x1p26);
}

/* Chains in the next generation. Two generations, one for each replica, have the same size. With --samples the sizes
 * depend on that number alone, so that the image does not depend on the clock. */
static uint chains_next(const Mmlt *mmlt, uint chains, double seconds, uint64_t total)
{
    const RenderOptions *options = mmlt->run->options;
    double elapsed = timing_now() - mmlt->run->start;
    bool grow = options->samples > 0 ? 2.0 * (double)mmlt->work_last < GENERATION_PART * (double)mmlt->work_done
                                     : 2.0 * seconds < GENERATION_PART * elapsed;
    uint next = chains, whole = chains_of_sample(mmlt);
    if (mmlt->generation % 2 == 0) {
        next = grow && chains < mmlt->options.chains ? 2 * chains : chains;
        next = next < whole ? whole : next;
    }
    next = next < mmlt->options.chains ? next : mmlt->options.chains;
    uint64_t left = chains_left(mmlt, total);
    return left < next ? (uint)left : next;
}

/* Chains in the first generation: few, for an early image, and at most half of the work that --samples asks for. */
static uint chains_first(const Mmlt *mmlt, uint64_t total)
{
    uint64_t left = chains_left(mmlt, total);
    uint chains = mmlt->options.chains;
    if (mmlt->scheme->grows) {
        left = (left + 1) / 2;
        chains = chains < CHAINS_FIRST ? chains : CHAINS_FIRST;
    }
    return left < chains ? (uint)left : chains;
}

static bool generations_run(Mmlt *mmlt, uint64_t total, Error *error)
{
    RenderRun *run = mmlt->run;
    const RenderOptions *options = run->options;
    uint chains = chains_first(mmlt, total);
    while (mmlt->work_done < total) {
        double begin = timing_now();
        if (!mmlt_generation_run(mmlt, chains, error) ||
            !render_layers_sample(run, mmlt->paths_done * run->crop_pixels, error))
            return false;
        double now = timing_now();
        render_run_report(run, options->samples > 0 ? (double)mmlt->work_done / (double)total : 0.0);
        if (*render_run_stop(run) || (options->seconds > 0.0 && now - run->start >= options->seconds))
            break;
        render_run_save_if_due(run);
        if (mmlt->scheme->grows)
            chains = chains_next(mmlt, chains, now - begin, total);
    }
    return true;
}

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

static bool lists_make(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams *frame = &run->frame, pool_frame;
    mmlt->paths_frame = *frame;
    mmlt->paths_frame.path.strategies = integrator_pt()->strategies;
    mmlt->paths_frame.partition.split_direct = !mmlt->options.chains_only;
    if (mmlt->options.chains_only && frame->path.max_depth >= CHAIN_DEPTH_MIN)
        mmlt->paths_frame.path.max_depth = CHAIN_DEPTH_MIN - 1;
    frame->path.min_depth = CHAIN_DEPTH_MIN;
    frame->path.mis_exponent = 1;
    frame->chains.mutations = mmlt->options.mutations;
    frame->chains.group_mutations = !mmlt->options.ungrouped;
    frame->chains.large_step = mmlt->scheme->large_step > 0.0 ? (float)mmlt->options.large_step : 0.0f;
    frame->chains.shifts = mmlt->options.shiftless ? 0.0f : mmlt->scheme->shifts;
    frame->chains.keep = 1;
    pool_frame = *frame;
    pool_frame.pool.enabled = 1;
    mmlt_film_params(&pool_frame.film, &mmlt->pool_film);
    mmlt_film_params(&mmlt->paths_frame.film, &mmlt->paths_film);
    bool made =
        integrator_pt()->list(&mmlt->paths_frame, &mmlt->paths, error) &&
        (frame->path.max_depth < CHAIN_DEPTH_MIN ||
         (bdpt_list(&pool_frame, &mmlt->pool, error) && chain_list(frame, mmlt->options.steps, &mmlt->chains, error)));
    mmlt->guide = *mmlt->run->guide;
    mmlt->paths.guide = mmlt->pool.guide = mmlt->chains.guide = &mmlt->guide;
    return made;
}

/* Reserves sums by depth in the films that are shown. */
static bool depths_reserve(Mmlt *mmlt, Error *error)
{
    const RenderLayers *layers = mmlt->run->options->layers;
    uint last = mmlt->run->frame.path.max_depth;
    if (!layers || (layers->wanted & LAYER_BIT(LAYER_BY_DEPTH)) == 0)
        return true;
    return film_depths_reserve(mmlt->run->film, last, error) && film_depths_reserve(&mmlt->film, last, error) &&
           (mmlt->options.chains_only || (film_depths_reserve(&mmlt->pool_film, last, error) &&
                                          film_depths_reserve(&mmlt->paths_film, last, error)));
}

static bool films_init(Mmlt *mmlt, Error *error)
{
    Film *films[] = {&mmlt->film, &mmlt->pool_film, &mmlt->paths_film};
    for (size_t i = 0; i < sizeof films / sizeof films[0]; ++i)
        if (!film_init_like(films[i], mmlt->run->film, error))
            return false;
    if ((!mmlt->options.chains_only && !film_rare_reserve(&mmlt->film, error)) || !depths_reserve(mmlt, error))
        return false;
    for (int replica = 0; replica < REPLICAS && !mmlt->options.chains_only; ++replica) {
        if (!combination_init(&mmlt->combinations[replica], mmlt->run->film, error))
            return false;
        mmlt->combinations[replica].shown = mmlt->options.shown;
    }
    return true;
}

bool mmlt_init(Mmlt *mmlt, RenderRun *run, Error *error)
{
    *mmlt = (Mmlt){.run = run, .options = run->options->chains, .next_sample = run->options->first_sample};
    mmlt->scheme = mmlt_scheme(mmlt->options.paper);
    options_complete(&mmlt->options, mmlt->scheme, run->frame.path.max_depth);
    mmlt->pool_per_step = POOL_PER_STEP;
    mmlt->paths_per_step = mmlt->options.chains_only ? PATHS_DIRECT : PATHS_FIRST;
    if (!films_init(mmlt, error) || !lists_make(mmlt, error))
        return false;
    for (int replica = 0; replica < REPLICAS; ++replica) {
        importance_even(mmlt->importance[replica]);
        chain_population_init(&mmlt->populations[replica], mmlt->chains.pass_fields);
    }
    return true;
}

void mmlt_destroy(Mmlt *mmlt)
{
    step_list_destroy(&mmlt->paths);
    step_list_destroy(&mmlt->pool);
    step_list_destroy(&mmlt->chains);
    film_destroy(&mmlt->film);
    film_destroy(&mmlt->pool_film);
    film_destroy(&mmlt->paths_film);
    for (int replica = 0; replica < REPLICAS; ++replica) {
        combination_destroy(&mmlt->combinations[replica]);
        chain_population_destroy(&mmlt->populations[replica]);
    }
    free(mmlt->pool_words);
    free(mmlt->begun);
}

static bool mmlt_render(RenderRun *run, Error *error)
{
    Mmlt mmlt;
    const uint64_t limit = UINT64_MAX / 2;
    run->start = run->last_save = timing_now();
    uint64_t total = run->options->samples > 0 ? run->crop_pixels * run->options->samples : limit;
    bool done = mmlt_init(&mmlt, run, error) && generations_run(&mmlt, total, error);
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        run->chains.weights[s] = mmlt.combinations[0].weight[s];
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth)
        run->chains.r_hat[depth] = chain_groups_r_hat(&mmlt.groups, depth);
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
                                          .render = mmlt_render};
    return &integrator;
}
