/* A generation: a pool of independent samples, chains that begin with some of them, path tracing, and what all show. */
#include "mmlt.h"

#include "pixel_order.h"
#include "render_layers.h"
#include "rng.h"
#include "sample_statistics.h"
#include "timing.h"

#include "chain.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A path may show so many times the mean worth of a pool's sample, both with their importance. */
#define LIMIT_FACTOR 16.0

/* Of the pool before the first, at most. */
#define PILOT_SAMPLES 4096u
#define PILOT_PARTS 16u

/* Items of one pass of path tracing. */
#define PATHS_MAX (1u << 24)

static bool pool_reserve(Mmlt *mmlt, uint count, Error *error)
{
    if (mmlt->pool_words && count <= mmlt->pool_count)
        return true;
    size_t bytes = (size_t)count * POOL_WORDS * sizeof *mmlt->pool_words;
    free(mmlt->pool_words);
    mmlt->pool_count = count;
    mmlt->pool_words = malloc(bytes);
    return mmlt->pool_words || error_memory(error, bytes, "a pool");
}

/* Which half of the image a generation is for; `paper` has chains that never end. */
static int half_of(const Mmlt *mmlt, uint generation)
{
    return mmlt->options.paper ? 0 : (int)(generation % MMLT_HALVES);
}

ChainPopulation *mmlt_population(Mmlt *mmlt)
{
    return &mmlt->populations[half_of(mmlt, mmlt->generation)];
}

/* What the other half has seen of the pools' brightness; before that, what the pilot has. */
static double brightness_known(const Mmlt *mmlt)
{
    uint generations = (mmlt->generation + 1) / 2;
    return generations > 0 ? mmlt->brightness_sum[half_of(mmlt, mmlt->generation + 1)] / generations
                           : mmlt->pilot_brightness;
}

/* A uniform number of the host's own. */
static double host_random(const FrameParams *frame, uint generation, uint use)
{
    Random4 random = random_four(generation, use, NONE, PATH_STREAM_POOL, frame->seed_low, frame->seed_high);
    return ((double)random.x[0] + 0.5) / 4294967296.0;
}

/* The next pool, of `items` samples: it goes on visiting the pixels where the last one stopped, and the first begins
 * anywhere, so that each by itself is as likely to see one pixel as another. */
static void pool_place(Mmlt *mmlt, uint items)
{
    uint64_t pixels = mmlt->run->crop_pixels;
    if (mmlt->generation == 0)
        mmlt->pool_next = (uint)(host_random(&mmlt->run->frame, 0, 1) * (double)pixels);
    uint64_t end = (uint64_t)mmlt->pool_next + items;
    mmlt->pool_pixel = mmlt->pool_next;
    mmlt->pool_next = (uint)(end % pixels);
    mmlt->pool_sample = mmlt->next_sample;
    mmlt->next_sample += (uint)((end + pixels - 1) / pixels);
}

/* Of what a path shows before it becomes an excess: that of a usual one many times, as earlier pools have it. */
static float limit_of(const Mmlt *mmlt)
{
    if (mmlt->options.unblended)
        return FLT_MAX;
    return (float)(LIMIT_FACTOR * brightness_known(mmlt));
}

/* What all of a generation have in common. */
static void generation_frame(const Mmlt *mmlt, FrameParams *frame)
{
    memcpy(frame->importance, mmlt->importance[half_of(mmlt, mmlt->generation)], sizeof frame->importance);
    frame->limit = limit_of(mmlt);
}

/* What a pool and the chains from it have in common. */
static void seeds_frame(const Mmlt *mmlt, FrameParams *frame)
{
    generation_frame(mmlt, frame);
    frame->sample_index = mmlt->pool_sample;
    frame->pixel_first = mmlt->pool_pixel;
    frame->pixel_stride = pixel_order_stride(frame->crop_x1 - frame->crop_x0, frame->crop_y1 - frame->crop_y0);
}

void mmlt_frame_film(FrameParams *frame, const Film *film)
{
    frame->film_exponent = film->quantum_exponent;
    frame->split_depths = film->depth_kinds;
}

FrameParams mmlt_pool_frame(const Mmlt *mmlt)
{
    FrameParams frame = mmlt->run->frame;
    frame.pool = 1;
    seeds_frame(mmlt, &frame);
    mmlt_frame_film(&frame, &mmlt->pool_film);
    return frame;
}

