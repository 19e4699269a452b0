/* The bootstrap pool: which pixels its samples visit, its pass, and the chains that start from it. */
#include "mmlt/mmlt.h"

#include "base/sample_statistics.h"
#include "film/pixel_order.h"
#include "math/rng.h"

#include "chain/chain.h"
#include "mmlt/tuning.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

int mmlt_replica(const Mmlt *mmlt, uint generation)
{
    return (int)(generation % (uint)mmlt->scheme->replicas);
}

ChainPopulation *mmlt_population(Mmlt *mmlt)
{
    return &mmlt->populations[mmlt_replica(mmlt, mmlt->generation)];
}

/* The mean brightness of the other replica's pools so far; at first the pilot's. */
static double brightness_known(const Mmlt *mmlt)
{
    uint generations = (mmlt->generation + 1) / 2;
    return generations > 0 ? mmlt->brightness_sum[mmlt_replica(mmlt, mmlt->generation + 1)] / generations
                           : mmlt->pilot_brightness;
}

/* A uniform number in (0, 1), a function of seed, generation and use. */
static double host_random(const FrameParams *frame, uint generation, uint use)
{
    Random4 random = random_four(generation, use, NONE, PATH_STREAM_POOL, frame->pass.seed_low, frame->pass.seed_high);
    return ((double)random.x[0] + 0.5) / 4294967296.0;
}

/* Index of the next pool's first sample with a light subpath; the pool starts at position `place` of the pixel order.
 * turn: rounds completed so far, or pools if those are longer than a round.
 *
 * Pools visit the same pixels again in the next round, so samples with a light subpath are chosen by position: every
 * position gets one in about 1 / POOL_LIGHTS rounds, whatever the sizes of pool and round. The order of the parts is a
 * van der Corput sequence with a random shift, renewed every TURNS terms, so that errors do not add up if the number of
 * pools per round matches a period of the sequence. These samples are contiguous, so that chunks with none skip the
 * light walk. */
static uint lights_first(const Mmlt *mmlt, uint order, uint64_t turn, uint64_t place, uint items)
{
    double part = host_random(&mmlt->run->frame, (uint)(turn / TURNS), 2 + order);
    for (uint k = (uint)(turn % TURNS), weight = TURNS / 2; k > 0; k >>= 1, weight >>= 1)
        part += (double)(k & 1u) * weight / TURNS;
    return (uint)(((uint64_t)(part * items) + items - place % items) % items);
}

/* Places the next pool of `items` samples: it continues in the pixel order where the last one stopped. The first starts
 * at a random position, so that each pool on its own samples all pixels with equal probability. */
static void pool_place(Mmlt *mmlt, uint items)
{
    int replica = mmlt_replica(mmlt, mmlt->generation);
    uint visits = mmlt->visits[replica][IMPORTANCE_CELLS], order = visits > 0 ? (uint)replica : REPLICAS;
    uint *next = &mmlt->pool_next[order], *turn = &mmlt->pool_turns[order];
    uint64_t round = visits > 0 ? visits : mmlt->run->crop_pixels;
    if (mmlt->generation == 0)
        *next = (uint)(host_random(&mmlt->run->frame, 0, 1) * (double)round);
    uint64_t end = (uint64_t)*next + items;
    mmlt->pool_pixel = *next;
    if (items <= round && *next + items / 2 >= round) /* most of it lies in the next round */
        mmlt->pool_lights_first = lights_first(mmlt, order, *turn + 1, *next + items - round % items, items);
    else
        mmlt->pool_lights_first = lights_first(mmlt, order, *turn, *next, items);
    *turn += items <= round ? (uint)(end / round) : 1;
    *next = (uint)(end % round);
    mmlt->pool_sample = mmlt->next_sample;
    mmlt->next_sample += (uint)((end + round - 1) / round) * (visits > 0 ? VISITS_MOST : 1);
}

/* The pool's clamping threshold, from the brightness of earlier pools. */
static float clamp_threshold_of(const Mmlt *mmlt)
{
    if (mmlt->options.chains_only)
        return FLT_MAX;
    return (float)(CLAMP_FACTOR * brightness_known(mmlt));
}

