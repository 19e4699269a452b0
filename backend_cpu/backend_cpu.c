#include "backend_cpu.h"

#include "chunk.h"
#include "kernel_list.h"
#include "kernel_scene.h"
#include "kernels.h"
#include "rays_embree.h"
#include "state.h"

#include <embree3/rtcore.h>

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define CHUNK_ITEMS_MIN 32u
#define CHUNKS_PER_THREAD 8u

#define THREADS_MAX 1024

/* What has happened to rays since `live` was made. */
typedef enum LiveList {
    LIVE_ANY, /* anything */
    LIVE_FEWER, /* only items of the list may have been touched */
    LIVE_SAME
} LiveList;

/* What a thread owns. */
typedef struct Worker {
    Backend *backend;
    pthread_t thread;
    FrameParams frame; /* the pass's, with first_item, item_count and stride of the chunk */
    void *kernel_frame; /* kernel_frame's storage */
    uint *buffers[BUFFER_COUNT]; /* per-item buffers and counters */
    size_t buffer_words[BUFFER_COUNT];
    uint64_t diagnostics[DIAGNOSTIC_COUNT];
    uint64_t closest_rays, shadow_rays, ray_nanoseconds;
    uint live[CHUNK_ITEMS]; /* items with a ray when worker_find_live looked last */
    uint live_count;
    LiveList live_list;
    char padding[64]; /* no two workers' counters on a cache line */
} Worker;

/* One call of run. */
typedef struct Job {
    const FrameParams *frame;
    const StepList *list;
    const SplatSink *sink; /* NULL: `inspect` is called */
    StateSink inspect;
    void *context;
    const atomic_int *stop;
} Job;

struct Backend {
    KernelScene *scene;
    RaysEmbree *rays;
    double build_seconds;
    uint worker_count;
    Worker *workers;
    /* Workers sleep until `generation` changes, then work on `job`; the caller of run sleeps until none is busy. */
    pthread_mutex_t mutex;
    pthread_cond_t begin, end;
    uint64_t generation;
    uint busy;
    bool quit;
    Job job;
    atomic_uint next_chunk;
    atomic_ullong items_done;
    atomic_bool out_of_memory;
};

static uint64_t nanoseconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

/* ---- one chunk --------------------------------------------------------------------------------------------------- */

static bool worker_reserve(Worker *worker, const StepList *list)
{
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id) {
        size_t words = id == BUFFER_DIAGNOSTICS ? DIAGNOSTIC_COUNT : (size_t)list->words_per_item[id] * CHUNK_STRIDE;
        if (words <= worker->buffer_words[id])
            continue;
        free(worker->buffers[id]);
        worker->buffer_words[id] = 0;
        worker->buffers[id] = kernel_state_create(words);
        if (!worker->buffers[id])
            return false;
        worker->buffer_words[id] = words;
    }
    return true;
}

/* What a kernel's BufferIds mean to this worker. */
static void worker_arguments(Worker *worker, const StepList *list, void *arguments[BUFFER_COUNT])
{
    const BackendScene *scene = kernel_scene_view(worker->backend->scene);
    for (int id = 0; id < BUFFER_COUNT; ++id)
        arguments[id] = worker->buffers[id];
    arguments[BUFFER_FRAME] = kernel_frame(worker->backend->scene, &worker->frame, worker->kernel_frame);
    arguments[BUFFER_PASS] = list->pass_words;
    /* Kernels take the scene as pointers to const; the array of arguments cannot say so. */
    arguments[BUFFER_GEOMETRY] = (void *)(uintptr_t)scene->geometry;
    arguments[BUFFER_TABLES] = (void *)(uintptr_t)scene->tables;
    arguments[BUFFER_TEXELS] = (void *)(uintptr_t)scene->texels;
}

static void worker_sum_diagnostics(Worker *worker)
{
    for (int i = 0; i < DIAGNOSTIC_COUNT; ++i) {
        worker->diagnostics[i] += worker->buffers[BUFFER_DIAGNOSTICS][i];
        worker->buffers[BUFFER_DIAGNOSTICS][i] = 0;
    }
}

/* Late segments are few: most paths have left the scene or were absorbed. A list of the living spares rays and kernels the
 * others. */
static void worker_find_live(Worker *worker, uint count)
{
    const uint *t_max = worker->buffers[BUFFER_RAYS] + (size_t)RAY_T_MAX * CHUNK_STRIDE;
    uint live = 0, before = worker->live_list == LIVE_ANY ? count : worker->live_count;
    if (worker->live_list == LIVE_SAME)
        return;
    for (uint i = 0; i < before; ++i) {
        uint t = worker->live_list == LIVE_ANY ? i : worker->live[i];
        worker->live[live] = t;
        live += bits_float(t_max[t]) > 0.0f;
    }
    worker->live_count = live;
    worker->live_list = LIVE_SAME;
}

