/* Records the list of steps of an integrator. */
#ifndef TWINLIGHT_BACKEND_STEP_RECORDER_H
#define TWINLIGHT_BACKEND_STEP_RECORDER_H

#include "backend/backend.h"

typedef struct Recorder {
    Step *steps;
    size_t count, capacity;
} Recorder;

/* `capacity`: maximum number of steps. */
bool recorder_init(Recorder *recorder, size_t capacity, Error *error);

/* Append a step without arguments, a kernel step, or a STEP_SKIP_IF_IDLE to step `target`. */
void recorder_step(Recorder *recorder, StepKind kind);
void recorder_kernel(Recorder *recorder, unsigned kernel, bool live_only);
void recorder_skip(Recorder *recorder, size_t target);

/* Records a walk of up to `segments` segments: trace rays, `shade` the hits and, except after the last segment,
 * `extend` the path. KERNEL_COUNT for `extend`: `shade` does both. */
void recorder_walk(Recorder *recorder, uint segments, unsigned shade, unsigned extend);

/* Target of a skip to where recorder_skips_end is called. */
#define RECORDER_END ((size_t)-1)
void recorder_skips_end(Recorder *recorder);

/* The recorded list, which takes ownership of the steps: `path_words` words per path, rays, hits, shadow rays and
 * splats. An integrator adds further buffers to words_per_item. */
StepList recorder_list(const Recorder *recorder, const FrameParams *frame, uint path_words, const StateField *fields,
                       size_t field_count);

/* Frees the steps. Safe on {0} and twice. */
void step_list_destroy(StepList *list);

#endif
