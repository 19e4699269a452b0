#include "mmlt/pool_estimator.h"

#include "backend/step_recorder.h"
#include "chain/chain.h"
#include "film/pixel_order.h"
#include "math/rng.h"
#include "mmlt/tuning.h"
#include "render/bd_fields.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

void pool_estimator_init(PoolEstimator *pool, const RenderRun *run, Film *film, bool chains_only, const Guide *guide)
{
    *pool = (PoolEstimator){.own = {.film = film, .hidden = chains_only},
                            .guide = guide,
                            .lights_all = chains_only,
                            .next_sample = run->options->first_sample};
}

void pool_estimator_destroy(PoolEstimator *pool)
{
    step_list_destroy(&pool->own.list);
    free(pool->words);
}

void pool_estimator_archive(Archive *archive, PoolEstimator *pool)
{
    ARCHIVE_FIELD(archive, pool->next_sample);
    ARCHIVE_FIELD(archive, pool->sample);
    ARCHIVE_FIELD(archive, pool->pixel);
    ARCHIVE_FIELD(archive, pool->lights_first);
    archive_doubles(archive, &pool->brightness, 1, RANGE_FLOATS_POSITIVE, "the brightness of a pool");
    ARCHIVE_FIELD(archive, pool->next);
    ARCHIVE_FIELD(archive, pool->turns);
    archive_doubles(archive, &pool->pilot_brightness, 1, RANGE_FLOATS_POSITIVE, "the brightness of the pilot pool");
    archive_doubles(archive, pool->brightness_sum, REPLICAS, (NumberRange){0.0, DBL_MAX},
                    "the brightness of all pools");
    ARCHIVE_FIELD(archive, pool->pools);
    ARCHIVE_FIELD(archive, pool->own.samples);
}

bool pool_estimator_list(PoolEstimator *pool, const RenderRun *run, Error *error)
{
    FrameParams frame = run->frame;
    frame.pool.enabled = 1;
    estimator_film_params(&pool->own, &frame.film);
    bool made = bdpt_list(&frame, &pool->own.list, error);
    pool->own.list.guide = pool->guide;
    pool->own.list.photons = &run->photons;
    return made;
}

static bool pool_reserve(PoolEstimator *pool, uint count, Error *error)
{
    if (pool->words && count <= pool->capacity)
        return true;
    size_t bytes = (size_t)count * POOL_WORDS * sizeof *pool->words;
    free(pool->words);
    pool->capacity = count;
    pool->words = malloc(bytes);
    return pool->words || error_memory(error, bytes, "a pool");
}

/* ---- which pixels it visits -------------------------------------------------------------------------------------- */

/* Index of the next pool's first sample with a light subpath; the pool starts at position `place` of the pixel order.
 * turn: rounds completed so far, or pools if those are longer than a round.
 *
 * Pools visit the same pixels again in the next round, so samples with a light subpath are chosen by position: every
 * position gets one in about 1 / POOL_LIGHTS rounds, whatever the sizes of pool and round. The order of the parts is a
 * van der Corput sequence with a random shift, renewed every TURNS terms, so that errors do not add up if the number of
 * pools per round matches a period of the sequence. These samples are contiguous, so that chunks with none skip the
 * light walk. */
static uint lights_first(const RenderRun *run, uint order, uint64_t turn, uint64_t place, uint items)
{
    double part = generation_random(run, (uint)(turn / TURNS), GENERATION_POOL_LIGHTS + order);
    for (uint k = (uint)(turn % TURNS), weight = TURNS / 2; k > 0; k >>= 1, weight >>= 1)
        part += (double)(k & 1u) * weight / TURNS;
    return (uint)(((uint64_t)(part * items) + items - place % items) % items);
}

/* Places the next pool of `items` samples: it continues in the pixel order where the last one stopped. The first starts
 * at a random position, so that each pool on its own samples all pixels with equal probability. */
static void pool_place(PoolEstimator *pool, const Generation *generation, uint items)
{
    const RenderRun *run = generation->run;
    uint visits = pool->guide->visits[IMPORTANCE_CELLS], order = visits > 0 ? (uint)generation->replica : REPLICAS;
    uint *next = &pool->next[order], *turn = &pool->turns[order];
    uint64_t round = visits > 0 ? visits : run->crop_pixels;
    if (generation->index == 0)
        *next = (uint)(generation_random(run, 0, GENERATION_POOL_PLACE) * (double)round);
    uint64_t end = (uint64_t)*next + items;
    pool->count = items;
    pool->pixel = *next;
    if (items <= round && *next + items / 2 >= round) /* most of it lies in the next round */
        pool->lights_first = lights_first(run, order, *turn + 1, *next + items - round % items, items);
    else
        pool->lights_first = lights_first(run, order, *turn, *next, items);
    *turn += items <= round ? (uint)(end / round) : 1;
    *next = (uint)(end % round);
    pool->sample = pool->next_sample;
    pool->next_sample += (uint)((end + round - 1) / round) * (visits > 0 ? VISITS_MOST : 1);
}

