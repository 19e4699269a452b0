/* The state of a Metropolis rendering between two generations.
 *
 * A generation that is stopped is discarded, but has changed populations, combinations and plans by then. Where
 * checkpoints are written, the state is therefore copied after every generation, and it is the copy that is saved. The
 * picture and the layers change at the end of a generation alone, and are not copied. */
#ifndef TWINLIGHT_MMLT_MMLT_ARCHIVE_H
#define TWINLIGHT_MMLT_MMLT_ARCHIVE_H

#include "mmlt/mmlt.h"
#include "render/checkpoint.h"

/* For checkpoint_save_if_due and the others. */
CheckpointState mmlt_state(Mmlt *mmlt);

/* Copies the state, if checkpoints are written. Between generations. */
bool mmlt_keep(Mmlt *mmlt, Error *error);

/* Begins with what the run's pilot has learnt, if it has one: variances, weights and rates, and where on the film light
 * is hard to find. Before the first generation. */
bool mmlt_pilot_adopt(Mmlt *mmlt, Error *error);

#endif
