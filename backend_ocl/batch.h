/* A batch: the items that go through the list of steps together, from its launch to the film. */
#ifndef TWINLIGHT_BATCH_H
#define TWINLIGHT_BATCH_H

#include "device_memory.h"
#include "program.h"
#include "timeline.h"

#include <stdatomic.h>

/* A command whose time counts. */
typedef struct BatchEvent {
    cl_event event;
    const char *name;
    bool traces; /* rays: its time goes into the statistics */
} BatchEvent;

typedef struct Batch {
    BatchMemory *memory;
    FrameParams frame; /* the pass's, with first_item, item_count and stride of the batch */
    uint64_t number; /* since the backend was opened */
    uint splat_sections; /* of frame.stride items in memory->host: at the end, and before it at every STEP_SPLAT */
    BatchEvent *events;
    size_t event_count, event_capacity;
    cl_event copied; /* its results are in memory->results, and its splats in memory->host */
    const char *copied_name;
} Batch;

/* What launches share. */
typedef struct Launcher {
    const OclDevice *device;
    cl_command_queue compute, copy;
    OclProgram program;
    DeviceMemory *memory;
    bool adds; /* splats go to memory->film instead of to the host */
    bool records; /* keep the events of every command, not of rays alone */
    size_t group; /* work-items of a work-group */
    uint first_check; /* the turn of the loop at which a batch is first asked whether it has ended early */
    const atomic_int *stop; /* of the pass: becomes 1 when batches are to end at the next step; NULL: never */
    bool whole; /* SplatSink.whole */
    uint64_t fail_at; /* number of the batch that fails on purpose, for tests; UINT64_MAX: none */
} Launcher;

/* Enqueues the whole list for the batch, and the copy of its splats behind it on the second queue. Returns when the
 * last command is enqueued; meanwhile it may wait for the device to say that no path is alive, or because the device is
 * far behind. *dropped: a stop has ended the batch before its list did; some of its commands may be under way, and none
 * of its results are wanted. */
bool batch_launch(Launcher *launcher, Batch *batch, const StepList *list, bool *dropped, Error *error);

/* Waits until everything of the batch has happened. */
cl_int batch_wait(const Batch *batch);

/* Puts the batch's events on the timeline and releases them; returns the nanoseconds of its ray queries. */
uint64_t batch_finish(Batch *batch, Timeline *timeline);

/* Releases what a failed launch left. */
void batch_drop(Batch *batch);

#endif
