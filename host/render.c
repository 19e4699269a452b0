#include "render.h"

#include "diagnostics.h"
#include "log.h"
#include "state.h"
#include "timing.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* Paths of the pilot that sets the film's quantum, and the sample number it uses: one that no image reaches. */
#define PILOT_ITEMS 4096u
#define PILOT_SAMPLE 0xffff0000u

/* A pass is sized to take about this long, so that saving, stopping and progress are prompt. */
#define PASS_SECONDS 0.25
#define PASS_ITEMS_MIN 16384u
#define PASS_ITEMS_MAX (1u << 28)

/* Names of the kernels' counters in reports. */
#define DIAGNOSTIC_NAME(constant, name) name,
static const char *const DIAGNOSTIC_NAMES[DIAGNOSTIC_COUNT] = {DIAGNOSTIC_LIST(DIAGNOSTIC_NAME)};
#undef DIAGNOSTIC_NAME

/* ---- the pilot -------------------------------------------------------------------------------------------------- */

typedef struct PilotSample {
    uint pixel;
    float luminance;
} PilotSample;

typedef struct Pilot {
    pthread_mutex_t mutex;
    PilotSample samples[PILOT_ITEMS];
    uint count;
} Pilot;

static void pilot_splats(void *context, const uint *splats, uint count, uint stride)
{
    Pilot *pilot = context;
    pthread_mutex_lock(&pilot->mutex);
    for (uint t = 0; t < count && pilot->count < PILOT_ITEMS; ++t) {
        PilotSample *sample = &pilot->samples[pilot->count++];
        sample->pixel = state_load(splats, stride, SPLAT_PIXEL, t);
        sample->luminance = float_abs(rgb_luminance(state_load_vec3(splats, stride, SPLAT_COLOR, t)));
    }
    pthread_mutex_unlock(&pilot->mutex);
}

static int pilot_compare(const void *a, const void *b)
{
    const PilotSample *x = a, *y = b;
    if (x->pixel != y->pixel)
        return x->pixel < y->pixel ? -1 : 1;
    return (x->luminance > y->luminance) - (x->luminance < y->luminance);
}

/* A number without common factor with n, near the golden section of it: k * stride mod n visits the pixels evenly. */
static uint stride_coprime(uint n)
{
    for (uint stride = (uint)(0.6180339887 * n) | 1u;; ++stride) {
        uint a = stride, b = n;
        while (b != 0) {
            uint rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1)
            return stride;
    }
}

/* Mean radiance from a few thousand paths over the whole film, so that a crop has the quantum and with it the bits of
 * the whole picture. The sum is taken in the order of pixels, so it does not depend on threads. */
static bool pilot_run(const BackendInterface *interface, Backend *backend, FrameParams frame, const StepList *list,
                      double *mean, Error *error)
{
    static const atomic_int never = 0;
    Pilot *pilot = malloc(sizeof *pilot);
    if (!pilot)
        return error_memory(error, sizeof *pilot, "the pilot");
    pilot->count = 0;
    pthread_mutex_init(&pilot->mutex, NULL);
    frame.crop_x0 = frame.crop_y0 = 0;
    frame.crop_x1 = frame.width;
    frame.crop_y1 = frame.height;
    frame.first_item = 0;
    frame.item_count = PILOT_ITEMS;
    frame.sample_index = PILOT_SAMPLE;
    frame.pixel_stride = stride_coprime(frame.width * frame.height);
    const SplatSink sink = {.splats = pilot_splats, .context = pilot};
    bool done = interface->run(backend, &frame, list, &sink, &never, NULL, error);
    double sum = 0.0;
    qsort(pilot->samples, pilot->count, sizeof pilot->samples[0], pilot_compare);
    for (uint i = 0; i < pilot->count; ++i)
        sum += (double)pilot->samples[i].luminance;
    *mean = pilot->count > 0 ? sum / pilot->count : 0.0;
    pthread_mutex_destroy(&pilot->mutex);
    free(pilot);
    return done;
}

/* ---- the passes ------------------------------------------------------------------------------------------------- */

static void film_splats(void *context, const uint *splats, uint count, uint stride)
{
    film_add_splats(context, splats, count, stride);
}

static void film_sums(void *context, ulong *words)
{
    film_add_sums(context, words);
}

typedef struct PassLoop {
    const BackendInterface *interface;
    Backend *backend;
    const RenderOptions *options;
    const RenderCallbacks *callbacks;
    StepList list;
    FrameParams frame;
    Film *film;
    uint64_t crop_pixels;
    uint64_t next, total; /* items; without a limit as many as there are sample numbers */
    uint64_t done;
    double start, last_save;
} PassLoop;

static void progress_report(PassLoop *loop, double elapsed)
{
    if (!loop->callbacks || !loop->callbacks->progress)
        return;
    BackendStatistics statistics;
    loop->interface->statistics(loop->backend, &statistics);
    double by_samples = loop->options->samples > 0 ? (double)loop->done / (double)loop->total : 0.0;
    double by_time = loop->options->seconds > 0.0 ? elapsed / loop->options->seconds : 0.0;
    RenderProgress progress = {.elapsed = elapsed,
                               .fraction = fmin(1.0, fmax(by_samples, by_time)),
                               .samples = loop->done,
                               .rays = statistics.closest_rays + statistics.shadow_rays};
    loop->callbacks->progress(loop->callbacks->context, &progress);
}

static bool save_if_due(PassLoop *loop, double now, Error *error)
{
    if (!loop->callbacks || !loop->callbacks->save || loop->options->save_every <= 0.0 ||
        now - loop->last_save < loop->options->save_every)
        return true;
    if (!loop->callbacks->save(loop->callbacks->context, loop->film, error))
        return false;
    loop->last_save = timing_now();
    return true;
}

