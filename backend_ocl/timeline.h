/* Timeline: device commands timed by event profiling and host work timed by its clock, on one time axis. */
#ifndef TWINLIGHT_TIMELINE_H
#define TWINLIGHT_TIMELINE_H

#include "ocl_status.h"

#include "backend/backend.h"

#include <pthread.h>

typedef struct Timeline {
    bool records; /* false: nothing is recorded */
    pthread_mutex_t mutex;
    BackendSpan *spans;
    size_t count;
    uint64_t dropped; /* spans that did not fit */
    int64_t offset; /* host clock minus device clock, nanoseconds */
} Timeline;

/* Maximum number of spans (48 bytes each); later ones are only counted. */
#define TIMELINE_SPANS_MAX ((size_t)1 << 20)

/* Allocates the spans if `records`; fails when out of memory. */
bool timeline_init(Timeline *timeline, bool records, Error *error);
void timeline_destroy(Timeline *timeline);

/* Monotonic host time, nanoseconds. */
uint64_t timeline_now(void);

/* Determines the offset between both clocks with a command on `queue`, which must be idle and have profiling
 * enabled. */
void timeline_synchronize(Timeline *timeline, cl_command_queue queue, cl_mem buffer);

/* Adds a host span. Thread-safe. */
void timeline_add(Timeline *timeline, BackendSpan span);

/* Adds a finished device command. Returns its duration in nanoseconds, 0 if the device does not report it. */
uint64_t timeline_add_event(Timeline *timeline, cl_event event, const char *name, SpanTrack track, uint64_t batch);

#endif
