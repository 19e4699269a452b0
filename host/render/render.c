#include "render/render.h"

#include "render/layers.h"
#include "render/run.h"

#include "backend/film_sink.h"
#include "backend/step_recorder.h"
#include "base/log.h"
#include "base/timing.h"
#include "layout/diagnostics.h"
#include "render/checkpoint.h"
#include "render/error_watch.h"
#include "render/film_pilot.h"
#include "render/openings.h"
#include "render/photon_map.h"
#include "render/photon_worth.h"
#include "render/pilot_file.h"
#include "render/shard.h"

#include <math.h>
#include <string.h>

/* Russian roulette starts at this segment of a bidirectional walk. */
#define ROULETTE_DEPTH 3

/* Target duration of a pass: short, so that saving, stopping and progress are prompt. */
#define PASS_SECONDS 0.25
/* Where ranks exchange sums after a pass, it is so long that this takes no more than a part of it, up to a limit. */
#define EXCHANGE_PART 0.05
#define PASS_SECONDS_MOST 4.0
#define PASS_ITEMS_MIN 16384u
#define PASS_ITEMS_MAX (1u << 28)

/* Names of the kernels' counters. */
#define DIAGNOSTIC_NAME(constant, name) name,
static const char *const DIAGNOSTIC_NAMES[DIAGNOSTIC_COUNT] = {DIAGNOSTIC_LIST(DIAGNOSTIC_NAME)};
#undef DIAGNOSTIC_NAME

/* ---- the passes ------------------------------------------------------------------------------------------------- */

/* The loop for integrators whose items are samples of pixels. */
typedef struct PassLoop {
    RenderRun *run;
    StepList list;
    uint first_sample; /* of every pixel */
    uint64_t next, total; /* items; without a limit, all sample numbers */
} PassLoop;

/* Samples of pixels that follow each other: a pass does them or the first of them. */
typedef struct SampleSpan {
    uint half; /* whose samples they are, if there are halves */
    uint64_t sample; /* in its sequence */
    uint64_t pixel; /* in the order of pixels */
    uint64_t items; /* how many */
} SampleSpan;

/* The latest look at the error (error_watch.h) that is due after this many samples of every pixel, in samples; 0: none
 * is. */
static uint64_t look_before(uint64_t samples)
{
    uint64_t look = 0;
    while (error_watch_next(look) <= samples)
        look = error_watch_next(look);
    return look;
}

/* Halves take turns: between two looks half of the samples are made of one, then of the other. */
static SampleSpan span_of_halves(const PassLoop *loop)
{
    uint64_t pixels = loop->run->crop_pixels, begin = look_before(loop->next / pixels), end = error_watch_next(begin);
    end = end * pixels < loop->total ? end : loop->total / pixels;
    uint64_t first = (end - begin + 1) / 2 * pixels, done = loop->next - begin * pixels;
    SampleSpan span = {.half = done >= first, .items = done >= first ? (end - begin) * pixels - done : first - done};
    done -= span.half ? first : 0;
    span.sample = begin / 2 + done / pixels;
    span.pixel = done % pixels;
    return span;
}

static SampleSpan span_next(const PassLoop *loop)
{
    uint64_t pixels = loop->run->crop_pixels;
    if (loop->run->halves)
        return span_of_halves(loop);
    return (SampleSpan){.sample = loop->next / pixels, .pixel = loop->next % pixels, .items = loop->total - loop->next};
}

/* Runs a pass of the first `items` items of a span. */
static bool pass_run(PassLoop *loop, const SampleSpan *span, uint items, Error *error)
{
    RenderRun *run = loop->run;
    uint64_t delivered = 0;
    uint sequence = span->half * SEQUENCE_SAMPLES;
    run->frame.pass.sample_index = loop->first_sample + sequence + (uint)span->sample;
    run->frame.pass.first_item = (uint)span->pixel;
    run->frame.pass.item_count = items;
    run->frame.path.sobol = run->frame.path.sobol > 0 ? 1 + sequence : 0;
    run->frame.film.exponent = run->film->quantum_exponent;
    const SplatSink sink = film_sink(run->halves ? &run->halves[span->half] : run->film);
    if (!run->interface->run(run->backend, &run->frame, &loop->list, &sink, render_run_stop_between(run), &delivered,
                             error)) {
        run->done += delivered; /* these are in the film all the same */
        return false;
    }
    loop->next += items;
    run->done += delivered;
    return true;
}

