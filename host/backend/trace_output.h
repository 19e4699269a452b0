/* Writes the --trace file, a timeline for chrome://tracing and Perfetto. */
#ifndef TWINLIGHT_BACKEND_TRACE_OUTPUT_H
#define TWINLIGHT_BACKEND_TRACE_OUTPUT_H

#include "backend/backend.h"

/* Timings of one device. */
typedef struct TraceSource {
    const BackendSpan *spans;
    size_t count;
    uint64_t dropped; /* not recorded */
    BackendStatistics statistics;
} TraceSource;

/* Writes the spans in Chrome's JSON object format ("Trace Event Format": complete events, microseconds). Every source
 * is a process with a row for the device's kernels, one for copies, and one for each host thread that added to the
 * film. */
bool trace_write(const char *path, const TraceSource *sources, size_t count, Error *error);

#endif
