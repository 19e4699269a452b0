/* The host's part of the pipeline: threads that wait for the splats of a batch and hand them to the sink while the
 * device computes the next batches. */
#ifndef TWINLIGHT_FILM_ADDERS_H
#define TWINLIGHT_FILM_ADDERS_H

#include "batch.h"

typedef struct FilmAdders FilmAdders;

/* Totals over finished batches. */
typedef struct AddersTotal {
    uint64_t items; /* since adders_begin */
    uint64_t closest_rays, shadow_rays, ray_nanoseconds; /* since adders_create, like diagnostics */
    uint64_t diagnostics[DIAGNOSTIC_COUNT];
    cl_int status; /* of the first batch that failed; CL_SUCCESS while none has */
} AddersTotal;

/* Starts `threads` threads. NULL on failure. `timeline` is borrowed. */
FilmAdders *adders_create(int threads, Timeline *timeline, Error *error);
void adders_destroy(FilmAdders *adders);

/* Sets the sink for the splats of following batches, which is borrowed (NULL: splats are not copied to the host), and
 * resets `items`. */
void adders_begin(FilmAdders *adders, const SplatSink *sink);

/* Waits until slot `slot` (< BATCH_SLOTS) is free. */
void adders_wait(FilmAdders *adders, int slot);

/* Hands over a launched batch, which belongs to the adders until its slot is free again. */
void adders_push(FilmAdders *adders, int slot, Batch *batch);

/* Copies the totals. Thread-safe. */
void adders_total(FilmAdders *adders, AddersTotal *total);

#endif