static void worker_trace(Worker *worker, StepKind kind, uint count)
{
    const RaysEmbree *rays = worker->backend->rays;
    uint64_t begin = nanoseconds_now();
    if (kind == STEP_TRACE_CLOSEST)
        worker->closest_rays +=
            rays_embree_trace_closest(rays, worker->buffers[BUFFER_RAYS], worker->buffers[BUFFER_HITS], worker->live,
                                      worker->live_count, CHUNK_STRIDE);
    else
        worker->shadow_rays += rays_embree_trace_shadow(rays, worker->buffers[BUFFER_SHADOWS], count, CHUNK_STRIDE);
    worker->ray_nanoseconds += nanoseconds_now() - begin;
}

static void worker_run_kernel(Worker *worker, const Step *step, void *const *arguments, uint count)
{
    if (step->live_only)
        kernel_run(step->kernel, arguments, worker->live, worker->live_count);
    else
        kernel_run(step->kernel, arguments, NULL, count);
    worker->live_list = step->live_only && worker->live_list != LIVE_ANY ? LIVE_FEWER : LIVE_ANY;
}

/* Step i of the list; returns the next. */
static size_t worker_run_step(Worker *worker, const Job *job, size_t i, void *const *arguments, uint count)
{
    const Step *step = &job->list->steps[i];
    switch (step->kind) {
    case STEP_KERNEL:
        worker_run_kernel(worker, step, arguments, count);
        break;
    case STEP_TRACE_CLOSEST:
        worker_find_live(worker, count);
        worker_trace(worker, step->kind, count);
        break;
    case STEP_TRACE_SHADOW:
        worker_trace(worker, step->kind, count);
        break;
    case STEP_SKIP_IF_IDLE:
        worker_find_live(worker, count);
        if (worker->live_count == 0)
            return step->target;
        break;
    case STEP_SPLAT:
        if (!job->inspect)
            job->sink->splats(job->sink->context, worker->buffers[BUFFER_SPLATS], count, CHUNK_STRIDE);
        break;
    }
    return i + 1;
}

static void worker_clear_state(Worker *worker, const StepList *list)
{
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id)
        if (id != BUFFER_DIAGNOSTICS && list->words_per_item[id] > 0)
            memset(worker->buffers[id], 0, (size_t)list->words_per_item[id] * CHUNK_STRIDE * sizeof(uint));
}

static void worker_show_state(Worker *worker, const Job *job, uint first, uint count)
{
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id)
        if (id != BUFFER_DIAGNOSTICS && job->list->words_per_item[id] > 0)
            job->inspect(job->context, (BufferId)id, worker->buffers[id], first, count, CHUNK_STRIDE);
}

/* Items of a chunk: of a small pass, as the first generations of chains are, every thread is to have several. Not
 * where states are compared: a chunk of few items is idle, and leaves out what only clears, before a device's batch is. */
static uint chunk_items(const Job *job, const Backend *backend)
{
    if (job->inspect)
        return CHUNK_ITEMS;
    uint part = job->frame->item_count / (CHUNKS_PER_THREAD * backend->worker_count);
    return part < CHUNK_ITEMS_MIN ? CHUNK_ITEMS_MIN : part < CHUNK_ITEMS ? part : CHUNK_ITEMS;
}

static void worker_run_chunk(Worker *worker, const Job *job, uint chunk)
{
    uint size = chunk_items(job, worker->backend), first = chunk * size, left = job->frame->item_count - first;
    uint count = left < size ? left : size;
    void *arguments[BUFFER_COUNT];
    worker->frame = *job->frame;
    worker->frame.first_item = job->frame->first_item + first;
    worker->frame.item_count = count;
    worker->frame.stride = CHUNK_STRIDE;
    worker->frame.pass_first = 0;
    worker->frame.pass_stride = job->list->pass_stride;
    worker_arguments(worker, job->list, arguments);
    worker->live_list = LIVE_ANY;
    if (job->inspect)
        worker_clear_state(worker, job->list);
    for (size_t i = 0; i < job->list->count;)
        i = worker_run_step(worker, job, i, arguments, count);
    if (job->inspect)
        worker_show_state(worker, job, first, count);
    else if (job->list->words_per_item[BUFFER_SPLATS] > 0)
        job->sink->splats(job->sink->context, worker->buffers[BUFFER_SPLATS], count, CHUNK_STRIDE);
    worker_sum_diagnostics(worker);
    atomic_fetch_add_explicit(&worker->backend->items_done, count, memory_order_relaxed);
}

