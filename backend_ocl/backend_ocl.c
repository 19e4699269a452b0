#include "backend_ocl.h"

#include "backend/bvh.h"
#include "base/log.h"
#include "base/processors.h"
#include "device_film.h"
#include "film_adders.h"
#include "inspect.h"
#include "pass_data.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Default number of threads that add splats to the film; more would exceed what one device keeps busy. */
#define ADDERS_DEFAULT 8

/* Work-items per work-group. Kernels use neither local memory nor barriers, so any multiple of the devices' SIMD width
 * will do. */
#define GROUP_ITEMS 64u

/* BackendStatistics.width of a GPU per compute unit. Its commands start one after the other, with delays in which it is
 * idle; an H100 runs 2048 work-items on each of its 132 units. */
#define WIDTH_PER_GPU_UNIT 1024u

struct Backend {
    OclDevice device;
    cl_context context;
    cl_command_queue compute, copy;
    Timeline timeline;
    Launcher launcher;
    DeviceMemory memory;
    FilmAdders *adders;
    int adder_count;
    Batch batches[BATCH_SLOTS];
    FilmPlace film;
    int slots; /* batches in flight: BATCH_SLOTS, or 1 without overlap */
    uint64_t next_batch;
    double build_seconds;
    bool failed; /* a batch failed, so the device's state cannot be trusted */
};

/* ---- open and close ---------------------------------------------------------------------------------------------- */

static bool queues_make(Backend *backend, Error *error)
{
    cl_int status;
    const char *name = backend->device.info.name;
    const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)backend->device.platform,
                                                0};
    backend->context = clCreateContext(properties, 1, &backend->device.id, NULL, NULL, &status);
    if (status != CL_SUCCESS)
        return ocl_fail(error, name, "opening the device", status);
    backend->compute = clCreateCommandQueue(backend->context, backend->device.id, CL_QUEUE_PROFILING_ENABLE, &status);
    if (status == CL_SUCCESS)
        backend->copy = clCreateCommandQueue(backend->context, backend->device.id, CL_QUEUE_PROFILING_ENABLE, &status);
    return status == CL_SUCCESS || ocl_fail(error, name, "making a queue", status);
}

/* Trusts a driver that claims correct rounding; otherwise a probe decides. */
static void rounding_ask(OclDevice *device)
{
    const BackendDevice *info = &device->info;
    if (!info->promises_division)
        ocl_device_probe(device, false);
    if (!info->same_bits)
        log_message(LOG_WARNING, "%s lacks %s%s%s: the image may differ from the CPU's in the last bits", info->name,
                    info->rounds_division ? "" : "correctly rounded division and square roots",
                    !info->rounds_division && !info->keeps_denormals ? " and " : "",
                    info->keeps_denormals ? "" : "denormal numbers");
}

static int adder_count(const BackendOptions *options)
{
    int count = options->threads > 0 ? options->threads : processors_usable();
    return options->threads > 0 || count < ADDERS_DEFAULT ? count : ADDERS_DEFAULT;
}

static bool environment_is(const char *name, const char *value)
{
    const char *text = getenv(name);
    return text && strcmp(text, value) == 0;
}

static void launcher_init(Backend *backend, const BackendOptions *options)
{
    Launcher *launcher = &backend->launcher;
    const char *fail = getenv("TWINLIGHT_TEST_FAIL_BATCH");
    launcher->device = &backend->device;
    launcher->compute = backend->compute;
    launcher->copy = backend->copy;
    launcher->memory = &backend->memory;
    launcher->records = options->record_spans;
    launcher->group = backend->device.group_limit < GROUP_ITEMS ? 1 : GROUP_ITEMS;
    launcher->first_check = 2;
    launcher->check_every = 1;
    launcher->fail_at = fail ? strtoull(fail, NULL, 10) : UINT64_MAX;
}

static bool scene_build(Backend *backend, const BackendScene *scene, const BackendOptions *options, Error *error)
{
    Bvh bvh = {0};
    if (!bvh_build(scene, &bvh, error))
        return false;
    backend->build_seconds = bvh.build_seconds;
    bool done =
        device_memory_init(&backend->memory, backend->context, backend->compute, &backend->device, scene, &bvh, error);
    backend->memory.batch_wanted = options->batch;
    bvh_destroy(&bvh);
    return done;
}

