/* The host's part of the pipeline: threads that wait for a batch's splats and hand them to the sink, while the device
 * computes the batches behind it. */
#ifndef TWINLIGHT_FILM_ADDERS_H
#define TWINLIGHT_FILM_ADDERS_H

#include "batch.h"

typedef struct FilmAdders FilmAdders;

/* What finished batches add up to. */
typedef struct AddersTotal {
    uint64_t items; /* since adders_begin */
    uint64_t closest_rays, shadow_rays, ray_nanoseconds; /* since the adders were made */
    uint64_t diagnostics[DIAGNOSTIC_COUNT];
    cl_int status; /* of the first batch that failed; CL_SUCCESS while none has */
} AddersTotal;

/* Starts `threads` threads. NULL on failure. `timeline` is borrowed. */
FilmAdders *adders_create(int threads, Timeline *timeline, Error *error);
void adders_destroy(FilmAdders *adders);

/* The splats of the batches that follow go to this sink, which is borrowed (NULL: they are not on the host). */
void adders_begin(FilmAdders *adders, const SplatSink *sink);

/* Waits until slot `slot` (< BATCH_SLOTS) is free. */
void adders_wait(FilmAdders *adders, int slot);

/* Hands over a launched batch, which belongs to the adders until its slot is free again. */
void adders_push(FilmAdders *adders, int slot, Batch *batch);

void adders_total(FilmAdders *adders, AddersTotal *total);

#endif
