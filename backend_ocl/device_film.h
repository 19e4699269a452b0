/* The film's sums on a device with 64-bit integer atomics: kernels add splats there (shared/kernels/film_add.cl), and
 * the host gets the sums at the end of a pass instead of every splat. A pass that fails leaves nothing in the host's
 * film. */
#ifndef TWINLIGHT_DEVICE_FILM_H
#define TWINLIGHT_DEVICE_FILM_H

#include "device_memory.h"
#include "timeline.h"

/* Whether the device can; otherwise an error that says what it lacks. */
bool device_film_check(const OclDevice *device, Error *error);

/* memory->film becomes the sums of a film of `words` words, all zero for the commands that follow on memory->queue. */
bool device_film_begin(DeviceMemory *memory, size_t words, Error *error);

/* Hands the sums to the sink when all commands on memory->queue have ended. `batch`: what the timeline puts it
 * under. */
bool device_film_end(DeviceMemory *memory, const SplatSink *sink, Timeline *timeline, uint64_t batch, Error *error);

#endif
