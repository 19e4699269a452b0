/* Bidirectional path tracing: a walk from a light, a walk from the camera, and every connection between them. */
#include "bd_fields.h"
#include "bd_state.h"
#include "integrator.h"
#include "kernel_list.h"

#include <assert.h>
#include <stdlib.h>

/* Bits of BD_LIGHT_DELTA; also what vertices and pairs are worth storing and making. */
#define BDPT_DEPTH_LIMIT 31

/* `segments` segments of a walk; nothing is drawn at the last vertex. */
static void record_walk(Recorder *recorder, uint segments)
{
    size_t end = recorder->count + (size_t)segments * 4 - 2;
    for (uint i = 1; i <= segments; ++i) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        recorder_kernel(recorder, KERNEL_bd_shade_hits, true);
        if (i == segments)
            break;
        recorder_kernel(recorder, KERNEL_bd_extend_walks, true);
        recorder_skip(recorder, end);
    }
    assert(recorder->count == end);
}

static void record_connection(Recorder *recorder, uint t)
{
    recorder_kernel(recorder, KERNEL_bd_connect, false);
    recorder_step(recorder, STEP_TRACE_SHADOW);
    recorder_kernel(recorder, KERNEL_bd_add_connections, false);
    if (t == 1)
        recorder_step(recorder, STEP_SPLAT);
}

/* The pairs in the order that connection_advance (bd_connect.cl) has. */
static void record_connections(Recorder *recorder, uint max_depth)
{
    for (uint s = 2; s <= max_depth; ++s)
        record_connection(recorder, 1);
    for (uint t = 2; t <= max_depth; ++t)
        for (uint s = 1; s + t <= max_depth + 1; ++s)
            record_connection(recorder, t);
}

bool bdpt_list(FrameParams *frame, StepList *list, Error *error)
{
    uint max_depth = frame->max_depth;
    /* Two walks, their beginnings and the splat, and four steps a pair. */
    size_t capacity = 8 * (size_t)max_depth + 9 + 2 * (size_t)max_depth * (max_depth + 1);
    Recorder recorder = {malloc(capacity * sizeof(Step)), 0};
    if (!recorder.steps)
        return error_memory(error, capacity * sizeof(Step), "the list of steps");
    recorder_kernel(&recorder, KERNEL_bd_start_light, false);
    if (max_depth > 1)
        record_walk(&recorder, max_depth - 1);
    recorder_kernel(&recorder, KERNEL_bd_start_camera, false);
    record_walk(&recorder, max_depth);
    record_connections(&recorder, max_depth);
    if (frame->pool)
        recorder_kernel(&recorder, KERNEL_pool_end, false);
    recorder_kernel(&recorder, KERNEL_bd_splat, false);
    assert(recorder.count <= capacity);
    *list = (StepList){
        .steps = recorder.steps, .count = recorder.count, .fields = BD_FIELDS, .field_count = BD_FIELD_COUNT};
    list->words_per_item[BUFFER_PATHS] = BD_HEADER_WORDS;
    list->words_per_item[BUFFER_RAYS] = RAY_WORDS;
    list->words_per_item[BUFFER_HITS] = HIT_WORDS;
    list->words_per_item[BUFFER_SHADOWS] = SHADOW_WORDS;
    list->words_per_item[BUFFER_SPLATS] = SPLAT_WORDS;
    list->words_per_item[BUFFER_VERTICES] = 2 * max_depth * VERTEX_WORDS;
    list->words_per_item[BUFFER_DENSITIES] = 2 * max_depth * DENSITY_WORDS;
    return true;
}

const Integrator *integrator_bdpt(void)
{
    static const Integrator integrator = {.name = "bdpt",
                                          .summary = "bidirectional path tracing",
                                          .depth_limit = BDPT_DEPTH_LIMIT,
                                          .strategies = STRATEGIES_BDPT,
                                          .list = bdpt_list};
    return &integrator;
}
