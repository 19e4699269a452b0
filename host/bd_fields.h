/* Names of the state of bidirectional integrators (bd_state.h, ib_weight.h). */
#ifndef TWINLIGHT_BD_FIELDS_H
#define TWINLIGHT_BD_FIELDS_H

#include "backend.h"

/* Those behind the first BD_FIELD_COUNT are IBPT's. */
#define BD_FIELD_COUNT 25
#define IB_FIELD_COUNT 31
extern const StateField BD_FIELDS[IB_FIELD_COUNT];

/* The list of BDPT; with frame->pool that of a pool's samples, which end in BUFFER_PASS (pool.h). */
bool bdpt_list(FrameParams *frame, StepList *list, Error *error);

#endif
