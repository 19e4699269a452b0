/* What ran when: commands of the device by event profiling, work of the host by its clock, on one time axis. */
#ifndef TWINLIGHT_TIMELINE_H
#define TWINLIGHT_TIMELINE_H

#include "ocl_status.h"

#include "backend/backend.h"

#include <pthread.h>

typedef struct Timeline {
    bool records; /* false: nothing is kept */
    pthread_mutex_t mutex;
    BackendSpan *spans;
    size_t count;
    uint64_t dropped; /* spans that did not fit */
    int64_t offset; /* host clock minus device clock, nanoseconds */
} Timeline;

/* Spans kept at most (48 bytes each); later ones are counted only. */
#define TIMELINE_SPANS_MAX ((size_t)1 << 20)

bool timeline_init(Timeline *timeline, bool records, Error *error);
void timeline_destroy(Timeline *timeline);

/* Nanoseconds of the host's steady clock. */
uint64_t timeline_now(void);

/* Finds the offset between the clocks by a command on `queue`, which must be idle and have profiling on. */
void timeline_synchronize(Timeline *timeline, cl_command_queue queue, cl_mem buffer);

/* Adds a span of the host. Any thread. */
void timeline_add(Timeline *timeline, BackendSpan span);

/* Adds a finished command of the device, and returns how long it ran in nanoseconds (0 when the device does not
 * say). */
uint64_t timeline_add_event(Timeline *timeline, cl_event event, const char *name, SpanTrack track, uint64_t batch);

#endif
