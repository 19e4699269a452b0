/* The --trace file: what ran when, as chrome://tracing and Perfetto read it. */
#ifndef TWINLIGHT_TRACE_OUTPUT_H
#define TWINLIGHT_TRACE_OUTPUT_H

#include "backend.h"

/* Writes the spans as Chrome's JSON object format ("Trace Event Format": complete events, microseconds): one row for
 * the device's kernels, one for copies, one for each host thread that added to the film. `dropped` spans are named in
 * the file. */
bool trace_write(const char *path, const char *device, const BackendSpan *spans, size_t count, uint64_t dropped,
                 Error *error);

#endif
