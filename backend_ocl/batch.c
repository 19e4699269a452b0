#include "batch.h"

#include <stdlib.h>
#include <string.h>

/* Ray queries that the host enqueues ahead of the device at most: commands in a queue cannot be cancelled. */
#define TRACES_AHEAD 4u

/* A launch in progress. */
typedef struct Launch {
    Launcher *launcher;
    Batch *batch;
    const StepList *list;
    Error *error;
    uint turn; /* number of closest-hit queries so far */
    cl_event counted; /* pending read of the latest number of live rays */
    uint idle_turn; /* turn that had no live ray; 0: none so far */
    size_t traces[TRACES_AHEAD]; /* ring of the latest ray queries' events, as indices into batch->events */
    uint traced; /* number of ray queries so far */
    bool splatted; /* the film has received, or will receive, splats of the batch */
} Launch;

static bool check(Launch *launch, cl_int status, const char *what)
{
    return status == CL_SUCCESS || ocl_fail(launch->error, launch->launcher->device->info.name, what, status);
}

/* ---- events ------------------------------------------------------------------------------------------------------ */

/* Returns where to store the event of a command called `name`; NULL in *slot if it is not needed. */
static bool event_slot(Launch *launch, const char *name, bool traces, cl_event **slot)
{
    Batch *batch = launch->batch;
    *slot = NULL;
    if (!traces && !launch->launcher->records)
        return true;
    if (batch->event_count == batch->event_capacity) {
        size_t capacity = 2 * batch->event_capacity + 64;
        BatchEvent *events = realloc(batch->events, capacity * sizeof *events);
        if (!events)
            return error_memory(launch->error, capacity * sizeof *events, "events");
        batch->events = events;
        batch->event_capacity = capacity;
    }
    BatchEvent *event = &batch->events[batch->event_count++];
    *event = (BatchEvent){NULL, name, traces};
    *slot = &event->event;
    return true;
}

static void events_release(Batch *batch)
{
    for (size_t i = 0; i < batch->event_count; ++i)
        if (batch->events[i].event)
            clReleaseEvent(batch->events[i].event);
    batch->event_count = 0;
    if (batch->copied)
        clReleaseEvent(batch->copied);
    batch->copied = NULL;
}

/* ---- kernels ----------------------------------------------------------------------------------------------------- */

#define KERNEL_ARGUMENTS(name, count, ...) {count, {__VA_ARGS__}},
static const struct KernelArguments {
    uint count;
    BufferId buffers[12];
} ARGUMENTS[KERNEL_COUNT] = {KERNEL_LIST(KERNEL_ARGUMENTS)};
#undef KERNEL_ARGUMENTS

static cl_mem argument(const Launch *launch, BufferId id)
{
    const DeviceMemory *memory = launch->launcher->memory;
    switch (id) {
    case BUFFER_FRAME:
        return launch->batch->memory->frame;
    case BUFFER_SPLATS:
        return launch->batch->memory->splats;
    case BUFFER_FILM:
        return memory->film;
    case BUFFER_GUIDE:
        return memory->guide;
    case BUFFER_PHOTONS:
        return memory->photons;
    case BUFFER_GEOMETRY:
    case BUFFER_TABLES:
    case BUFFER_TEXELS:
    case BUFFER_BVH:
        return memory->scene[id];
    default:
        return memory->state[id];
    }
}

/* Enqueues `kernel` for `items` items, rounded up to whole work-groups; kernels ignore excess work-items. */
static bool kernel_enqueue(Launch *launch, unsigned number, uint items, bool traces)
{
    Launcher *launcher = launch->launcher;
    const char *name = ocl_kernel_name(number);
    cl_kernel kernel = ocl_program_kernel(&launcher->program, number, launch->error);
    cl_event *event;
    if (!kernel || !event_slot(launch, name, traces, &event))
        return false;
    for (uint i = 0; i < ARGUMENTS[number].count; ++i) {
        cl_mem buffer = argument(launch, ARGUMENTS[number].buffers[i]);
        if (!check(launch, clSetKernelArg(kernel, i, sizeof buffer, &buffer), name))
            return false;
    }
    size_t local = launcher->group, global = (items + local - 1) / local * local;
    return check(launch, clEnqueueNDRangeKernel(launcher->compute, kernel, 1, NULL, &global, &local, 0, NULL, event),
                 name);
}

/* Enqueues a ray query once the device is at most TRACES_AHEAD queries behind. */
static bool trace_enqueue(Launch *launch, unsigned number)
{
    size_t *place = &launch->traces[launch->traced % TRACES_AHEAD];
    if (launch->traced >= TRACES_AHEAD &&
        (!check(launch, clFlush(launch->launcher->compute), "starting commands") ||
         !check(launch, clWaitForEvents(1, &launch->batch->events[*place].event), "tracing rays")))
        return false;
    *place = launch->batch->event_count;
    ++launch->traced;
    return kernel_enqueue(launch, number, launch->batch->frame.pass.item_count, true);
}