/* One pass of `items` items. The first sample of every pixel is finished even when a stop is wanted, unless the stop
 * is repeated (the signal handler then ends the program): an image without holes is worth a moment. */
static bool pass_run(PassLoop *loop, uint items, Error *error)
{
    static const atomic_int never = 0;
    bool first = loop->next < loop->crop_pixels;
    uint64_t delivered = 0;
    loop->frame.sample_index = loop->options->first_sample + (uint)(loop->next / loop->crop_pixels);
    loop->frame.first_item = (uint)(loop->next % loop->crop_pixels);
    loop->frame.item_count = items;
    loop->frame.film_exponent = loop->film->quantum_exponent;
    const SplatSink sink = {film_splats, film_sums, film_sum_words(loop->film), loop->film};
    if (!loop->interface->run(loop->backend, &loop->frame, &loop->list, &sink,
                              first || !loop->options->stop ? &never : loop->options->stop, &delivered, error)) {
        loop->done += delivered; /* they are in the film */
        return false;
    }
    loop->next += items;
    loop->done += delivered;
    return true;
}

/* How many items the next pass takes, given the speed so far. */
static uint pass_items(const PassLoop *loop, double elapsed)
{
    double wanted = elapsed > 0.0 ? PASS_SECONDS * (double)loop->done / elapsed : PASS_ITEMS_MIN;
    uint items = wanted < PASS_ITEMS_MIN ? PASS_ITEMS_MIN : wanted > PASS_ITEMS_MAX ? PASS_ITEMS_MAX : (uint)wanted;
    uint64_t left = loop->total - loop->next;
    return left < items ? (uint)left : items;
}

static bool passes_run(PassLoop *loop, bool *stopped, Error *error)
{
    const RenderOptions *options = loop->options;
    loop->start = loop->last_save = timing_now();
    while (loop->next < loop->total) {
        double elapsed = timing_now() - loop->start;
        bool whole = loop->next >= loop->crop_pixels;
        if (whole && options->stop && *options->stop) {
            *stopped = true;
            break;
        }
        if (whole && options->seconds > 0.0 && elapsed >= options->seconds)
            break;
        if (!pass_run(loop, pass_items(loop, elapsed), error))
            return false;
        progress_report(loop, timing_now() - loop->start);
        if (!save_if_due(loop, timing_now(), error))
            return false;
    }
    *stopped = *stopped || (options->stop && *options->stop);
    return true;
}

static void result_fill(const PassLoop *loop, RenderResult *result)
{
    uint64_t counters[DIAGNOSTIC_COUNT] = {0};
    result->samples = loop->done;
    result->samples_per_pixel = (double)loop->done / (double)loop->crop_pixels;
    result->seconds = timing_now() - loop->start;
    loop->interface->statistics(loop->backend, &result->backend);
    loop->interface->diagnostics(loop->backend, counters);
    result->diagnostic_count = 0;
    for (int i = 0; i < DIAGNOSTIC_COUNT; ++i) {
        result->diagnostic_names[result->diagnostic_count] = DIAGNOSTIC_NAMES[i];
        result->diagnostics[result->diagnostic_count++] = counters[i];
    }
}

void render_frame(const Integrator *integrator, const Scene *scene, const RenderOptions *options, FrameParams *frame)
{
    *frame = scene->frame;
    frame->max_depth =
        (uint)(options->max_depth < integrator->depth_limit ? options->max_depth : integrator->depth_limit);
    frame->strategies = options->strategies ? options->strategies : integrator->strategies;
    frame->mis_exponent = options->balance ? 1 : 2;
    frame->only_s = options->only_strategy ? options->strategy[0] : NONE;
    frame->only_t = options->only_strategy ? options->strategy[1] : NONE;
    frame->unweighted = options->unweighted;
    frame->seed_low = (uint)options->seed;
    frame->seed_high = (uint)(options->seed >> 32);
    frame->sample_index = options->first_sample;
    frame->first_item = 0;
    frame->pixel_stride = 1;
}

/* Sets the quantum from what path tracing sees, whatever the integrator: films of all can be merged. */
static bool film_prepare(const PassLoop *loop, Error *error)
{
    StepList list;
    FrameParams frame = loop->frame;
    double mean = 0.0;
    frame.strategies = integrator_pt()->strategies;
    if (!integrator_pt()->list(&frame, &list, error))
        return false;
    bool done = pilot_run(loop->interface, loop->backend, frame, &list, &mean, error);
    step_list_destroy(&list);
    film_quantum_set(loop->film, mean);
    return done;
}

bool render_film(const Integrator *integrator, const Scene *scene, const BackendInterface *interface, Backend *backend,
                 const RenderOptions *options, bool keep_quantum, const RenderCallbacks *callbacks, Film *film,
                 RenderResult *result, Error *error)
{
    PassLoop loop = {
        .interface = interface, .backend = backend, .options = options, .callbacks = callbacks, .film = film};
    loop.crop_pixels = film_pixels(film);
    loop.total = loop.crop_pixels * (options->samples > 0 ? options->samples : PILOT_SAMPLE - options->first_sample);
    memset(result, 0, sizeof *result);
    render_frame(integrator, scene, options, &loop.frame);
    bool from_light = (integrator->strategies & (STRATEGY_CAMERA | STRATEGY_INNER)) != 0;
    if ((from_light && !film_light_reserve(film, error)) || !integrator->list(&loop.frame, &loop.list, error))
        return false;
    loop.start = timing_now();
    bool done = (keep_quantum || film_prepare(&loop, error)) && passes_run(&loop, &result->stopped, error);
    result_fill(&loop, result);
    step_list_destroy(&loop.list);
    return done;
}
