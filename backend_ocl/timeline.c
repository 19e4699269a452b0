#include "timeline.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

bool timeline_init(Timeline *timeline, bool records, Error *error)
{
    memset(timeline, 0, sizeof *timeline);
    pthread_mutex_init(&timeline->mutex, NULL);
    timeline->records = records;
    if (!records)
        return true;
    /* Untouched pages of the buffer take no memory. */
    timeline->spans = malloc(TIMELINE_SPANS_MAX * sizeof *timeline->spans);
    return timeline->spans || error_memory(error, TIMELINE_SPANS_MAX * sizeof *timeline->spans, "the trace");
}

void timeline_destroy(Timeline *timeline)
{
    free(timeline->spans);
    timeline->spans = NULL;
    timeline->records = false;
}

uint64_t timeline_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

void timeline_synchronize(Timeline *timeline, cl_command_queue queue, cl_mem buffer)
{
    uint32_t word = 0;
    cl_ulong end = 0;
    cl_event event = NULL;
    if (!timeline->records || clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, sizeof word, &word, 0, NULL, &event))
        return;
    uint64_t now = timeline_now();
    if (clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL) == CL_SUCCESS)
        timeline->offset = (int64_t)(now - end);
    clReleaseEvent(event);
}

void timeline_add(Timeline *timeline, BackendSpan span)
{
    if (!timeline->records)
        return;
    pthread_mutex_lock(&timeline->mutex);
    if (timeline->count < TIMELINE_SPANS_MAX)
        timeline->spans[timeline->count++] = span;
    else
        ++timeline->dropped;
    pthread_mutex_unlock(&timeline->mutex);
}

uint64_t timeline_add_event(Timeline *timeline, cl_event event, const char *name, SpanTrack track, uint64_t batch)
{
    cl_ulong begin = 0, end = 0;
    if (clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, NULL) != CL_SUCCESS ||
        clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL) != CL_SUCCESS || end < begin)
        return 0;
    timeline_add(timeline, (BackendSpan){.name = name,
                                         .track = track,
                                         .batch = batch,
                                         .begin = begin + (uint64_t)timeline->offset,
                                         .end = end + (uint64_t)timeline->offset});
    return end - begin;
}