/* ---- steps ------------------------------------------------------------------------------------------------------- */

static bool buffer_write(Launch *launch, cl_mem buffer, const void *from, size_t bytes)
{
    return check(launch,
                 clEnqueueWriteBuffer(launch->launcher->compute, buffer, CL_FALSE, 0, bytes, from, 0, NULL, NULL),
                 "writing parameters");
}

static bool batch_begin(Launch *launch)
{
    static const uint ZEROS[COUNT_WORDS + DIAGNOSTIC_COUNT];
    const DeviceMemory *memory = launch->launcher->memory;
    Batch *batch = launch->batch;
    if (batch->number == launch->launcher->fail_at)
        return check(launch, CL_OUT_OF_RESOURCES, "computing (as TWINLIGHT_TEST_FAIL_BATCH requests)");
    return buffer_write(launch, batch->memory->frame, &batch->frame, sizeof batch->frame) &&
           buffer_write(launch, memory->state[BUFFER_COUNTS], ZEROS, COUNT_WORDS * sizeof(uint)) &&
           buffer_write(launch, memory->state[BUFFER_DIAGNOSTICS], ZEROS, DIAGNOSTIC_COUNT * sizeof(uint));
}

static void counted_release(Launch *launch)
{
    if (launch->counted)
        clReleaseEvent(launch->counted);
    launch->counted = NULL;
}

static bool turn_is_checked(const Launch *launch, uint turn)
{
    return turn >= launch->launcher->first_check && turn % launch->launcher->check_every == 0;
}

/* Counts live rays and traces them. Before a check, the count of this turn and of the one before is read back while the
 * rays are traced, so that the device stays busy while the host waits for it. */
static bool trace_closest(Launch *launch)
{
    Launcher *launcher = launch->launcher;
    uint items = launch->batch->frame.pass.item_count;
    ++launch->turn;
    counted_release(launch);
    if (!kernel_enqueue(launch, KERNEL_count_closest, (items + COUNT_RAYS - 1) / COUNT_RAYS, false))
        return false;
    if ((turn_is_checked(launch, launch->turn) || turn_is_checked(launch, launch->turn + 1)) &&
        !check(launch,
               clEnqueueReadBuffer(launcher->compute, launcher->memory->state[BUFFER_COUNTS], CL_FALSE,
                                   COUNT_CLOSEST * sizeof(uint), sizeof(uint),
                                   &launch->batch->memory->results->live[launch->turn % 2], 0, NULL, &launch->counted),
               "reading the number of rays"))
        return false;
    return trace_enqueue(launch, KERNEL_trace_closest);
}

static bool trace_shadow(Launch *launch)
{
    uint items = launch->batch->frame.pass.item_count;
    return kernel_enqueue(launch, KERNEL_count_shadow, (items + COUNT_RAYS - 1) / COUNT_RAYS, false) &&
           trace_enqueue(launch, KERNEL_trace_shadow);
}

static bool splats_add(Launch *launch)
{
    return kernel_enqueue(launch, KERNEL_film_add, launch->batch->frame.pass.item_count, false);
}

/* Appends the splats to those of earlier STEP_SPLATs, in the same buffer. */
static bool splats_put_aside(Launch *launch)
{
    Batch *batch = launch->batch;
    cl_mem splats = batch->memory->splats;
    size_t bytes = (size_t)batch->frame.pass.stride * launch->list->words_per_item[BUFFER_SPLATS] * sizeof(uint);
    size_t to = batch->splat_sections++ * bytes;
    cl_event *event;
    return event_slot(launch, "put splats aside", false, &event) &&
           check(launch, clEnqueueCopyBuffer(launch->launcher->compute, splats, splats, 0, to, bytes, 0, NULL, event),
                 "putting splats aside");
}

/* Sets *idle if the turn just enqueued has no live ray; false in turns without a check. */
static bool turn_was_idle(Launch *launch, bool *idle)
{
    *idle = false;
    if (!turn_is_checked(launch, launch->turn))
        return true;
    if (!check(launch, clFlush(launch->launcher->compute), "starting commands") ||
        !check(launch, clWaitForEvents(1, &launch->counted), "tracing rays"))
        return false;
    /* The counter is cumulative, and the queue is in order, so the count of the turn before has been read as well. */
    const uint *live = launch->batch->memory->results->live;
    *idle = live[0] == live[1];
    if (*idle)
        launch->idle_turn = launch->turn;
    return true;
}

/* Whether a stop ends the batch here: the film has no part of it, or is useless without the whole pass. */
static bool stop_wanted(const Launch *launch)
{
    const Launcher *launcher = launch->launcher;
    return launcher->stop && *launcher->stop && (!launch->splatted || launcher->whole);
}