static bool backend_build(Backend *backend, const BackendScene *scene, const BackendOptions *options, Error *error)
{
    if (!ocl_device_choose(options->device, &backend->device, error) ||
        (options->film == FILM_ON_DEVICE && !device_film_check(&backend->device, error)))
        return false;
    backend->film = options->film;
    rounding_ask(&backend->device);
    backend->adder_count = adder_count(options);
    backend->slots = environment_is("TWINLIGHT_OVERLAP", "0") ? 1 : BATCH_SLOTS;
    if (!timeline_init(&backend->timeline, options->record_spans, error) || !queues_make(backend, error))
        return false;
    launcher_init(backend, options);
    if (!ocl_program_init(&backend->launcher.program, backend->context, &backend->device, frame_features(scene->frame),
                          error) ||
        !scene_build(backend, scene, options, error))
        return false;
    timeline_synchronize(&backend->timeline, backend->compute, backend->memory.scene[BUFFER_GEOMETRY]);
    backend->adders = adders_create(backend->adder_count, &backend->timeline, error);
    return backend->adders != NULL;
}

static void backend_ocl_close(Backend *backend)
{
    if (!backend)
        return;
    adders_destroy(backend->adders);
    for (int i = 0; i < BATCH_SLOTS; ++i)
        batch_drop(&backend->batches[i]);
    device_memory_destroy(&backend->memory);
    ocl_program_destroy(&backend->launcher.program);
    if (backend->copy)
        clReleaseCommandQueue(backend->copy);
    if (backend->compute)
        clReleaseCommandQueue(backend->compute);
    if (backend->context)
        clReleaseContext(backend->context);
    timeline_destroy(&backend->timeline);
    free(backend);
}

static Backend *backend_ocl_open(const BackendScene *scene, const BackendOptions *options, Error *error)
{
    static const BackendOptions DEFAULTS;
    Backend *backend = calloc(1, sizeof *backend);
    if (!backend) {
        error_memory(error, sizeof *backend, "the OpenCL backend");
        return NULL;
    }
    if (!backend_build(backend, scene, options ? options : &DEFAULTS, error)) {
        backend_ocl_close(backend);
        return NULL;
    }
    return backend;
}

/* ---- a pass ------------------------------------------------------------------------------------------------------ */

static Batch *batch_prepare(Backend *backend, int slot, const FrameParams *frame, uint first, uint count)
{
    Batch *batch = &backend->batches[slot];
    batch->memory = &backend->memory.batches[slot];
    batch->number = backend->next_batch++;
    batch->frame = *frame;
    batch->frame.pass.first_item = frame->pass.first_item + first;
    batch->frame.pass.item_count = count;
    batch->frame.pass.stride = device_memory_stride(count);
    batch->frame.pass.data_first = frame->pass.first_item;
    batch->frame.pass.data_stride = frame->pass.item_count;
    return batch;
}

static bool batch_start(Backend *backend, int slot, Batch *batch, const StepList *list, bool *dropped, Error *error)
{
    if (!batch_launch(&backend->launcher, batch, list, dropped, error))
        return false;
    if (!*dropped)
        adders_push(backend->adders, slot, batch);
    return true;
}

static bool device_failed(Backend *backend, Error *error)
{
    AddersTotal total;
    adders_total(backend->adders, &total);
    if (total.status == CL_SUCCESS)
        return false;
    ocl_fail(error, backend->device.info.name, "computing", total.status);
    return true;
}

static bool batches_run(Backend *backend, const FrameParams *frame, const StepList *list, const atomic_int *stop,
                        bool *dropped, Error *error)
{
    uint batch = device_memory_batch(&backend->memory, list);
    for (uint first = 0; first < frame->pass.item_count && !*stop && !*dropped;) {
        uint left = frame->pass.item_count - first, count = left < batch ? left : batch;
        int slot = (int)(backend->next_batch % (uint64_t)backend->slots);
        adders_wait(backend->adders, slot);
        if (device_failed(backend, error))
            return false;
        if (!batch_start(backend, slot, batch_prepare(backend, slot, frame, first, count), list, dropped, error))
            return false;
        if (backend->slots == 1)
            adders_wait(backend->adders, slot);
        first += count;
    }
    return true;
}

/* For a GPU: estimated, not measured, that the sums of a pass cost as much to clear, copy and merge as that many splats
 * to copy and add. */
static bool film_is_on_device(const Backend *backend, const FrameParams *frame, const StepList *list,
                              const SplatSink *sink)
{
    uint64_t splats = (uint64_t)frame->pass.item_count * step_list_splats(list);
    if (backend->film != FILM_BY_DEVICE)
        return backend->film == FILM_ON_DEVICE;
    return ocl_device_is_gpu(&backend->device) && backend->device.info.atomics64 && splats >= sink->sum_words &&
           device_memory_film_fits(&backend->memory, sink->sum_words * sizeof(cl_ulong));
}

