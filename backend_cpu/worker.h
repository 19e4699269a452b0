/* What one thread of the CPU backend does: it carries a chunk of items through a whole list of steps. */
#ifndef TWINLIGHT_WORKER_H
#define TWINLIGHT_WORKER_H

#include "chunk.h"
#include "kernel_scene.h"
#include "layout/diagnostics.h"
#include "rays_embree.h"

#include <stdatomic.h>

/* What has happened to rays since `live` was made. */
typedef enum LiveList {
    LIVE_ANY, /* anything */
    LIVE_FEWER, /* only items of the list may have been touched */
    LIVE_SAME
} LiveList;

/* What a thread owns. Zeroed memory is one that has nothing yet. */
typedef struct Worker {
    KernelScene *scene;
    const RaysEmbree *rays;
    FrameParams frame; /* the pass's, with first_item, item_count and stride of the chunk */
    void *kernel_frame, *kernel_guide; /* storage of the functions of these names */
    uint *buffers[BUFFER_COUNT]; /* per-item buffers and counters */
    size_t buffer_words[BUFFER_COUNT];
    uint64_t diagnostics[DIAGNOSTIC_COUNT];
    uint64_t closest_rays, shadow_rays, ray_nanoseconds;
    uint live[CHUNK_ITEMS]; /* items with a ray when worker_find_live looked last */
    uint live_count;
    LiveList live_list;
    bool splatted; /* the sink has splats of the chunk */
    char padding[64]; /* no two workers' counters on a cache line */
} Worker;

/* One call of the backend's run or inspect. */
typedef struct Job {
    const FrameParams *frame;
    const StepList *list;
    const SplatSink *sink; /* NULL: `inspect` is called */
    StateSink inspect;
    void *context;
    const atomic_int *stop;
} Job;

/* Scene and rays are borrowed. To be destroyed whether it fails or not. */
bool worker_init(Worker *worker, KernelScene *scene, const RaysEmbree *rays, Error *error);
void worker_destroy(Worker *worker);

/* Room for the list's state; false when out of memory. */
bool worker_reserve(Worker *worker, const StepList *list);

/* Items first ... first + count - 1 of the job, at most CHUNK_ITEMS, for which there is room. False when it was stopped
 * and the chunk was dropped. */
bool worker_run_chunk(Worker *worker, const Job *job, uint first, uint count);

/* Of a clock that never runs backwards. */
uint64_t nanoseconds_now(void);

#endif