static bool steps_enqueue(Launch *launch, bool *dropped)
{
    const StepList *list = launch->list;
    bool idle, done = true;
    for (size_t i = 0; i < list->count && done; ++i) {
        *dropped = stop_wanted(launch);
        if (*dropped)
            return true;
        const Step *step = &list->steps[i];
        switch (step->kind) {
        case STEP_KERNEL:
            done = kernel_enqueue(launch, step->kernel, launch->batch->frame.pass.item_count, false);
            break;
        case STEP_TRACE_CLOSEST:
            done = trace_closest(launch);
            break;
        case STEP_TRACE_SHADOW:
            done = trace_shadow(launch);
            break;
        case STEP_SPLAT:
            done = launch->launcher->adds ? splats_add(launch) : splats_put_aside(launch);
            launch->splatted = launch->launcher->adds;
            break;
        case STEP_SKIP_IF_IDLE:
            done = turn_was_idle(launch, &idle);
            if (done && idle)
                i = step->target - 1;
            break;
        }
    }
    return done;
}

/* Turns from one check to the next on a GPU, which would wait for the host at each; not tuned (docs/TUNING.md). */
#define GPU_CHECK_EVERY 4u

/* The next batch starts to check for live rays one turn before this one ended, since batches differ by a turn or two.
 * With several walks in the list, each of which may end early, checks begin at once. */
static void first_check_adapt(Launch *launch)
{
    Launcher *launcher = launch->launcher;
    unsigned target = 0;
    for (size_t i = 0; i < launch->list->count; ++i) {
        if (launch->list->steps[i].kind != STEP_SKIP_IF_IDLE)
            continue;
        if (target > 0 && launch->list->steps[i].target != target) {
            launcher->first_check = 2;
            launcher->check_every = ocl_device_is_gpu(launcher->device) ? GPU_CHECK_EVERY : 1;
            return;
        }
        target = launch->list->steps[i].target;
    }
    uint turns = launch->idle_turn > 0 ? launch->idle_turn : launch->turn;
    launcher->first_check = turns > 2 ? turns - 1 : 2;
    launcher->check_every = 1;
}

/* ---- results ----------------------------------------------------------------------------------------------------- */

static bool results_read(Launch *launch)
{
    Launcher *launcher = launch->launcher;
    const DeviceMemory *memory = launcher->memory;
    Batch *batch = launch->batch;
    BatchResults *results = batch->memory->results;
    cl_event computed = NULL;
    size_t bytes = launcher->adds ? 0
                                  : (size_t)batch->frame.pass.stride * launch->list->words_per_item[BUFFER_SPLATS] *
                                        sizeof(uint) * batch->splat_sections;
    bool done = check(launch,
                      clEnqueueReadBuffer(launcher->compute, memory->state[BUFFER_DIAGNOSTICS], CL_FALSE, 0,
                                          sizeof results->diagnostics, results->diagnostics, 0, NULL, NULL),
                      "reading counters") &&
                check(launch,
                      clEnqueueReadBuffer(launcher->compute, memory->state[BUFFER_COUNTS], CL_FALSE, 0,
                                          sizeof results->counts, results->counts, 0, NULL, &computed),
                      "reading counters") &&
                check(launch, clFlush(launcher->compute), "starting commands");
    batch->copied_name = "copy splats";
    if (done && bytes > 0)
        done = check(launch,
                     clEnqueueReadBuffer(launcher->copy, batch->memory->splats, CL_FALSE, 0, bytes, batch->memory->host,
                                         1, &computed, &batch->copied),
                     "copying splats") &&
               check(launch, clFlush(launcher->copy), "starting copies");
    else if (done) {
        batch->copied = computed;
        batch->copied_name = "read counters";
        return true;
    }
    if (computed)
        clReleaseEvent(computed);
    return done;
}

bool batch_launch(Launcher *launcher, Batch *batch, const StepList *list, bool *dropped, Error *error)
{
    Launch launch = {.launcher = launcher, .batch = batch, .list = list, .error = error};
    batch->splat_sections = 1;
    *dropped = false;
    bool done = batch_begin(&launch) && steps_enqueue(&launch, dropped) &&
                (*dropped || ((!launcher->adds || splats_add(&launch)) && results_read(&launch)));
    counted_release(&launch);
    if (done && !*dropped)
        first_check_adapt(&launch);
    if (*dropped)
        batch_drop(batch);
    return done;
}

cl_int batch_wait(const Batch *batch)
{
    return clWaitForEvents(1, &batch->copied);
}

uint64_t batch_finish(Batch *batch, Timeline *timeline)
{
    uint64_t nanoseconds = 0;
    for (size_t i = 0; i < batch->event_count; ++i) {
        const BatchEvent *event = &batch->events[i];
        if (!timeline->records && !event->traces)
            continue;
        uint64_t taken = timeline_add_event(timeline, event->event, event->name, SPAN_COMPUTE, batch->number);
        nanoseconds += event->traces ? taken : 0;
    }
    if (timeline->records)
        timeline_add_event(timeline, batch->copied, batch->copied_name, SPAN_COPY, batch->number);
    events_release(batch);
    return nanoseconds;
}

void batch_drop(Batch *batch)
{
    events_release(batch);
    free(batch->events);
    batch->events = NULL;
    batch->event_capacity = 0;
}