/* Runs all batches and waits until no command is in flight. */
static bool pass_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                     const atomic_int *stop, Error *error)
{
    Launcher *launcher = &backend->launcher;
    bool splats = list->words_per_item[BUFFER_SPLATS] > 0 && sink->splats;
    launcher->adds = splats && sink->sums && film_is_on_device(backend, frame, list, sink);
    launcher->stop = stop;
    launcher->whole = sink->whole;
    adders_begin(backend->adders, splats && !launcher->adds ? sink : NULL);
    bool dropped = false;
    bool done = (!launcher->adds || device_film_begin(&backend->memory, sink->sum_words, error)) &&
                batches_run(backend, frame, list, stop, &dropped, error);
    if (!done || dropped) { /* a batch that was launched in part writes to host memory until the queues are empty */
        clFinish(backend->compute);
        clFinish(backend->copy);
    }
    for (int slot = 0; slot < BATCH_SLOTS; ++slot)
        adders_wait(backend->adders, slot);
    return done && !device_failed(backend, error) &&
           (!launcher->adds ||
            device_film_end(&backend->memory, sink, &backend->timeline, backend->next_batch - 1, error));
}

static bool backend_ocl_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                            const atomic_int *stop, uint64_t *items_done, Error *error)
{
    AddersTotal total;
    if (items_done)
        *items_done = 0;
    if (backend->failed)
        return error_set(error, "%s has failed in an earlier pass", backend->device.info.name);
    if (!device_memory_reserve(&backend->memory, list, error) || !pass_data_begin(&backend->memory, frame, list, error))
        return false;
    bool done =
        pass_run(backend, frame, list, sink, stop, error) && pass_data_end(&backend->memory, frame, list, error);
    backend->failed = !done;
    adders_total(backend->adders, &total);
    if (items_done && (done || !backend->launcher.adds))
        *items_done = total.items;
    backend->launcher.adds = false; /* `inspect` expects both to be reset */
    backend->launcher.stop = NULL;
    return done;
}

/* Runs one batch at a time; does not count in the statistics. */
static bool backend_ocl_inspect(Backend *backend, const FrameParams *frame, const StepList *list, StateSink sink,
                                void *context, Error *error)
{
    bool done =
        device_memory_reserve(&backend->memory, list, error) && pass_data_begin(&backend->memory, frame, list, error);
    uint size = device_memory_batch(&backend->memory, list);
    for (uint first = 0; done && first < frame->pass.item_count; first += size) {
        uint left = frame->pass.item_count - first;
        Batch *batch = batch_prepare(backend, 0, frame, first, left < size ? left : size);
        done = inspect_batch(&backend->launcher, batch, list, first, sink, context, error);
        batch_drop(batch);
    }
    return done && pass_data_end(&backend->memory, frame, list, error);
}

/* ---- diagnostics and statistics ---------------------------------------------------------------------------------- */

static void backend_ocl_diagnostics(Backend *backend, uint64_t *counters)
{
    AddersTotal total;
    adders_total(backend->adders, &total);
    memcpy(counters, total.diagnostics, sizeof total.diagnostics);
}

static void backend_ocl_statistics(Backend *backend, BackendStatistics *statistics)
{
    AddersTotal total;
    const BackendDevice *info = &backend->device.info;
    adders_total(backend->adders, &total);
    memset(statistics, 0, sizeof *statistics);
    statistics->closest_rays = total.closest_rays;
    statistics->shadow_rays = total.shadow_rays;
    statistics->ray_seconds = 1e-9 * (double)total.ray_nanoseconds;
    statistics->build_seconds = backend->build_seconds;
    statistics->bytes = backend->memory.bytes;
    statistics->threads = backend->adder_count;
    statistics->width = ocl_device_is_gpu(&backend->device) ? WIDTH_PER_GPU_UNIT * info->units : 0;
    snprintf(statistics->device, sizeof statistics->device, "%s", info->name);
}

static size_t backend_ocl_spans(Backend *backend, const BackendSpan **spans, uint64_t *dropped)
{
    *spans = backend->timeline.spans;
    *dropped = backend->timeline.dropped;
    return backend->timeline.count;
}

const BackendInterface *backend_ocl(void)
{
    static const BackendInterface interface = {.name = "opencl",
                                               .devices = ocl_devices_list,
                                               .device_index = ocl_device_index,
                                               .open = backend_ocl_open,
                                               .close = backend_ocl_close,
                                               .run = backend_ocl_run,
                                               .inspect = backend_ocl_inspect,
                                               .diagnostics = backend_ocl_diagnostics,
                                               .statistics = backend_ocl_statistics,
                                               .spans = backend_ocl_spans};
    return &interface;
}