void mmlt_generation_frame(Mmlt *mmlt, FrameParams *frame)
{
    memcpy(mmlt->guide.importance, mmlt->importance[mmlt_replica(mmlt, mmlt->generation)],
           sizeof mmlt->guide.importance);
    frame->partition.clamp_threshold = clamp_threshold_of(mmlt);
}

/* Sets what a pool and the chains that start from it share. */
static void seeds_frame(Mmlt *mmlt, FrameParams *frame)
{
    mmlt_generation_frame(mmlt, frame);
    frame->pass.sample_index = mmlt->pool_sample;
    frame->pass.pixel_first = mmlt->pool_pixel;
    const uint *visits = mmlt->visits[mmlt_replica(mmlt, mmlt->generation)];
    memcpy(mmlt->guide.visits, visits, sizeof mmlt->guide.visits);
    frame->pool.visits = visits[IMPORTANCE_CELLS];
    frame->pass.pixel_stride =
        visits[IMPORTANCE_CELLS] > 0
            ? pixel_order_stride_of(visits[IMPORTANCE_CELLS])
            : pixel_order_stride(frame->film.crop_x1 - frame->film.crop_x0, frame->film.crop_y1 - frame->film.crop_y0);
}

void mmlt_film_params(FilmParams *params, const Film *film)
{
    params->exponent = film->quantum_exponent;
    params->split_depths = film->depth_kinds;
}

FrameParams mmlt_pool_frame(Mmlt *mmlt, uint count)
{
    FrameParams frame = mmlt->run->frame;
    frame.pool.enabled = 1;
    frame.pool.lights = mmlt->options.chains_only ? count : (uint)ceil(POOL_LIGHTS * count);
    frame.pool.items = count;
    frame.pool.lights_first = mmlt->pool_lights_first;
    frame.pool.lights_weight = (float)((double)count / frame.pool.lights);
    seeds_frame(mmlt, &frame);
    mmlt_film_params(&frame.film, &mmlt->pool_film);
    return frame;
}

FrameParams mmlt_chain_frame(Mmlt *mmlt)
{
    FrameParams frame = mmlt->run->frame;
    seeds_frame(mmlt, &frame);
    frame.chains.brightness = (float)mmlt_population(mmlt)->brightness;
    frame.path.roulette_depth = NONE;
    mmlt_film_params(&frame.film, &mmlt->film);
    return frame;
}

static bool pool_run(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    RenderRun *run = mmlt->run;
    FrameParams frame = mmlt_pool_frame(mmlt, count);
    uint64_t delivered = 0;
    if (!pool_reserve(mmlt, count, error))
        return false;
    mmlt->pool.pass_words = mmlt->pool_words;
    mmlt->pool.pass_fields = POOL_WORDS;
    mmlt->pool.pass_stride = count;
    frame.pass.item_count = count;
    film_clear(&mmlt->pool_film);
    SplatSink sink = render_run_sink(&mmlt->pool_film);
    sink.whole = true;
    bool done = run->interface->run(run->backend, &frame, &mmlt->pool, &sink, render_run_stop(run), &delivered, error);
    *whole = delivered == count;
    mmlt->pool_film.light_samples = *whole ? count : 0;
    return done;
}

/* A uniform number for each generation, for systematic resampling. */
static double resampling_offset(const Mmlt *mmlt)
{
    return host_random(&mmlt->run->frame, mmlt->generation, 0);
}

/* Mean contribution weight of the latest pool's samples first, first + every, ... */
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
    /* A pool sample of this contribution weight starts one chain on average. */
    double threshold = brightness_known(mmlt) * pool_count / count;
    mmlt->brightness = pool_brightness(mmlt, pool_count, 0, 1);
    if (!chain_population_renew(population, mmlt->pool_words, pool_count, change, threshold, mmlt->options.order,
                                resampling_offset(mmlt), count, &starts, error))
        return false;
    mmlt->chains.pass_words = population->words;
    mmlt->chains.pass_stride = count;
    chain_statistics_starts(&mmlt->run->chains, &starts);
    return true;
}

/* ---- what is known of the picture -------------------------------------------------------------------------------- */

/* Samples of a pool that accompanies `steps` steps: --pool, else the plan's, rounded to whole samples per pixel if that
 * gives at least one. */
