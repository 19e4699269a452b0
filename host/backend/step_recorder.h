/* A list of steps while an integrator records it. */
#ifndef TWINLIGHT_BACKEND_STEP_RECORDER_H
#define TWINLIGHT_BACKEND_STEP_RECORDER_H

#include "backend/backend.h"

typedef struct Recorder {
    Step *steps;
    size_t count, capacity;
} Recorder;

/* `capacity`: the most steps that will be recorded. */
bool recorder_init(Recorder *recorder, size_t capacity, Error *error);

void recorder_step(Recorder *recorder, StepKind kind);
void recorder_kernel(Recorder *recorder, unsigned kernel, bool live_only);
void recorder_skip(Recorder *recorder, size_t target);

/* Up to `segments` segments of a walk: rays, the kernel for what they meet, and, but at the last vertex where nothing
 * is drawn, the one that goes on; KERNEL_COUNT: the first does. */
void recorder_walk(Recorder *recorder, uint segments, unsigned shade, unsigned extend);

/* The list that was recorded, whose steps it now owns: `path_words` words a path, with rays, hits, shadow rays and
 * splats. What else an integrator keeps it adds to words_per_item. */
StepList recorder_list(const Recorder *recorder, uint path_words, const StateField *fields, size_t field_count);

void step_list_destroy(StepList *list);

#endif
