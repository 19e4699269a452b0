#include "backend_cpu.h"

#include "base/processors.h"
#include "worker.h"

#include <embree3/rtcore.h>

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CHUNK_ITEMS_MIN 32u
#define CHUNKS_PER_THREAD 8u

#define THREADS_MAX 1024

typedef struct Thread {
    Worker worker;
    Backend *backend;
    pthread_t thread;
} Thread;

struct Backend {
    KernelScene *scene;
    RaysEmbree *rays;
    double build_seconds;
    uint thread_count;
    Thread *threads;
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

/* ---- the pool ---------------------------------------------------------------------------------------------------- */

/* Items per chunk. In a small pass, such as the first generations of chains, every thread should get several chunks.
 * Not when states are compared: if all items of a small chunk are dead, steps that clear state are skipped, which a
 * device with its larger batch would run. */
static uint chunk_items(const Job *job, const Backend *backend)
{
    if (job->inspect)
        return CHUNK_ITEMS;
    uint part = job->frame->pass.item_count / (CHUNKS_PER_THREAD * backend->thread_count);
    return part < CHUNK_ITEMS_MIN ? CHUNK_ITEMS_MIN : part < CHUNK_ITEMS ? part : CHUNK_ITEMS;
}

static void thread_run_job(Thread *thread, const Job *job)
{
    Backend *backend = thread->backend;
    uint size = chunk_items(job, backend), items = job->frame->pass.item_count,
         chunks = items / size + (items % size != 0);
    if (!worker_reserve(&thread->worker, job->list)) {
        atomic_store(&backend->out_of_memory, true);
        return;
    }
    while (!*job->stop) {
        uint chunk = atomic_fetch_add_explicit(&backend->next_chunk, 1, memory_order_relaxed);
        if (chunk >= chunks)
            return;
        uint first = chunk * size, count = items - first < size ? items - first : size;
        if (!worker_run_chunk(&thread->worker, job, first, count))
            return;
        atomic_fetch_add_explicit(&backend->items_done, count, memory_order_relaxed);
    }
}

/* Denormals are kept: no thread sets flush-to-zero, although Embree's manual advises it. */
static void *thread_main(void *argument)
{
    Thread *thread = argument;
    Backend *backend = thread->backend;
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
        thread_run_job(thread, &job);
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
    backend->busy = backend->thread_count;
    ++backend->generation;
    pthread_cond_broadcast(&backend->begin);
    while (backend->busy > 0)
        pthread_cond_wait(&backend->end, &backend->mutex);
    pthread_mutex_unlock(&backend->mutex);
    if (atomic_load(&backend->out_of_memory))
        return error_set(error, "out of memory for the state of %u threads", backend->thread_count);
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

static void threads_stop(Backend *backend)
{
    pthread_mutex_lock(&backend->mutex);
    backend->quit = true;
    pthread_cond_broadcast(&backend->begin);
    pthread_mutex_unlock(&backend->mutex);
    for (uint i = 0; i < backend->thread_count; ++i)
        pthread_join(backend->threads[i].thread, NULL);
}

static void backend_cpu_close(Backend *backend)
{
    if (!backend)
        return;
    threads_stop(backend);
    for (uint i = 0; i < backend->thread_count; ++i)
        worker_destroy(&backend->threads[i].worker);
    free(backend->threads);
    rays_embree_destroy(backend->rays);
    kernel_scene_destroy(backend->scene);
    pthread_cond_destroy(&backend->begin);
    pthread_cond_destroy(&backend->end);
    pthread_mutex_destroy(&backend->mutex);
    free(backend);
}

static uint thread_count_of(const BackendOptions *options)
{
    int count = options && options->threads > 0 ? options->threads : processors_usable();
    return count < 1 ? 1u : count > THREADS_MAX ? THREADS_MAX : (uint)count;
}

/* backend->thread_count counts the threads that were started, so that close joins no others. */
static bool threads_start(Backend *backend, uint count, Error *error)
{
    backend->threads = calloc(count, sizeof *backend->threads);
    if (!backend->threads)
        return error_memory(error, count * sizeof *backend->threads, "threads");
    for (uint i = 0; i < count; ++i) {
        Thread *thread = &backend->threads[i];
        thread->backend = backend;
        bool ready = worker_init(&thread->worker, backend->scene, backend->rays, error);
        if (ready && pthread_create(&thread->thread, NULL, thread_main, thread) != 0) {
            error_set(error, "cannot start thread %u of %u", i + 1, count);
            ready = error_fix(error, "use fewer, with --threads");
        }
        if (!ready) {
            worker_destroy(&thread->worker);
            return false;
        }
        ++backend->thread_count;
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
    uint threads = thread_count_of(options);
    uint64_t begin = nanoseconds_now();
    backend->scene = kernel_scene_create(scene, error);
    if (backend->scene)
        backend->rays = rays_embree_create(kernel_scene_view(backend->scene), (int)threads, error);
    backend->build_seconds = 1e-9 * (double)(nanoseconds_now() - begin);
    if (!backend->rays || !threads_start(backend, threads, error)) {
        backend_cpu_close(backend);
        return NULL;
    }
    return backend;
}

/* ---- diagnostics and statistics ---------------------------------------------------------------------------------- */

static void backend_cpu_diagnostics(Backend *backend, uint64_t *counters)
{
    memset(counters, 0, DIAGNOSTIC_COUNT * sizeof *counters);
    for (uint i = 0; i < backend->thread_count; ++i)
        for (int k = 0; k < DIAGNOSTIC_COUNT; ++k)
            counters[k] += backend->threads[i].worker.diagnostics[k];
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
    for (uint i = 0; i < backend->thread_count; ++i) {
        const Worker *worker = &backend->threads[i].worker;
        statistics->closest_rays += worker->closest_rays;
        statistics->shadow_rays += worker->shadow_rays;
        statistics->ray_seconds += 1e-9 * (double)worker->ray_nanoseconds;
        for (int id = 0; id < BUFFER_COUNT; ++id)
            statistics->bytes += worker->buffer_words[id] * sizeof(uint);
    }
    statistics->build_seconds = backend->build_seconds;
    statistics->threads = (int)backend->thread_count;
    cpu_name(statistics->device, sizeof statistics->device);
}

static size_t backend_cpu_devices(BackendDevice *devices, size_t capacity, bool probe_all)
{
    (void)probe_all; /* it is the reference for others */
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
    devices->promises_division = devices->rounds_division = true;
    devices->keeps_denormals = devices->atomics64 = devices->same_bits = true;
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