void pool_estimator_restart(PoolEstimator *pool, const Generation *generation)
{
    pool->next[generation->replica] =
        (uint)(generation_random(generation->run, generation->index, GENERATION_POOL_PLACE) *
               (double)pool->guide->visits[IMPORTANCE_CELLS]);
}

/* ---- its pass ---------------------------------------------------------------------------------------------------- */

void pool_estimator_share(const PoolEstimator *pool, const Generation *generation, FrameParams *frame)
{
    frame->partition.clamp_threshold = generation->clamp_threshold;
    frame->pass.sample_index = pool->sample;
    frame->pass.pixel_first = pool->pixel;
    frame->pool.visits = pool->guide->visits[IMPORTANCE_CELLS];
    frame->pass.pixel_stride = frame->pool.visits > 0 ? pixel_order_stride_of(frame->pool.visits)
                                                      : pixel_order_stride(frame->film.crop_x1 - frame->film.crop_x0,
                                                                           frame->film.crop_y1 - frame->film.crop_y0);
}

FrameParams pool_estimator_frame(const PoolEstimator *pool, const Generation *generation)
{
    FrameParams frame = generation->run->frame;
    frame.pass.item_count = pool->count;
    frame.pool.enabled = 1;
    frame.pool.lights = pool->lights_all
                            ? pool->count
                            : (uint)ceil((frame.openings.count > 0 ? POOL_LIGHTS_OPENED : POOL_LIGHTS) * pool->count);
    frame.pool.items = pool->count;
    frame.pool.lights_first = pool->lights_first;
    frame.pool.lights_weight = (float)((double)pool->count / frame.pool.lights);
    pool_estimator_share(pool, generation, &frame);
    estimator_film_params(&pool->own, &frame.film);
    return frame;
}

static bool pool_run(PoolEstimator *pool, const Generation *generation, uint count, bool *whole, Error *error)
{
    uint64_t delivered;
    pool_place(pool, generation, count);
    FrameParams frame = pool_estimator_frame(pool, generation);
    if (!pool_reserve(pool, count, error))
        return false;
    pool->own.list.pass_words = pool->words;
    pool->own.list.pass_fields = POOL_WORDS;
    pool->own.list.pass_stride = count;
    bool done = estimator_pass(&pool->own, generation->run, &frame, false, &delivered, error);
    *whole = delivered == count;
    pool->own.samples = *whole ? count : 0;
    generation->run->chains.pool_samples += done ? count : 0;
    return done;
}

/* ---- brightness -------------------------------------------------------------------------------------------------- */

/* Mean contribution weight of the latest pool's samples. */
static double pool_brightness(const PoolEstimator *pool)
{
    double sum = 0.0;
    for (uint i = 0; i < pool->count; ++i)
        if (pool->words[(size_t)POOL_KEY * pool->count + i] != 0)
            sum += (double)bits_float(pool->words[(size_t)POOL_WEIGHT * pool->count + i]);
    return sum / pool->count;
}

bool pool_estimator_pilot(PoolEstimator *pool, const Generation *generation, uint most, bool *whole, Error *error)
{
    if (!pool_run(pool, generation, most < PILOT_SAMPLES ? most : PILOT_SAMPLES, whole, error))
        return false;
    if (*whole)
        pool->pilot_brightness = pool_brightness(pool);
    film_clear(pool->own.film);
    return true;
}

bool pool_estimator_run(PoolEstimator *pool, const Generation *generation, uint count, bool *whole, Error *error)
{
    if (!pool_run(pool, generation, count, whole, error))
        return false;
    if (*whole)
        pool->brightness = pool_brightness(pool);
    return true;
}

void pool_estimator_count(PoolEstimator *pool, const Generation *generation)
{
    pool->brightness_sum[generation->replica] += pool->brightness;
    ++pool->pools[generation->replica];
}

double pool_estimator_brightness(const PoolEstimator *pool, const Generation *generation)
{
    uint pools = pool->pools[generation->other];
    return pools > 0 ? pool->brightness_sum[generation->other] / pools : pool->pilot_brightness;
}