/* ---- the pool ---------------------------------------------------------------------------------------------------- */

static void worker_run_job(Worker *worker, const Job *job)
{
    Backend *backend = worker->backend;
    uint size = chunk_items(job, backend),
         chunks = job->frame->item_count / size + (job->frame->item_count % size != 0);
    if (!worker_reserve(worker, job->list)) {
        atomic_store(&backend->out_of_memory, true);
        return;
    }
    while (!*job->stop) {
        uint chunk = atomic_fetch_add_explicit(&backend->next_chunk, 1, memory_order_relaxed);
        if (chunk >= chunks)
            return;
        worker_run_chunk(worker, job, chunk);
    }
}

/* Denormals are kept: no thread sets flush-to-zero, although Embree's manual advises it. */
static void *worker_main(void *argument)
{
    Worker *worker = argument;
    Backend *backend = worker->backend;
    uint64_t seen = 0;
    pthread_mutex_lock(&backend->mutex);
    for (;;) {
        while (!backend->quit && backend->generation == seen)
            pthread_cond_wait(&backend->begin, &backend->mutex);
        if (backend->quit)
            break;
        seen = backend->generation;
        Job job = backend->job;
        pthread_mutex_unlock(&backend->mutex);
        worker_run_job(worker, &job);
        pthread_mutex_lock(&backend->mutex);
        if (--backend->busy == 0)
            pthread_cond_signal(&backend->end);
    }
    pthread_mutex_unlock(&backend->mutex);
    return NULL;
}

/* Hands the job to the workers and returns when none is busy. */
static bool job_run(Backend *backend, const Job *job, Error *error)
{
    pthread_mutex_lock(&backend->mutex);
    backend->job = *job;
    atomic_store(&backend->next_chunk, 0);
    atomic_store(&backend->items_done, 0);
    atomic_store(&backend->out_of_memory, false);
    backend->busy = backend->worker_count;
    ++backend->generation;
    pthread_cond_broadcast(&backend->begin);
    while (backend->busy > 0)
        pthread_cond_wait(&backend->end, &backend->mutex);
    pthread_mutex_unlock(&backend->mutex);
    if (atomic_load(&backend->out_of_memory))
        return error_set(error, "out of memory for the state of %u threads", backend->worker_count);
    return true;
}

static bool backend_cpu_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                            const atomic_int *stop, uint64_t *items_done, Error *error)
{
    const Job job = {.frame = frame, .list = list, .sink = sink, .stop = stop};
    bool done = job_run(backend, &job, error);
    if (items_done)
        *items_done = atomic_load(&backend->items_done);
    return done;
}

static bool backend_cpu_inspect(Backend *backend, const FrameParams *frame, const StepList *list, StateSink sink,
                                void *context, Error *error)
{
    static const atomic_int never = 0;
    const Job job = {.frame = frame, .list = list, .inspect = sink, .context = context, .stop = &never};
    return job_run(backend, &job, error);
}

/* ---- open and close ---------------------------------------------------------------------------------------------- */

static void workers_stop(Backend *backend)
{
    pthread_mutex_lock(&backend->mutex);
    backend->quit = true;
    pthread_cond_broadcast(&backend->begin);
    pthread_mutex_unlock(&backend->mutex);
    for (uint i = 0; i < backend->worker_count; ++i)
        pthread_join(backend->workers[i].thread, NULL);
}

static void backend_cpu_close(Backend *backend)
{
    if (!backend)
        return;
    workers_stop(backend);
    for (uint i = 0; i < backend->worker_count; ++i)
        for (int id = 0; id < BUFFER_COUNT; ++id)
            free(backend->workers[i].buffers[id]);
    for (uint i = 0; i < backend->worker_count; ++i)
        free(backend->workers[i].kernel_frame);
    free(backend->workers);
    rays_embree_destroy(backend->rays);
    kernel_scene_destroy(backend->scene);
    pthread_cond_destroy(&backend->begin);
    pthread_cond_destroy(&backend->end);
    pthread_mutex_destroy(&backend->mutex);
    free(backend);
}

static uint thread_count(const BackendOptions *options)
{
    long count = options && options->threads > 0 ? options->threads : sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1u : count > THREADS_MAX ? THREADS_MAX : (uint)count;
}

