/* Bidirectional path tracing: a walk from a light, a walk from the camera, and every connection between them. */
#include "bd_fields.h"
#include "bd_state.h"
#include "integrator.h"
#include "kernel_list.h"
#include "step_recorder.h"

/* Bits of BD_LIGHT_DELTA; also what vertices and pairs are worth storing and making. */
#define BDPT_DEPTH_LIMIT 31

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
    Recorder recorder;
    if (!recorder_init(&recorder, capacity, error))
        return false;
    recorder_kernel(&recorder, KERNEL_bd_start_light, false);
    if (max_depth > 1)
        recorder_walk(&recorder, max_depth - 1, KERNEL_bd_shade_hits, KERNEL_bd_extend_walks);
    recorder_kernel(&recorder, KERNEL_bd_start_camera, false);
    recorder_walk(&recorder, max_depth, KERNEL_bd_shade_hits, KERNEL_bd_extend_walks);
    record_connections(&recorder, max_depth);
    if (frame->pool)
        recorder_kernel(&recorder, KERNEL_pool_end, false);
    recorder_kernel(&recorder, KERNEL_bd_splat, false);
    *list = recorder_list(&recorder, BD_HEADER_WORDS, BD_FIELDS, BD_FIELD_COUNT);
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
