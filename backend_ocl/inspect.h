/* Reads the whole state of a batch after its steps, to compare backends. */
#ifndef TWINLIGHT_INSPECT_H
#define TWINLIGHT_INSPECT_H

#include "batch.h"

/* Clears the state, runs the list over the batch (its memory and frame are set) and hands every per-item buffer to the
 * sink, whose items count from `first`. Returns when no command is in flight. */
bool inspect_batch(Launcher *launcher, Batch *batch, const StepList *list, uint first, StateSink sink, void *context,
                   Error *error);

#endif
