/* Multiplexed Metropolis light transport (Hachisuka, Kaplanyan and Dachsbacher 2014; Frolov 2018): paths of one and two
 * segments by path tracing, longer ones by Markov chains.
 *
 * In generations: a pool of independent bidirectional samples, from it chains drawn in proportion to what the samples are
 * worth, some steps of each, and again. The mean of all generations is right whatever their number and length, for
 * chains that begin in proportion to f stay so (sampling by importance resampling; Rubin 1987). */
#include "chain_list.h"
#include "chain_seeds.h"
#include "integrator.h"
#include "render_run.h"
#include "rng.h"
#include "timing.h"

#include "bd_fields.h"
#include "chain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bits of BD_LIGHT_DELTA. */
#define MMLT_DEPTH_LIMIT 31

/* Paths of fewer segments are left to path tracing. */
#define CHAIN_DEPTH_MIN 3

#define CHAINS_FIRST 4096u
#define STEPS_DEFAULT 64u

/* What a chain of `paper` is chosen from. */
#define PAPER_POOL_PER_CHAIN 8u

/* Chain steps for every sample of a pool. On a Cornell box a sample takes as long as four or five steps, so pools take
 * about a quarter of the time. */
#define STEPS_PER_POOL_SAMPLE 12u
#define LARGE_STEP_DEFAULT 0.3

/* Samples of direct light for every step of a chain. */
#define DIRECT_PART 0.5

/* A generation takes no longer than this part of the time so far, so that stopping and saving are prompt. */
#define GENERATION_PART 0.2

typedef struct Mmlt {
    RenderRun *run;
    ChainOptions options;
    FrameParams direct_frame;
    StepList direct, pool, chains;
    uint64_t direct_done, steps_done;
    uint next_sample; /* of the pool: numbers below it are used */
    uint pool_sample; /* the first of the latest pool */
    uint generation;
    uint pool_count, chain_count; /* of the buffers */
    uint *pool_words, *chain_words;
    Film film; /* of the generation under way */
    double brightness;
} Mmlt;

static void no_sink(void *context, const uint *splats, uint count, uint stride)
{
    (void)context, (void)splats, (void)count, (void)stride;
}

/* ---- direct light ------------------------------------------------------------------------------------------------ */

static bool direct_run(Mmlt *mmlt, uint64_t target, const atomic_int *stop, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams *frame = &mmlt->direct_frame;
    const SplatSink sink = render_run_sink(run->film);
    frame->film_exponent = run->film->quantum_exponent;
    while (mmlt->direct_done < target && !*stop) {
        uint64_t left = target - mmlt->direct_done, delivered = 0;
        uint items = left < 1u << 24 ? (uint)left : 1u << 24;
        frame->sample_index = run->options->first_sample + (uint)(mmlt->direct_done / run->crop_pixels);
        frame->first_item = (uint)(mmlt->direct_done % run->crop_pixels);
        frame->item_count = items;
        if (!run->interface->run(run->backend, frame, &mmlt->direct, &sink, stop, &delivered, error))
            return false;
        mmlt->direct_done += items;
    }
    return true;
}

/* ---- a generation ------------------------------------------------------------------------------------------------ */

static bool words_reserve(uint **words, uint *count, uint wanted, uint fields, Error *error)
{
    if (*words && wanted <= *count)
        return true;
    free(*words);
    *count = wanted;
    *words = malloc((size_t)wanted * fields * sizeof **words);
    return *words || error_memory(error, (size_t)wanted * fields * sizeof **words, "chains");
}

/* Sample numbers that `items` items of a pool take up. */
static uint samples_of(const RenderRun *run, uint items)
{
    return (uint)((items + run->crop_pixels - 1) / run->crop_pixels);
}

static bool pool_run(Mmlt *mmlt, uint count, const atomic_int *stop, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams frame = run->frame;
    uint64_t delivered = 0;
    if (!words_reserve(&mmlt->pool_words, &mmlt->pool_count, count, POOL_WORDS, error))
        return false;
    mmlt->pool.pass_words = mmlt->pool_words;
    mmlt->pool.pass_fields = POOL_WORDS;
    mmlt->pool.pass_stride = count;
    frame.pool = 1;
    frame.sample_index = mmlt->next_sample;
    frame.item_count = count;
    const SplatSink sink = {no_sink, NULL, 0, NULL};
    bool done = run->interface->run(run->backend, &frame, &mmlt->pool, &sink, stop, &delivered, error);
    *whole = delivered == count;
    return done;
}

/* Uniform numbers of the host's own, one for each generation. */
static double offset_of(const Mmlt *mmlt)
{
    const FrameParams *frame = &mmlt->run->frame;
    Random4 random = random_four(mmlt->generation, 0, NONE, PATH_STREAM_POOL, frame->seed_low, frame->seed_high);
    return ((double)random.x[0] + 0.5) / 4294967296.0;
}

