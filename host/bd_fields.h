/* What bidirectional integrators share: names of their state (bd_state.h, ib_weight.h), and how lists are recorded. */
#ifndef TWINLIGHT_BD_FIELDS_H
#define TWINLIGHT_BD_FIELDS_H

#include "backend.h"

/* Those behind the first BD_FIELD_COUNT are IBPT's. */
#define BD_FIELD_COUNT 25
#define IB_FIELD_COUNT 31
extern const StateField BD_FIELDS[IB_FIELD_COUNT];

/* Steps being recorded into an array that is large enough. */
typedef struct Recorder {
    Step *steps;
    size_t count;
} Recorder;

/* The list of BDPT; with frame->pool that of a pool's samples, which end in BUFFER_PASS (pool.h). */
bool bdpt_list(FrameParams *frame, StepList *list, Error *error);

void recorder_step(Recorder *recorder, StepKind kind);
void recorder_kernel(Recorder *recorder, unsigned kernel, bool live_only);
void recorder_skip(Recorder *recorder, size_t target);

#endif