/* Duration of the next pass. One that is longer because of an exchange should not outlast the time given. */
static double pass_seconds(const RenderRun *run, double elapsed)
{
    BackendStatistics statistics;
    run->interface->statistics(run->backend, &statistics);
    double seconds = fmin(statistics.exchange.latest_seconds / EXCHANGE_PART, PASS_SECONDS_MOST);
    if (run->options->seconds > elapsed)
        seconds = fmin(seconds, run->options->seconds - elapsed);
    return fmax(seconds, PASS_SECONDS);
}

/* Size of the next pass, in items, from the speed so far; at most `left`. */
static uint pass_items(const PassLoop *loop, double elapsed, uint64_t left)
{
    uint64_t fresh = loop->run->done - loop->run->past.done;
    double wanted = elapsed > 0.0 ? pass_seconds(loop->run, elapsed) * (double)fresh / elapsed : PASS_ITEMS_MIN;
    uint items = wanted < PASS_ITEMS_MIN ? PASS_ITEMS_MIN : wanted > PASS_ITEMS_MAX ? PASS_ITEMS_MAX : (uint)wanted;
    return left < items ? (uint)left : items;
}

static void loop_archive(void *context, Archive *archive)
{
    PassLoop *loop = context;
    ARCHIVE_FIELD(archive, loop->next);
}

/* Looks at the error after the samples between two looks, or the last ones. */
static bool look_if_due(const PassLoop *loop, Error *error)
{
    RenderRun *run = loop->run;
    if (!run->halves || loop->next % run->crop_pixels != 0 || loop->next < ERROR_LOOK_FIRST * run->crop_pixels)
        return true;
    uint64_t samples = loop->next / run->crop_pixels;
    bool due = look_before(samples) == samples || loop->next == loop->total;
    return !due || error_watch_look(run, error);
}

/* Whether the rendering is to end before the next pass. */
static bool passes_end(const PassLoop *loop, double elapsed)
{
    const RenderRun *run = loop->run;
    /* Even with --time every pixel gets one sample: no holes in the image. */
    bool spent = run->options->seconds > 0.0 && elapsed >= run->options->seconds && loop->next >= run->crop_pixels;
    return spent || *render_run_stop(run) || error_watch_reached(run);
}

/* Tells what has been done, and how long the next pass will take: it is under way until the next report. */
static void passes_report(const PassLoop *loop)
{
    RenderRun *run = loop->run;
    double elapsed = timing_now() - run->start;
    uint64_t fresh = run->done - run->past.done;
    bool more = loop->next < loop->total && !passes_end(loop, elapsed);
    uint items = more ? pass_items(loop, elapsed, span_next(loop).items) : 0;
    run->pass_last = loop->total - loop->next <= items;
    render_run_expect(run, fresh > 0 ? elapsed * (double)items / (double)fresh : 0.0);
    render_run_report(run, run->options->samples > 0 ? (double)run->done / (double)loop->total : 0.0);
}

static bool passes_run(PassLoop *loop, Error *error)
{
    RenderRun *run = loop->run;
    const CheckpointState state = {loop_archive, loop};
    if (!checkpoint_restore(run, state, error) || !render_layers_sample(run, run->done, error))
        return false;
    while (loop->next < loop->total) {
        double elapsed = timing_now() - run->start;
        if (passes_end(loop, elapsed))
            break;
        const SampleSpan span = span_next(loop);
        if (!pass_run(loop, &span, pass_items(loop, elapsed, span.items), error) || !look_if_due(loop, error))
            return false;
        passes_report(loop);
        if (!render_layers_sample(run, run->done, error))
            return false;
        render_run_save_if_due(run);
        checkpoint_save_if_due(run, state);
    }
    return checkpoint_end(run, state, error);
}

