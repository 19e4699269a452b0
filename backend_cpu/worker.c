#include "worker.h"

#include "kernels.h"
#include "layout/kernel_list.h"
#include "layout/state.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

uint64_t nanoseconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

bool worker_init(Worker *worker, KernelScene *scene, const RaysEmbree *rays, Error *error)
{
    worker->scene = scene;
    worker->rays = rays;
    worker->kernel_frame = malloc(kernel_frame_bytes() + 1);
    worker->kernel_guide = malloc(kernel_guide_bytes() + 1);
    return (worker->kernel_frame && worker->kernel_guide) ||
           error_memory(error, kernel_frame_bytes() + kernel_guide_bytes(), "threads");
}

void worker_destroy(Worker *worker)
{
    for (int id = 0; id < BUFFER_COUNT; ++id)
        free(worker->buffers[id]);
    free(worker->kernel_frame);
    free(worker->kernel_guide);
    *worker = (Worker){0};
}

bool worker_reserve(Worker *worker, const StepList *list)
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

/* Sets the arguments of kernels, by BufferId, to this worker's buffers and the scene. */
static void worker_arguments(Worker *worker, const StepList *list, void *arguments[BUFFER_COUNT])
{
    const BackendScene *scene = kernel_scene_view(worker->scene);
    for (int id = 0; id < BUFFER_COUNT; ++id)
        arguments[id] = worker->buffers[id];
    arguments[BUFFER_FRAME] = kernel_frame(worker->scene, &worker->frame, worker->kernel_frame);
    arguments[BUFFER_GUIDE] = kernel_guide(list->guide, worker->kernel_guide);
    arguments[BUFFER_PHOTONS] = list->photons ? list->photons->words : NULL;
    arguments[BUFFER_PASS] = list->pass_words;
    /* Kernels take the scene as pointers to const, which the array of arguments cannot express. */
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

/* In late segments few items are live: most paths have left the scene or were absorbed. A list of the live items spares
 * ray queries and kernels the others. */
static void worker_find_live(Worker *worker, uint count)
{
    const uint *t_max = worker->buffers[BUFFER_RAYS] + (size_t)RAY_T_MAX * CHUNK_STRIDE;
    uint live = 0, before = worker->live_list == LIVE_ANY ? count : worker->live_count;
    if (worker->live_list == LIVE_SAME)
        return;
    for (uint i = 0; i < before; ++i) {
        uint item = worker->live_list == LIVE_ANY ? i : worker->live[i];
        worker->live[live] = item;
        live += bits_float(t_max[item]) > 0.0f;
    }
    worker->live_count = live;
    worker->live_list = LIVE_SAME;
}

static void worker_trace(Worker *worker, StepKind kind, uint count)
{
    const RaysEmbree *rays = worker->rays;
    uint64_t begin = nanoseconds_now();
    if (kind == STEP_TRACE_CLOSEST)
        worker->closest_rays += rays_embree_trace_closest(
            rays, worker->buffers[BUFFER_RAYS], worker->buffers[BUFFER_HITS], worker->buffers[BUFFER_DIAGNOSTICS],
            worker->live, worker->live_count, CHUNK_STRIDE);
    else
        worker->shadow_rays += rays_embree_trace_shadow(rays, worker->buffers[BUFFER_SHADOWS],
                                                        worker->buffers[BUFFER_DIAGNOSTICS], count, CHUNK_STRIDE);
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

static void splats_hand_on(Worker *worker, const Job *job, uint count)
{
    if (!job->inspect && job->sink->splats)
        job->sink->splats(job->sink->context, worker->buffers[BUFFER_SPLATS], count, CHUNK_STRIDE);
}

/* Runs step i of the list; returns the index of the next. */
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
        splats_hand_on(worker, job, count);
        worker->splatted = true;
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

/* Whether a stop drops the chunk at this point: either the film has nothing of it yet, or it has no use for part of a
 * pass. */
static bool chunk_dropped(const Worker *worker, const Job *job)
{
    return *job->stop && (!worker->splatted || job->sink->whole);
}

/* Runs the steps of the list; false if they were stopped before the end. */
static bool worker_run_steps(Worker *worker, const Job *job, uint count)
{
    void *arguments[BUFFER_COUNT];
    worker_arguments(worker, job->list, arguments);
    worker->live_list = LIVE_ANY;
    worker->splatted = false;
    for (size_t i = 0; i < job->list->count;) {
        if (chunk_dropped(worker, job))
            return false;
        i = worker_run_step(worker, job, i, arguments, count);
    }
    return true;
}

bool worker_run_chunk(Worker *worker, const Job *job, uint first, uint count)
{
    worker->frame = *job->frame;
    worker->frame.pass.first_item = job->frame->pass.first_item + first;
    worker->frame.pass.item_count = count;
    worker->frame.pass.stride = CHUNK_STRIDE;
    worker->frame.pass.data_first = 0;
    worker->frame.pass.data_stride = job->list->pass_stride;
    if (job->inspect)
        worker_clear_state(worker, job->list);
    bool done = worker_run_steps(worker, job, count);
    if (done && job->inspect)
        worker_show_state(worker, job, first, count);
    else if (done && job->list->words_per_item[BUFFER_SPLATS] > 0)
        splats_hand_on(worker, job, count);
    worker_sum_diagnostics(worker);
    return done;
}
