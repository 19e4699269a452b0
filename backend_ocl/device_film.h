/* Film sums on a device with 64-bit integer atomics: kernels add the splats (shared/kernels/film_add.cl), and the host
 * gets the sums at the end of a pass instead of every splat. A pass that fails adds nothing to the host's film. */
#ifndef TWINLIGHT_DEVICE_FILM_H
#define TWINLIGHT_DEVICE_FILM_H

#include "device_memory.h"
#include "timeline.h"

/* Whether the device supports this; otherwise sets an error that says what it lacks. */
bool device_film_check(const OclDevice *device, Error *error);

/* Prepares memory->film for a film of `words` words and clears it, before any later command on memory->queue. */
bool device_film_begin(DeviceMemory *memory, size_t words, Error *error);

/* Waits for all commands on memory->queue and hands the sums to the sink. `batch`: number for the timeline. */
bool device_film_end(DeviceMemory *memory, const SplatSink *sink, Timeline *timeline, uint64_t batch, Error *error);

#endif