static bool samples_render(const Integrator *integrator, RenderRun *run, Error *error)
{
    const ShardRange samples = shard_samples(run->options);
    PassLoop loop = {.run = run, .first_sample = (uint)samples.first, .total = run->crop_pixels * samples.count};
    uint64_t most = run->crop_pixels * film_samples_most(run->frame.film.reconstruction);
    loop.total = loop.total < most ? loop.total : most;
    if (!integrator->list(&run->frame, &loop.list, error))
        return false;
    loop.list.photons = &run->photons;
    if (run->options->error.goal > 0.0)
        run->halves = run->options->layers->halves;
    Error gathering = {0};
    bool done = passes_run(&loop, error), gathered = render_run_gather(run, &gathering);
    if (done && !gathered)
        *error = gathering;
    done = done && gathered;
    step_list_destroy(&loop.list);
    return done;
}

void render_result_totals(RenderResult *result, RenderTotals totals, uint64_t pixels)
{
    result->totals = totals;
    result->samples = totals.done;
    result->samples_per_pixel = (double)totals.done / (double)pixels;
    result->seconds = totals.seconds;
    result->backend.closest_rays = totals.closest_rays;
    result->backend.shadow_rays = totals.shadow_rays;
    result->diagnostic_count = DIAGNOSTIC_COUNT;
    for (int i = 0; i < DIAGNOSTIC_COUNT; ++i) {
        result->diagnostic_names[i] = DIAGNOSTIC_NAMES[i];
        result->diagnostics[i] = totals.diagnostics[i];
    }
}

static void result_fill(const RenderRun *run, RenderResult *result)
{
    run->interface->statistics(run->backend, &result->backend);
    render_result_totals(result, render_run_totals(run), run->crop_pixels);
    result->chains = run->chains;
    result->error = run->error;
    result->error_reached = error_watch_reached(run);
    result->stopped = *render_run_stop(run);
    result->photons = run->photons.params.count;
    result->openings = run->frame.openings.count;
}

/* A filter wider than this costs more to spread splats by than they cost. */
#define SPREAD_RADIUS_MAX 8.0f

/* Whether splats are spread over pixels: not if the filter covers one pixel alone. */
static uint reconstruction_of(const RenderOptions *options, const PixelFilter *filter)
{
    bool single = filter->kind == PIXEL_FILTER_BOX && filter->radius_x <= 0.5f && filter->radius_y <= 0.5f;
    bool wide = filter->radius_x > SPREAD_RADIUS_MAX || filter->radius_y > SPREAD_RADIUS_MAX;
    bool many = options->samples > film_samples_most(RECONSTRUCTION_SPLAT);
    return single || wide || many ? RECONSTRUCTION_SAMPLE : options->reconstruction;
}

void render_frame(const Integrator *integrator, const Scene *scene, const RenderOptions *options, FrameParams *frame)
{
    *frame = scene->frame;
    frame->path.max_depth =
        (uint)(options->max_depth < integrator->depth_limit ? options->max_depth : integrator->depth_limit);
    frame->path.strategies = integrator->strategies;
    frame->path.mis_exponent = options->balance ? 1 : 2;
    frame->path.only_s = options->only_strategy ? options->strategy[0] : NONE;
    frame->path.only_t = options->only_strategy ? options->strategy[1] : NONE;
    frame->path.unweighted = options->unweighted;
    frame->path.sobol = options->independent || integrator->render ? 0 : 1;
    render_frame_seed(frame, options->seed);
    frame->pass.sample_index = options->first_sample;
    frame->pass.first_item = 0;
    frame->pass.pixel_stride = 1;
    frame->film.reconstruction = reconstruction_of(options, &frame->film.filter);
    frame->path.min_depth = 1;
    frame->path.roulette_depth = ROULETTE_DEPTH;
    frame->path.roulette_scale = integrator->roulette_scale > 0.0f ? integrator->roulette_scale : 1.0f;
    if (!integrator->guides || options->chains.paper || options->chains.unguided)
        frame->scene.guide_count = 0;
}

unsigned render_photons(const Integrator *integrator, const RenderOptions *options, uint64_t pixels)
{
    bool by_depth = options->layers && (options->layers->wanted & LAYER_BIT(LAYER_BY_DEPTH)) != 0;
    bool alone = integrator->render && (options->chains.paper || options->chains.chains_only);
    if (!integrator->photons || by_depth || alone)
        return 0;
    if (options->photons != PHOTONS_DEFAULT)
        return options->photons;
    return integrator->photons_default ? integrator->photons_default(options, pixels) : 0;
}