/* worker_count counts those that were started, so that close stops no other. */
static bool workers_start(Backend *backend, uint count, Error *error)
{
    backend->workers = calloc(count, sizeof *backend->workers);
    if (!backend->workers)
        return error_memory(error, count * sizeof *backend->workers, "threads");
    for (uint i = 0; i < count; ++i) {
        backend->workers[i].backend = backend;
        backend->workers[i].kernel_frame = malloc(kernel_frame_bytes() + 1);
        if (!backend->workers[i].kernel_frame)
            return error_memory(error, kernel_frame_bytes(), "threads");
        if (pthread_create(&backend->workers[i].thread, NULL, worker_main, &backend->workers[i]) != 0) {
            free(backend->workers[i].kernel_frame);
            error_set(error, "thread %u of %u cannot be started", i + 1, count);
            return error_fix(error, "ask for fewer with --threads");
        }
        ++backend->worker_count;
    }
    return true;
}

static Backend *backend_cpu_open(const BackendScene *scene, const BackendOptions *options, Error *error)
{
    Backend *backend = calloc(1, sizeof *backend);
    if (!backend) {
        error_memory(error, sizeof *backend, "the CPU backend");
        return NULL;
    }
    pthread_mutex_init(&backend->mutex, NULL);
    pthread_cond_init(&backend->begin, NULL);
    pthread_cond_init(&backend->end, NULL);
    uint threads = thread_count(options);
    uint64_t begin = nanoseconds_now();
    backend->scene = kernel_scene_create(scene, error);
    if (backend->scene)
        backend->rays = rays_embree_create(kernel_scene_view(backend->scene), (int)threads, error);
    backend->build_seconds = 1e-9 * (double)(nanoseconds_now() - begin);
    if (!backend->rays || !workers_start(backend, threads, error)) {
        backend_cpu_close(backend);
        return NULL;
    }
    return backend;
}

/* ---- what happened ----------------------------------------------------------------------------------------------- */

static void backend_cpu_diagnostics(Backend *backend, uint64_t *counters)
{
    memset(counters, 0, DIAGNOSTIC_COUNT * sizeof *counters);
    for (uint i = 0; i < backend->worker_count; ++i)
        for (int k = 0; k < DIAGNOSTIC_COUNT; ++k)
            counters[k] += backend->workers[i].diagnostics[k];
}

static void cpu_name(char *name, size_t size)
{
    char line[512];
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(name, size, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        char *value = strncmp(line, "model name", 10) == 0 ? strchr(line, ':') : NULL;
        if (!value)
            continue;
        line[strcspn(line, "\n")] = '\0';
        snprintf(name, size, "%s", value + 1 + strspn(value + 1, " "));
        break;
    }
    if (file)
        fclose(file);
}

static void backend_cpu_statistics(Backend *backend, BackendStatistics *statistics)
{
    memset(statistics, 0, sizeof *statistics);
    statistics->bytes = rays_embree_bytes(backend->rays);
    for (uint i = 0; i < backend->worker_count; ++i) {
        const Worker *worker = &backend->workers[i];
        statistics->closest_rays += worker->closest_rays;
        statistics->shadow_rays += worker->shadow_rays;
        statistics->ray_seconds += 1e-9 * (double)worker->ray_nanoseconds;
        for (int id = 0; id < BUFFER_COUNT; ++id)
            statistics->bytes += worker->buffer_words[id] * sizeof(uint);
    }
    statistics->build_seconds = backend->build_seconds;
    statistics->threads = (int)backend->worker_count;
    cpu_name(statistics->device, sizeof statistics->device);
}

static size_t backend_cpu_devices(BackendDevice *devices, size_t capacity)
{
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE), units = sysconf(_SC_NPROCESSORS_ONLN);
    if (capacity < 1)
        return 1;
    memset(devices, 0, sizeof *devices);
    cpu_name(devices->name, sizeof devices->name);
    snprintf(devices->platform, sizeof devices->platform, "threads and Embree");
    snprintf(devices->version, sizeof devices->version, "Embree %s", RTC_VERSION_STRING);
    snprintf(devices->kind, sizeof devices->kind, "CPU");
    devices->memory = pages > 0 && page > 0 ? (uint64_t)pages * (uint64_t)page : 0;
    devices->allocation_limit = devices->memory;
    devices->units = units > 0 ? (unsigned)units : 1u;
    devices->rounds_division = devices->keeps_denormals = devices->atomics64 = devices->same_bits = true;
    return 1;
}

const BackendInterface *backend_cpu(void)
{
    static const BackendInterface interface = {.name = "cpu",
                                               .devices = backend_cpu_devices,
                                               .open = backend_cpu_open,
                                               .close = backend_cpu_close,
                                               .run = backend_cpu_run,
                                               .inspect = backend_cpu_inspect,
                                               .diagnostics = backend_cpu_diagnostics,
                                               .statistics = backend_cpu_statistics};
    return &interface;
}
