/* Path tracing: which kernels run when, pass by pass, until the budget is spent. */
#include "render.h"

#include "kernel_list.h"
#include "path_state.h"
#include "timing.h"

#include <assert.h>
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

/* ---- the list of steps ------------------------------------------------------------------------------------------ */

/* Two steps around the loop, seven in it, two in its last turn. */
static size_t steps_record(Step *steps, uint max_depth)
{
    size_t n = 0, last = 1 + (size_t)(max_depth - 1) * 7 + 2;
    steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_start_paths};
    for (uint depth = 1;; ++depth) {
        steps[n++] = (Step){.kind = STEP_TRACE_CLOSEST};
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_shade_hits, .live_only = true};
        if (depth == max_depth)
            break;
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_sample_lights, .live_only = true};
        steps[n++] = (Step){.kind = STEP_TRACE_SHADOW};
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_add_lights, .live_only = true};
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_extend_paths, .live_only = true};
        steps[n++] = (Step){.kind = STEP_SKIP_IF_IDLE, .target = (unsigned)last};
    }
    assert(n == last);
    steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_splat};
    return n;
}

#define PATH_FIELD(field, words, is_float, name)                                                                       \
    {                                                                                                                  \
        BUFFER_PATHS, field, words, is_float, name                                                                     \
    }
static const StateField PATH_FIELDS[] = {
    PATH_FIELD(PATH_PIXEL, 1, false, "pixel"),
    PATH_FIELD(PATH_SAMPLE, 1, false, "sample"),
    PATH_FIELD(PATH_DEPTH, 1, false, "depth"),
    PATH_FIELD(PATH_FLAGS, 1, false, "flags"),
    PATH_FIELD(PATH_WEIGHT, 1, true, "filter weight"),
    PATH_FIELD(PATH_BETA, 3, true, "throughput"),
    PATH_FIELD(PATH_RADIANCE, 3, true, "radiance"),
    PATH_FIELD(PATH_PDF_W, 1, true, "density of the last direction"),
    PATH_FIELD(PATH_ETA_SCALE, 1, true, "eta^2"),
    PATH_FIELD(PATH_POINT, 3, true, "vertex"),
    PATH_FIELD(PATH_NG, 3, true, "geometric normal"),
    PATH_FIELD(PATH_FRAME, 3, true, "shading normal"),
    PATH_FIELD(PATH_FRAME + 3, 3, true, "shading tangent"),
    PATH_FIELD(PATH_WO, 3, true, "outgoing direction"),
    PATH_FIELD(PATH_LIGHT, 3, true, "light sample"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_KIND, 1, false, "BSDF kind"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_FLAGS, 1, false, "BSDF flags"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_COLOR0, 3, true, "BSDF first colour"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_COLOR1, 3, true, "BSDF second colour"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_ALPHA_X, 1, true, "BSDF alpha x"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_ALPHA_Y, 1, true, "BSDF alpha y"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_ETA, 1, true, "BSDF eta"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_COAT, 1, false, "BSDF coat table"),
};
#undef PATH_FIELD

static bool step_list_make(StepList *list, uint max_depth, Error *error)
{
    size_t capacity = 4 + (size_t)max_depth * 7;
    Step *steps = malloc(capacity * sizeof *steps);
    if (!steps)
        return error_memory(error, capacity * sizeof *steps, "the list of steps");
    *list = (StepList){.steps = steps, .count = steps_record(steps, max_depth)};
    list->words_per_item[BUFFER_PATHS] = PATH_WORDS;
    list->words_per_item[BUFFER_RAYS] = RAY_WORDS;
    list->words_per_item[BUFFER_HITS] = HIT_WORDS;
    list->words_per_item[BUFFER_SHADOWS] = SHADOW_WORDS;
    list->words_per_item[BUFFER_SPLATS] = SPLAT_WORDS;
    list->fields = PATH_FIELDS;
    list->field_count = sizeof PATH_FIELDS / sizeof PATH_FIELDS[0];
    return true;
}

void step_list_destroy(StepList *list)
{
    free((void *)(uintptr_t)list->steps);
    *list = (StepList){0};
}

bool render_pt_list(const Scene *scene, const RenderOptions *options, StepList *list, FrameParams *frame, Error *error)
{
    *frame = scene->frame;
    frame->max_depth = (uint)options->max_depth;
    frame->seed_low = (uint)options->seed;
    frame->seed_high = (uint)(options->seed >> 32);
    frame->sample_index = options->first_sample;
    frame->first_item = 0;
    frame->pixel_stride = 1;
    return step_list_make(list, frame->max_depth, error);
}

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

static void pilot_sink(void *context, const uint *splats, uint count, uint stride)
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
    bool done = interface->run(backend, &frame, list, pilot_sink, pilot, &never, NULL, error);
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

static void film_sink(void *context, const uint *splats, uint count, uint stride)
{
    film_add_splats(context, splats, count, stride);
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
    if (!loop->interface->run(loop->backend, &loop->frame, &loop->list, film_sink, loop->film,
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

bool render_pt(const Scene *scene, const BackendInterface *interface, Backend *backend, const RenderOptions *options,
               bool keep_quantum, const RenderCallbacks *callbacks, Film *film, RenderResult *result, Error *error)
{
    PassLoop loop = {
        .interface = interface, .backend = backend, .options = options, .callbacks = callbacks, .film = film};
    loop.crop_pixels = film_pixels(film);
    loop.total = loop.crop_pixels * (options->samples > 0 ? options->samples : PILOT_SAMPLE - options->first_sample);
    memset(result, 0, sizeof *result);
    if (!render_pt_list(scene, options, &loop.list, &loop.frame, error))
        return false;
    loop.start = timing_now();
    bool done = true;
    if (!keep_quantum) {
        double mean = 0.0;
        done = pilot_run(interface, backend, loop.frame, &loop.list, &mean, error);
        film_quantum_set(film, mean);
    }
    done = done && passes_run(&loop, &result->stopped, error);
    result_fill(&loop, result);
    step_list_destroy(&loop.list);
    return done;
}
