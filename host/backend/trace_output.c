#include "backend/trace_output.h"

#include "base/json.h"
#include "base/output_file.h"

#include <stdio.h>

/* Row of the span in the diagram: the trace's tid. */
static uint span_row(const BackendSpan *span)
{
    return span->track == SPAN_COMPUTE ? 1u : span->track == SPAN_COPY ? 2u : 3u + span->lane;
}

static void metadata_print(JsonWriter *json, size_t process, const char *what, uint row, const char *name)
{
    json_object_begin(json, NULL);
    json_text(json, "name", what);
    json_text(json, "ph", "M");
    json_unsigned(json, "pid", process);
    json_signed(json, "tid", row);
    json_object_begin(json, "args");
    json_text(json, "name", name);
    json_object_end(json);
    json_object_end(json);
}

static void rows_print(JsonWriter *json, size_t process, const TraceSource *source)
{
    const BackendSpan *spans = source->spans;
    uint lanes = 0;
    for (size_t i = 0; i < source->count; ++i)
        if (spans[i].track == SPAN_FILM && spans[i].lane >= lanes)
            lanes = spans[i].lane + 1;
    metadata_print(json, process, "process_name", 0, source->statistics.device);
    metadata_print(json, process, "thread_name", 1, "device: kernels");
    metadata_print(json, process, "thread_name", 2, "device: copies");
    for (uint i = 0; i < lanes; ++i) {
        char name[48];
        snprintf(name, sizeof name, "host: film, thread %u", i);
        metadata_print(json, process, "thread_name", 3 + i, name);
    }
}

static void span_print(JsonWriter *json, size_t process, const BackendSpan *span, uint64_t start)
{
    static const char *const CATEGORIES[] = {"kernel", "copy", "film"};
    json_object_begin(json, NULL);
    json_text(json, "name", span->name);
    json_text(json, "cat", CATEGORIES[span->track]);
    json_text(json, "ph", "X");
    json_unsigned(json, "pid", process);
    json_signed(json, "tid", span_row(span));
    json_number(json, "ts", 1e-3 * (double)(span->begin - start));
    json_number(json, "dur", 1e-3 * (double)(span->end - span->begin));
    json_object_begin(json, "args");
    json_unsigned(json, "batch", span->batch);
    json_object_end(json);
    json_object_end(json);
}

static uint64_t first_begin(const TraceSource *sources, size_t count)
{
    uint64_t start = UINT64_MAX;
    for (size_t k = 0; k < count; ++k)
        for (size_t i = 0; i < sources[k].count; ++i)
            start = sources[k].spans[i].begin < start ? sources[k].spans[i].begin : start;
    return start;
}

static void trace_print(FILE *stream, const TraceSource *sources, size_t count)
{
    JsonWriter json;
    uint64_t start = first_begin(sources, count), dropped = 0;
    json_init(&json, stream);
    json_object_begin(&json, NULL);
    json_text(&json, "displayTimeUnit", "ms");
    json_array_begin(&json, "traceEvents");
    for (size_t k = 0; k < count; ++k) {
        rows_print(&json, k + 1, &sources[k]);
        for (size_t i = 0; i < sources[k].count; ++i)
            span_print(&json, k + 1, &sources[k].spans[i], start);
        dropped += sources[k].dropped;
    }
    json_array_end(&json);
    json_object_begin(&json, "otherData");
    json_unsigned(&json, "spans_dropped", dropped);
    json_object_end(&json);
    json_object_end(&json);
}

bool trace_write(const char *path, const TraceSource *sources, size_t count, Error *error)
{
    OutputFile file;
    FILE *stream = output_file_begin(&file, path, error) ? output_file_stream(&file, error) : NULL;
    if (!stream)
        return false;
    trace_print(stream, sources, count);
    return output_file_stream_commit(&file, stream, error);
}