FrameParams mmlt_chain_frame(Mmlt *mmlt)
{
    FrameParams frame = mmlt->run->frame;
    seeds_frame(mmlt, &frame);
    frame.brightness = (float)mmlt_population(mmlt)->brightness;
    frame.roulette_depth = NONE;
    mmlt_frame_film(&frame, &mmlt->film);
    return frame;
}

static bool pool_run(Mmlt *mmlt, uint count, const atomic_int *stop, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams frame = mmlt_pool_frame(mmlt);
    uint64_t delivered = 0;
    if (!pool_reserve(mmlt, count, error))
        return false;
    mmlt->pool.pass_words = mmlt->pool_words;
    mmlt->pool.pass_fields = POOL_WORDS;
    mmlt->pool.pass_stride = count;
    frame.item_count = count;
    film_clear(&mmlt->pool_film);
    const SplatSink sink = render_run_sink(&mmlt->pool_film);
    bool done = run->interface->run(run->backend, &frame, &mmlt->pool, &sink, stop, &delivered, error);
    *whole = delivered == count;
    mmlt->pool_film.light_samples = *whole ? count : 0;
    return done;
}

/* Uniform numbers of the host's own, one for each generation. */
static double offset_of(const Mmlt *mmlt)
{
    return host_random(&mmlt->run->frame, mmlt->generation, 0);
}