static uint pool_size(const Mmlt *mmlt, double steps)
{
    double pixels = (double)mmlt->run->crop_pixels, whole = rint(mmlt->pool_per_step * steps / pixels);
    double wanted = whole >= 1.0 ? whole * pixels : mmlt->pool_per_step * steps;
    if (mmlt->options.pool)
        wanted = (double)mmlt->options.pool;
    return (uint)fmin(fmax(wanted, 1.0), 0x1p30);
}

/* Whether the replica under way adopts new importance and visits: after 2, 4, 8 ... generations of its own, when much
 * more is known, so that its target changes rarely. */
static bool importance_due(const Mmlt *mmlt)
{
    uint own = mmlt->generation / REPLICAS;
    return !mmlt->options.chains_only && own >= 2 && (own & (own - 1)) == 0;
}

/* Renews the target importance from what the other replica knows. change: receives the ratio new over old, per cell. */
static void importance_renew(Mmlt *mmlt, float *change)
{
    int replica = mmlt_replica(mmlt, mmlt->generation);
    float *importance = mmlt->importance[replica];
    memcpy(change, importance, IMPORTANCE_CELLS * sizeof *change);
    importance_learn(&mmlt->combinations[1 - replica], importance);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        change[i] = importance[i] / change[i];
}

/* Renews the pools' visits likewise. */
static bool visits_renew(Mmlt *mmlt, Error *error)
{
    int replica = mmlt_replica(mmlt, mmlt->generation), other = 1 - replica;
    const double samples[ESTIMATOR_COUNT] = {1.0, mmlt->pool_per_step, mmlt->paths_per_step};
    double visited[IMPORTANCE_CELLS];
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        visited[i] = mmlt->visited[other][i] / mmlt->visited_all[other];
    uint *visits = mmlt->visits[replica];
    if (!importance_visits(&mmlt->combinations[other], samples, visited, visits, error))
        return false;
    importance_tell(visits, &mmlt->combinations[replica]);
    mmlt->pool_next[replica] =
        (uint)(host_random(&mmlt->run->frame, mmlt->generation, 1) * (double)visits[IMPORTANCE_CELLS]);
    return true;
}

void mmlt_visits_count(Mmlt *mmlt)
{
    int replica = mmlt_replica(mmlt, mmlt->generation);
    double samples = (double)mmlt->pool_film.light_samples;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        double density_ratio = importance_density_ratio(&mmlt->combinations[replica], mmlt->visits[replica], i);
        mmlt->visited[replica][i] += density_ratio > 0.0 ? samples / density_ratio : 0.0;
    }
    mmlt->visited_all[replica] += samples;
}

/* Robust pool_brightness for the clamping threshold of one small pool: the median of means over parts, which a rare
 * bright path in one part does not change. */
static double pool_brightness_robust(const Mmlt *mmlt, uint pool_count)
{
    double parts[PILOT_PARTS];
    for (uint part = 0; part < PILOT_PARTS; ++part)
        parts[part] = pool_brightness(mmlt, pool_count, part, PILOT_PARTS);
    sample_sort(parts, PILOT_PARTS);
    return parts[PILOT_PARTS / 2];
}

bool mmlt_pilot_run(Mmlt *mmlt, uint chains, bool *whole, Error *error)
{
    uint pool_count = pool_size(mmlt, (double)chains * (double)mmlt->options.steps);
    uint count = pool_count < PILOT_SAMPLES ? pool_count : PILOT_SAMPLES;
    if (mmlt->options.chains_only)
        return true;
    pool_place(mmlt, count);
    if (!pool_run(mmlt, count, whole, error))
        return false;
    if (*whole)
        mmlt->pilot_brightness = pool_brightness_robust(mmlt, count);
    mmlt->run->chains.pool_samples += count;
    return true;
}

bool mmlt_seeds_run(Mmlt *mmlt, uint count, bool *whole, Error *error)
{
    float change[IMPORTANCE_CELLS];
    bool changed = importance_due(mmlt);
    if (changed) {
        importance_renew(mmlt, change);
        if (!visits_renew(mmlt, error))
            return false;
    }
    uint pool_count = pool_size(mmlt, (double)count * (double)mmlt->options.steps);
    pool_place(mmlt, pool_count);
    if (!pool_run(mmlt, pool_count, whole, error) ||
        (*whole && !chains_begin(mmlt, pool_count, changed ? change : NULL, count, error)))
        return false;
    mmlt->run->chains.pool_samples += pool_count;
    return true;
}
