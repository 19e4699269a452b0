/* The part of a pass that this rank computes, on a thread of its own, so that the main thread can send and receive
 * meanwhile. */
#ifndef TWINLIGHT_RANKS_SLICE_H
#define TWINLIGHT_RANKS_SLICE_H

#include "backend/group.h"

#include <pthread.h>

/* How often a rank that waits for its slice looks for messages: the longest delay until it learns of a stop. */
#define SLICE_LOOK_SECONDS 0.002

typedef struct Slice {
    BackendMember backend;
    FrameParams frame; /* whose pass is the part */
    const StepList *list;
    const SplatSink *sink;
    const atomic_int *stop;
    /* The outcome, once it is done. */
    uint64_t delivered;
    double seconds;
    bool good;
    Error error; /* unless good */
    /* of this file alone */
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t ended;
    bool threaded, done;
} Slice;

/* Starts it; all members above the outcome must be set, and the slice must stay where it is until slice_join. Without
 * items, or if no thread can be started, it is done on return. */
void slice_start(Slice *slice);

/* Waits until it is done, at most `seconds`. Returns whether it is. */
bool slice_wait(Slice *slice, double seconds);

/* Waits until it is done. */
void slice_join(Slice *slice);

#endif
