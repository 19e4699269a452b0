/* One thread of the CPU backend: it takes chunks of items through a whole list of steps. */
#ifndef TWINLIGHT_WORKER_H
#define TWINLIGHT_WORKER_H

#include "chunk.h"
#include "kernel_scene.h"
#include "layout/diagnostics.h"
#include "rays_embree.h"

#include <stdatomic.h>

/* What may have happened to rays since `live` was filled. */
typedef enum LiveList {
    LIVE_ANY, /* anything */
    LIVE_FEWER, /* only items of the list may have changed */
    LIVE_SAME
} LiveList;

/* The state of one thread. Valid if zeroed. */
typedef struct Worker {
    KernelScene *scene;
    const RaysEmbree *rays;
    FrameParams frame; /* the pass's, with first_item, item_count and stride of the chunk */
    void *kernel_frame, *kernel_guide; /* storage of the functions with these names */
    uint *buffers[BUFFER_COUNT]; /* per-item buffers and counters */
    size_t buffer_words[BUFFER_COUNT];
    uint64_t diagnostics[DIAGNOSTIC_COUNT];
    uint64_t closest_rays, shadow_rays, ray_nanoseconds;
    uint live[CHUNK_ITEMS]; /* the items that had a ray when worker_find_live was last called */
    uint live_count;
    LiveList live_list;
    bool splatted; /* the sink has received splats of the chunk */
    char padding[64]; /* keeps the counters of two workers off the same cache line */
} Worker;

/* One call of the backend's run or inspect. */
typedef struct Job {
    const FrameParams *frame;
    const StepList *list;
    const SplatSink *sink; /* NULL: `inspect` is called instead */
    StateSink inspect;
    void *context;
    const atomic_int *stop;
} Job;

/* Scene and rays are borrowed. Must be destroyed even on failure. */
bool worker_init(Worker *worker, KernelScene *scene, const RaysEmbree *rays, Error *error);
void worker_destroy(Worker *worker);

/* Makes room for the list's state; false when out of memory. */
bool worker_reserve(Worker *worker, const StepList *list);

/* Runs items first ... first + count - 1 of the job; count <= CHUNK_ITEMS, and worker_reserve has succeeded. False if
 * it was stopped and the chunk was dropped. */
bool worker_run_chunk(Worker *worker, const Job *job, uint first, uint count);

/* Time of a monotonic clock. */
uint64_t nanoseconds_now(void);

#endif