/* Mean worth of every so-manyth of the latest pool's samples, from the first on. */
static double pool_brightness(const Mmlt *mmlt, uint pool_count, uint first, uint every)
{
    double sum = 0.0, count = 0.0;
    for (uint i = first; i < pool_count; i += every) {
        if (mmlt->pool_words[(size_t)POOL_KEY * pool_count + i] != 0)
            sum += (double)bits_float(mmlt->pool_words[(size_t)POOL_WEIGHT * pool_count + i]);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

static bool chains_begin(Mmlt *mmlt, uint pool_count, const float *change, uint count, Error *error)
{
    ChainPopulation *population = mmlt_population(mmlt);
    ChainStarts starts;
    /* A sample of a pool that is worth this begins one chain. */
    double threshold = brightness_known(mmlt) * pool_count / count;
    mmlt->brightness = pool_brightness(mmlt, pool_count, 0, 1);
    if (!chain_population_renew(population, mmlt->pool_words, pool_count, change, threshold, mmlt->options.order,
                                offset_of(mmlt), count, &starts, error))
        return false;
    mmlt->chains.pass_words = population->words;
    mmlt->chains.pass_stride = count;
    chain_statistics_starts(&mmlt->run->chains, &starts);
    return true;
}

/* The words of the chains before the pass writes where they end. */
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

static bool chains_run(Mmlt *mmlt, uint count, const atomic_int *stop, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams frame = mmlt_chain_frame(mmlt);
    uint64_t delivered = 0;
    if (!(mmlt_population(mmlt)->brightness > 0.0))
        return true; /* a dark pool: what the chains would have shown is dark, too, on average */
    frame.item_count = count;
    if (run->options->bad_chains && !begun_keep(mmlt, count, error))
        return false;
    const SplatSink sink = render_run_sink(&mmlt->film);
    bool done = run->interface->run(run->backend, &frame, &mmlt->chains, &sink, stop, &delivered, error);
    *whole = delivered == count;
    if (mmlt->options.paper) /* they go on; their coordinates are there */
        for (uint i = 0; i < count; ++i)
            mmlt->chains.pass_words[(size_t)CHAIN_PASS_ITEM * count + i] = NONE;
    return done;
}

/* Samples of a pool for so many steps of chains: of every pixel as many, where that changes the number by no more than
 * half. */
static uint pool_size(const Mmlt *mmlt, double steps)
{
    double pixels = (double)mmlt->run->crop_pixels, whole = rint(mmlt->pool_per_step * steps / pixels);
    double wanted = whole >= 1.0 ? whole * pixels : mmlt->pool_per_step * steps;
    if (mmlt->options.pool)
        wanted = (double)mmlt->options.pool;
    return (uint)fmin(fmax(wanted, 1.0), 0x1p30);
}

/* Whether the half whose turn it is goes by what is known now: after 2, 4, 8 ... generations of its own, so that what is
 * known has grown by much since, and chains nearly always go on as they were. */
static bool importance_due(const Mmlt *mmlt)
{
    uint own = mmlt->generation / MMLT_HALVES;
    return !mmlt->options.unblended && own >= 2 && (own & (own - 1)) == 0;
}

/* The importance as the other half knows it. change: room for what it is over what it was. */
static void importance_renew(Mmlt *mmlt, float *change)
{
    int half = half_of(mmlt, mmlt->generation);
    float *importance = mmlt->importance[half];
    memcpy(change, importance, IMPORTANCE_CELLS * sizeof *change);
    importance_learn(&mmlt->blends[1 - half], importance);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        change[i] = importance[i] / change[i];
}

/* pool_brightness for a limit that has no more to go by than one small pool: the median of the means of its parts, which a
 * rare bright path in one of them does not change. */
static double pool_brightness_robust(const Mmlt *mmlt, uint pool_count)
{
    double parts[PILOT_PARTS];
    for (uint part = 0; part < PILOT_PARTS; ++part)
        parts[part] = pool_brightness(mmlt, pool_count, part, PILOT_PARTS);
    sample_sort(parts, PILOT_PARTS);
    return parts[PILOT_PARTS / 2];
}

/* A small pool before the first, of which only its brightness is kept: so the first generation has a limit as later ones do,
 * and what it shows can be compared with them. */
static bool pilot_run(Mmlt *mmlt, uint count, Error *error)
{
    static const atomic_int never = 0;
    bool whole = true;
    pool_place(mmlt, count);
    if (!pool_run(mmlt, count, &never, &whole, error))
        return false;
    mmlt->pilot_brightness = pool_brightness_robust(mmlt, count);
    mmlt->run->chains.pool_samples += count;
    return true;
}

bool mmlt_seeds_run(Mmlt *mmlt, uint count, const atomic_int *stop, bool *whole, Error *error)
{
    float change[IMPORTANCE_CELLS];
    bool changed = importance_due(mmlt);
    if (changed)
        importance_renew(mmlt, change);
    uint pool_count = pool_size(mmlt, (double)count * (double)mmlt->options.steps);
    if (mmlt->generation == 0 && !mmlt->options.unblended &&
        !pilot_run(mmlt, pool_count < PILOT_SAMPLES ? pool_count : PILOT_SAMPLES, error))
        return false;
    pool_place(mmlt, pool_count);
    if (!pool_run(mmlt, pool_count, stop, whole, error) ||
        (*whole && !chains_begin(mmlt, pool_count, changed ? change : NULL, count, error)))
        return false;
    mmlt->run->chains.pool_samples += pool_count;
    return true;
}

/* What the chains of a pass did, and where they are. */
static void chains_count(Mmlt *mmlt, uint count)
{
    const uint *words = mmlt->chains.pass_words;
    uint half = (uint)half_of(mmlt, mmlt->generation);
    chain_statistics_pass(&mmlt->run->chains, words, count, mmlt->options.steps);
    chain_groups_add(&mmlt->groups, words, count, half, mmlt->options.paper ? CHAIN_GROUPS : 1);
}

/* ---- path tracing ------------------------------------------------------------------------------------------------ */

/* Path tracing that goes with `steps` steps of chains: whole samples of all pixels, and at least one in the first two
 * generations of either half of the image, from which its variances are known. */
static bool paths_run(Mmlt *mmlt, uint64_t steps, const atomic_int *stop, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams *frame = &mmlt->paths_frame;
    double begin = timing_now();
    mmlt->paths_wanted += mmlt->paths_per_step * (double)steps / (double)run->crop_pixels;
    uint64_t target = (uint64_t)mmlt->paths_wanted, first = (uint64_t)mmlt->generation + 1;
    if (mmlt->generation < 2 * MMLT_HALVES && target < first)
        target = first;
    film_clear(&mmlt->paths_film);
    const SplatSink sink = render_run_sink(&mmlt->paths_film);
    generation_frame(mmlt, frame);
    mmlt_frame_film(frame, &mmlt->paths_film);
    uint64_t items = target > mmlt->paths_done ? (target - mmlt->paths_done) * run->crop_pixels : 0;
    for (uint64_t next = 0; next < items && *whole; next += frame->item_count) {
        uint64_t delivered = 0, left = items - next;
        frame->sample_index = run->options->first_sample + (uint)(mmlt->paths_done + next / run->crop_pixels);
        frame->first_item = (uint)(next % run->crop_pixels);
        frame->item_count = left < PATHS_MAX ? (uint)left : PATHS_MAX;
        if (!run->interface->run(run->backend, frame, &mmlt->paths, &sink, stop, &delivered, error))
            return false;
        *whole = delivered == frame->item_count;
    }
    mmlt->paths_done = target > mmlt->paths_done ? target : mmlt->paths_done;
    mmlt->paths_film.light_samples = items;
    run->chains.direct_seconds += timing_now() - begin;
    return true;
}

/* ---- all of it --------------------------------------------------------------------------------------------------- */

/* What the generation showed, to the picture and the layers. */
static bool generation_take(Mmlt *mmlt, Error *error)
{
    RenderLayers *layers = mmlt->run->options->layers;
    Film *const streams[BLEND_STREAMS] = {
        [BLEND_CHAINS] = &mmlt->film, [BLEND_POOL] = &mmlt->pool_film, [BLEND_PATHS] = &mmlt->paths_film};
    if (mmlt->options.unblended) {
        mmlt->paths_film.light_samples = 0; /* direct light alone */
        if (!film_merge(&mmlt->film, &mmlt->paths_film, error))
            return false;
    } else {
        int half = half_of(mmlt, mmlt->generation);
        if (!blend_generation(&mmlt->blends[half], &mmlt->blends[1 - half], streams, error))
            return false;
        BlendPlan plan = blend_plan(&mmlt->blends[half]); /* for the other half, whose turn it is */
        if (plan.paths_per_step > 0.0) {
            mmlt->paths_per_step = plan.paths_per_step;
            mmlt->pool_per_step = fmax(plan.pool_per_step, POOL_PER_STEP);
        }
    }
    return film_merge(mmlt->run->film, &mmlt->film, error) &&
           (!layers || render_layers_add(layers, &mmlt->film, mmlt->generation % 2, error));
}

static bool chains_follow(Mmlt *mmlt, uint count, const atomic_int *stop, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    double begin = timing_now();
    bool anew = !mmlt->options.paper || mmlt->generation == 0;
    if (anew && !mmlt_seeds_run(mmlt, count, stop, whole, error))
        return false;
    double seeded = timing_now();
    if (*whole && !chains_run(mmlt, count, stop, whole, error))
        return false;
    run->chains.pool_seconds += seeded - begin;
    run->chains.chain_seconds += timing_now() - seeded;
    return true;
}

/* Of the generation that has run: steps of its chains, its pool where it had one of its own, and its path tracing. */
static uint64_t generation_work(const Mmlt *mmlt, uint64_t steps)
{
    bool pool = steps > 0 && (!mmlt->options.paper || mmlt->generation == 0);
    const double samples[BLEND_STREAMS] = {[BLEND_CHAINS] = (double)steps,
                                           [BLEND_POOL] = pool ? (double)mmlt->pool_film.light_samples : 0.0,
                                           [BLEND_PATHS] = (double)mmlt->paths_film.light_samples};
    double work = blend_work(samples);
    return work > 1.0 ? (uint64_t)work : 1;
}

bool mmlt_generation_run(Mmlt *mmlt, uint count, const atomic_int *stop, Error *error)
{
    RenderRun *run = mmlt->run;
    uint64_t steps = (uint64_t)count * mmlt->options.steps;
    bool whole = true, chains = run->frame.max_depth >= CHAIN_DEPTH_MIN;
    film_clear(&mmlt->film);
    if ((chains && !chains_follow(mmlt, count, stop, &whole, error)) ||
        (whole && !paths_run(mmlt, steps, stop, &whole, error)))
        return false;
    if (whole) {
        mmlt->film.light_samples = steps;
        uint64_t work = generation_work(mmlt, chains ? steps : 0);
        if (!generation_take(mmlt, error))
            return false;
        mmlt->brightness_sum[half_of(mmlt, mmlt->generation)] += mmlt->brightness;
        if (chains && mmlt_population(mmlt)->brightness > 0.0) {
            chains_count(mmlt, count);
            mmlt_bad_chains_write(mmlt, count);
        }
        mmlt->work_last = work;
        run->done = mmlt->work_done += work;
    }
    ++mmlt->generation;
    return true;
}
