/* Tests whether a device rounds quotients and square roots correctly (IEEE 754) by comparing some millions of results
 * with the host's. */
#ifndef TWINLIGHT_ROUNDING_PROBE_H
#define TWINLIGHT_ROUNDING_PROBE_H

#include "devices.h"

typedef struct RoundingProbe {
    uint64_t compared; /* number of divisions and roots */
    uint64_t wrong; /* results that differ from the host's */
    char first[128]; /* description of the first wrong result */
} RoundingProbe;

/* Builds kernels/rounding.cl with the options of the kernels and compares its results. The outcome is stored with the
 * built programs (program_cache.h) and reused unless `anew`. False with an error if the probe cannot run. */
bool rounding_probe_run(const OclDevice *device, bool anew, RoundingProbe *probe, Error *error);

#endif