static bool starts_at_lights(const Integrator *integrator)
{
    return (integrator->strategies & (STRATEGY_CAMERA | STRATEGY_INNER)) != 0;
}

bool render_openings_find(RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error)
{
    bool as_published = integrator->render && run->options->chains.paper;
    if (run->options->no_openings || as_published || !starts_at_lights(integrator))
        return true;
    return openings_find(run, scene, error);
}

/* A PhotonLimit: few photons where they bring little. */
static bool photons_limit(void *context, uint *most, Error *error)
{
    RenderRun *run = context;
    if (!photon_map_part(run, false, &run->photons_part, error))
        return false;
    *most = photon_map_most(*most, run->photons_part);
    return true;
}

bool render_photons_make(RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error)
{
    const bool paths = integrator->strategies == STRATEGIES_PT;
    const bool limited = !paths && run->options->photons == PHOTONS_DEFAULT;
    if (!run->resumed)
        run->past.photons = render_photons(integrator, run->options, run->crop_pixels);
    if (!photon_map_make(run, scene, run->past.photons, limited ? photons_limit : NULL, run, &run->photons, error))
        return false;
    run->photons.params.everywhere = paths;
    bool asked_for = run->options->photons != PHOTONS_DEFAULT || run->resumed;
    if (!paths && !photon_map_part(run, false, &run->photons_part, error))
        return false;
    if (!paths && !asked_for && !photon_map_worth(&run->photons, run->photons_part)) {
        log_message(LOG_INFO, "caustic photons bring too little of the light: rendering without");
        photon_map_destroy(&run->photons);
        run->past.photons = 0;
    }
    run->frame.photons = run->photons.params;
    return true;
}

/* The film's quantum, which is that of the picture in all shards, and after it the seed of the shard's chains. */
static bool quantum_and_seed_set(const RenderTask *task, RenderRun *run, Error *error)
{
    const Integrator *integrator = task->integrator;
    if (!task->keep_quantum && !run->resumed && !film_pilot_run(run, integrator, task->scene, error))
        return false;
    if (integrator->render)
        render_frame_seed(&run->frame, shard_seed(run->options));
    return true;
}

bool render_film(const RenderTask *task, Film *film, RenderResult *result, Error *error)
{
    const Integrator *integrator = task->integrator;
    const Scene *scene = task->scene;
    const RenderOptions *options = task->options;
    RenderRun run = {.interface = task->backend.interface,
                     .backend = task->backend.backend,
                     .options = options,
                     .callbacks = task->callbacks,
                     .film = film,
                     .guide = &scene->guide,
                     .hidden_light = scene_hides_light(scene)};
    run.crop_pixels = film_pixels(film);
    memset(result, 0, sizeof *result);
    render_frame(integrator, scene, options, &run.frame);
    film_filter_set(film, &run.frame.film, scene->lookup.data);
    if (starts_at_lights(integrator) && !film_light_reserve(film, error))
        return false;
    BackendStatistics statistics;
    run.interface->statistics(run.backend, &statistics);
    film->threads = statistics.threads;
    run.start = timing_now();
    run.last_save = run.start - options->save_every; /* the first image is due as soon as there is one */
    RenderLayers *layers = options->layers;
    Checkpoint checkpoint;
    PilotFile pilot = {.path = NULL};
    bool done = checkpoint_begin(&checkpoint, &run, integrator, scene, error) &&
                pilot_file_open(&pilot, &run, integrator, scene, error) && quantum_and_seed_set(task, &run, error) &&
                render_openings_find(&run, integrator, scene, error) &&
                render_photons_make(&run, integrator, scene, error) &&
                (!layers || render_layers_init(layers, layers->wanted, options->error.goal > 0.0, film, error)) &&
                (integrator->render ? integrator->render(&run, error) : samples_render(integrator, &run, error));
    result_fill(&run, result);
    photon_map_destroy(&run.photons);
    checkpoint_destroy(&checkpoint);
    pilot_file_close(&pilot);
    return done;
}