static bool chains_begin(Mmlt *mmlt, uint pool_count, uint count, Error *error)
{
    if (!words_reserve(&mmlt->chain_words, &mmlt->chain_count, count, mmlt->chains.pass_fields, error))
        return false;
    uint *words = mmlt->chain_words;
    memset(words, 0, (size_t)count * mmlt->chains.pass_fields * sizeof *words);
    return chain_seeds_choose(mmlt->pool_words, pool_count, !mmlt->options.unsorted, offset_of(mmlt), count,
                              words + (size_t)CHAIN_PASS_ITEM * count, words + (size_t)CHAIN_PASS_KEY * count,
                              &mmlt->brightness, error);
}

static bool chains_run(Mmlt *mmlt, uint count, const atomic_int *stop, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams frame = run->frame;
    uint64_t delivered = 0;
    *whole = true;
    if (!(mmlt->brightness > 0.0))
        return true; /* a dark pool: what the chains would have shown is dark, too, on average */
    mmlt->chains.pass_words = mmlt->chain_words;
    mmlt->chains.pass_stride = count;
    frame.film_exponent = mmlt->film.quantum_exponent;
    frame.brightness = (float)mmlt->brightness;
    frame.sample_index = mmlt->pool_sample;
    frame.roulette_depth = NONE;
    frame.item_count = count;
    film_clear(&mmlt->film);
    const SplatSink sink = render_run_sink(&mmlt->film);
    bool done = run->interface->run(run->backend, &frame, &mmlt->chains, &sink, stop, &delivered, error);
    *whole = delivered == count;
    if (frame.keep_chains) /* their coordinates are there */
        for (uint i = 0; i < count; ++i)
            mmlt->chain_words[(size_t)CHAIN_PASS_ITEM * count + i] = NONE;
    return done;
}

/* A pool, and where `count` chains begin. *whole: not stopped before its end. */
static bool seeds_run(Mmlt *mmlt, uint count, const atomic_int *stop, bool *whole, Error *error)
{
    uint64_t wanted =
        mmlt->options.pool ? mmlt->options.pool : (uint64_t)count * mmlt->options.steps / STEPS_PER_POOL_SAMPLE;
    uint pool_count = wanted < 1u << 30 ? (uint)wanted : 1u << 30;
    if (!pool_run(mmlt, pool_count, stop, whole, error) || (*whole && !chains_begin(mmlt, pool_count, count, error)))
        return false;
    mmlt->pool_sample = mmlt->next_sample;
    mmlt->next_sample += samples_of(mmlt->run, pool_count);
    mmlt->run->chains.pool_samples += pool_count;
    mmlt->run->chains.seeds += count;
    return true;
}

/* How often chains of each depth took what they proposed. */
static void tally_chains(Mmlt *mmlt, uint count)
{
    ChainStatistics *statistics = &mmlt->run->chains;
    const uint *words = mmlt->chain_words;
    for (uint i = 0; i < count; ++i) {
        uint depth = chain_key_depth(words[(size_t)CHAIN_PASS_KEY * count + i]) % CHAIN_DEPTHS;
        for (uint kind = 0; kind < MUTATION_COUNT; ++kind) {
            uint tally = words[(size_t)(CHAIN_PASS_TALLY + kind) * count + i];
            statistics->proposals[kind][depth] += tally & 0xffffu;
            statistics->accepted[kind][depth] += tally >> 16;
        }
    }
    statistics->steps += (uint64_t)count * mmlt->options.steps;
}

/* A generation counts only as a whole: its chains are in the order of their paths. */
static bool generation_run(Mmlt *mmlt, uint count, const atomic_int *stop, Error *error)
{
    RenderRun *run = mmlt->run;
    uint steps = mmlt->options.steps;
    bool whole = true, anew = !mmlt->options.paper || mmlt->generation == 0;
    double begin = timing_now();
    if (anew && !seeds_run(mmlt, count, stop, &whole, error))
        return false;
    double seeded = timing_now();
    if (whole && !chains_run(mmlt, count, stop, &whole, error))
        return false;
    ++mmlt->generation;
    if (!whole)
        return true;
    mmlt->film.light_samples = (uint64_t)count * steps;
    if (!film_merge(run->film, &mmlt->film, error))
        return false;
    tally_chains(mmlt, count);
    run->chains.pool_seconds += seeded - begin;
    run->chains.chain_seconds += timing_now() - seeded;
    mmlt->steps_done += (uint64_t)count * steps;
    run->done = mmlt->steps_done;
    return true;
}

/* ---- all of them ------------------------------------------------------------------------------------------------- */

/* Chains of the next generation. With a number of samples it follows from that alone, so that the image does. */
static uint chains_next(const Mmlt *mmlt, uint chains, double seconds, uint64_t total)
{
    const RenderOptions *options = mmlt->run->options;
    double elapsed = timing_now() - mmlt->run->start;
    bool grow = options->samples > 0 || 2.0 * seconds < GENERATION_PART * elapsed;
    uint next = grow && chains < mmlt->options.chains ? 2 * chains : chains;
    next = next < mmlt->options.chains ? next : mmlt->options.chains;
    uint64_t left = (total - mmlt->steps_done + mmlt->options.steps - 1) / mmlt->options.steps;
    return left < next ? (uint)left : next;
}

