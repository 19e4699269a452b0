/* A batch: items that go through the list of steps together, from launch to film. */
#ifndef TWINLIGHT_BATCH_H
#define TWINLIGHT_BATCH_H

#include "device_memory.h"
#include "program.h"
#include "timeline.h"

#include <stdatomic.h>

/* A command whose duration is recorded. */
typedef struct BatchEvent {
    cl_event event;
    const char *name;
    bool traces; /* a ray query, whose time counts in the statistics */
} BatchEvent;

typedef struct Batch {
    BatchMemory *memory;
    FrameParams frame; /* the pass's, with first_item, item_count and stride of the batch */
    uint64_t number; /* counted from the opening of the backend */
    /* Sections of frame.pass.stride items in memory->host: one per STEP_SPLAT, then the final one. */
    uint splat_sections;
    BatchEvent *events;
    size_t event_count, event_capacity;
    cl_event copied; /* done when results are in memory->results and splats in memory->host */
    const char *copied_name;
} Batch;

/* State shared by all launches. */
typedef struct Launcher {
    const OclDevice *device;
    cl_command_queue compute, copy;
    OclProgram program;
    DeviceMemory *memory;
    bool adds; /* splats are added to memory->film instead of being copied to the host */
    bool records; /* keep the events of all commands, not only of ray queries */
    size_t group; /* work-items per work-group */
    /* Closest-hit query (turn) at which the host first checks whether a batch has ended early, and how many turns there
     * are from one check to the next. */
    uint first_check, check_every;
    const atomic_int *stop; /* of the pass: nonzero when batches are to end at the next step; NULL: never */
    bool whole; /* SplatSink.whole */
    uint64_t fail_at; /* number of the batch that fails on purpose, for tests; UINT64_MAX: none */
} Launcher;

/* Enqueues the whole list for the batch, then the copy of its splats on the second queue. Returns when the last command
 * is enqueued; may wait for the number of live paths, or for a device that lags far behind. *dropped: a stop ended the
 * batch early; some of its commands may still be in flight, and its results must be ignored. */
bool batch_launch(Launcher *launcher, Batch *batch, const StepList *list, bool *dropped, Error *error);

/* Waits until the batch is complete. */
cl_int batch_wait(const Batch *batch);

/* Adds the batch's events to the timeline and releases them; returns the duration of its ray queries in nanoseconds. */
uint64_t batch_finish(Batch *batch, Timeline *timeline);

/* Releases what a failed launch left behind. */
void batch_drop(Batch *batch);

#endif
