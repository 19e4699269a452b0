/* Whether a device rounds quotients and square roots as IEEE 754 asks: it computes some millions of them, and so does
 * the host. */
#ifndef TWINLIGHT_ROUNDING_PROBE_H
#define TWINLIGHT_ROUNDING_PROBE_H

#include "devices.h"

typedef struct RoundingProbe {
    uint64_t compared; /* divisions and roots */
    uint64_t wrong; /* results that are not the host's */
    char first[128]; /* the first of those, in words */
} RoundingProbe;

/* Builds kernels/rounding.cl with the kernels' options and compares what it gives. What was found is kept with built
 * programs (program_cache.h) and taken from there unless `anew`. False with an error when the device cannot be
 * asked. */
bool rounding_probe_run(const OclDevice *device, bool anew, RoundingProbe *probe, Error *error);

#endif