static bool generations_run(Mmlt *mmlt, uint64_t total, Error *error)
{
    static const atomic_int never = 0;
    RenderRun *run = mmlt->run;
    const RenderOptions *options = run->options;
    uint chains = mmlt->options.chains < CHAINS_FIRST ? mmlt->options.chains : CHAINS_FIRST;
    uint64_t left = (total + mmlt->options.steps - 1) / mmlt->options.steps;
    if (mmlt->options.paper)
        chains = mmlt->options.chains;
    chains = left < chains ? (uint)left : chains;
    while (mmlt->steps_done < total) {
        bool first = mmlt->generation == 0;
        const atomic_int *stop = first || !options->stop ? &never : options->stop;
        double begin = timing_now();
        if (!generation_run(mmlt, chains, stop, error))
            return false;
        uint64_t direct = (uint64_t)(DIRECT_PART * (double)mmlt->steps_done);
        direct = direct < run->crop_pixels ? run->crop_pixels : direct;
        double chained = timing_now();
        if (!direct_run(mmlt, direct, stop, error))
            return false;
        double now = timing_now();
        run->chains.direct_seconds += now - chained;
        render_run_report(run, options->samples > 0 ? (double)mmlt->steps_done / (double)total : 0.0);
        if ((options->stop && *options->stop) || (options->seconds > 0.0 && now - run->start >= options->seconds))
            break;
        if (!render_run_save_if_due(run, error))
            return false;
        if (!mmlt->options.paper)
            chains = chains_next(mmlt, chains, now - begin, total);
    }
    return true;
}

static void options_complete(ChainOptions *options)
{
    options->chains = options->chains ? options->chains : options->paper ? PAPER_CHAINS_DEFAULT : CHAINS_DEFAULT;
    if (options->paper && !options->pool)
        options->pool = PAPER_POOL_PER_CHAIN * options->chains;
    options->steps = options->steps ? options->steps : STEPS_DEFAULT;
    options->mutations = options->mutations ? options->mutations : 7u;
    if (options->paper && !(options->large_step > 0.0))
        options->large_step = LARGE_STEP_DEFAULT;
}

static bool lists_make(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams *frame = &run->frame, pool_frame;
    mmlt->direct_frame = *frame;
    mmlt->direct_frame.max_depth = frame->max_depth < CHAIN_DEPTH_MIN ? frame->max_depth : CHAIN_DEPTH_MIN - 1;
    mmlt->direct_frame.strategies = integrator_pt()->strategies;
    frame->min_depth = CHAIN_DEPTH_MIN;
    frame->mis_exponent = 1;
    frame->mutations = mmlt->options.mutations;
    frame->group_mutations = !mmlt->options.ungrouped;
    frame->large_step = mmlt->options.paper ? (float)mmlt->options.large_step : 0.0f;
    frame->keep_chains = mmlt->options.paper;
    pool_frame = *frame;
    pool_frame.pool = 1;
    return integrator_pt()->list(&mmlt->direct_frame, &mmlt->direct, error) &&
           (frame->max_depth < CHAIN_DEPTH_MIN || (bdpt_list(&pool_frame, &mmlt->pool, error) &&
                                                   chain_list(frame, mmlt->options.steps, &mmlt->chains, error)));
}

static bool mmlt_render(RenderRun *run, Error *error)
{
    Mmlt mmlt = {.run = run, .options = run->options->chains};
    const uint64_t limit = UINT64_MAX / 2;
    Film *film = run->film;
    options_complete(&mmlt.options);
    run->start = run->last_save = timing_now();
    uint64_t total = run->options->samples > 0 ? run->crop_pixels * run->options->samples : limit;
    mmlt.next_sample = run->options->first_sample;
    bool done = film_init(&mmlt.film, film->width, film->height, film->crop, error) &&
                film_light_reserve(&mmlt.film, error) && lists_make(&mmlt, error);
    mmlt.film.quantum_exponent = film->quantum_exponent;
    done = done && generations_run(&mmlt, total, error);
    step_list_destroy(&mmlt.direct);
    step_list_destroy(&mmlt.pool);
    step_list_destroy(&mmlt.chains);
    film_destroy(&mmlt.film);
    free(mmlt.pool_words);
    free(mmlt.chain_words);
    return done;
}

const Integrator *integrator_mmlt(void)
{
    static const Integrator integrator = {.name = "mmlt",
                                          .summary = "multiplexed Metropolis light transport",
                                          .depth_limit = MMLT_DEPTH_LIMIT,
                                          .strategies = STRATEGIES_BDPT,
                                          .render = mmlt_render};
    return &integrator;
}
