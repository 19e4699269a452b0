/* Bidirectional path tracing: a light subpath, a camera subpath, and all connections between them. */
#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "path/bd_state.h"
#include "render/bd_fields.h"
#include "render/integrator.h"

/* Bits in BD_LIGHT_DELTA; longer paths would not be worth their storage and connections. */
#define BDPT_DEPTH_LIMIT 31

/* With split depths: splats what has been gathered since the last splat, all of one depth. */
static void record_gathered(Recorder *recorder)
{
    recorder_kernel(recorder, KERNEL_bd_splat, false);
    recorder_step(recorder, STEP_SPLAT);
}

/* The camera subpath with split depths. Without skips: a skipped splat would repeat a stale one. */
static void record_split_walk(Recorder *recorder, uint segments)
{
    for (uint i = 1; i <= segments; ++i) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        recorder_kernel(recorder, KERNEL_bd_shade_hits, true);
        record_gathered(recorder);
        if (i < segments)
            recorder_kernel(recorder, KERNEL_bd_extend_walks, true);
    }
}

/* What of a frame the list depends on. */
typedef struct BidirectionalSteps {
    uint max_depth;
    bool split; /* depths */
    bool media;
} BidirectionalSteps;

static void record_connection(Recorder *recorder, const BidirectionalSteps *steps, uint t)
{
    recorder_kernel(recorder, KERNEL_bd_connect, false);
    recorder_step(recorder, STEP_TRACE_SHADOW);
    if (steps->media)
        recorder_kernel(recorder, KERNEL_bd_connect, false); /* connection_traced in path/bd_connect.h */
    recorder_kernel(recorder, KERNEL_bd_add_connections, false);
    if (t == 1)
        recorder_step(recorder, STEP_SPLAT);
    else if (steps->split)
        record_gathered(recorder);
}

/* Connections (s, t) in the order of connection_advance (kernels/bd_connect.cl). */
static void record_connections(Recorder *recorder, const BidirectionalSteps *steps)
{
    for (uint s = 2; s <= steps->max_depth; ++s)
        record_connection(recorder, steps, 1);
    for (uint t = 2; t <= steps->max_depth; ++t)
        for (uint s = 1; s + t <= steps->max_depth + 1; ++s)
            record_connection(recorder, steps, t);
}

bool bdpt_list(FrameParams *frame, StepList *list, Error *error)
{
    uint max_depth = frame->path.max_depth;
    const BidirectionalSteps steps = {.max_depth = max_depth,
                                      .split = frame->film.split_depths != 0,
                                      .media = (frame_features(frame) & FEATURE_MEDIUM) != 0};
    /* Two walks, their starts, the last splats, and up to six steps per connection. */
    size_t capacity = 9 * (size_t)max_depth + 11 + 6 * (size_t)max_depth * (max_depth + 1) / 2;
    Recorder recorder;
    if (!recorder_init(&recorder, capacity, error))
        return false;
    recorder_kernel(&recorder, KERNEL_bd_start_light, false);
    if (max_depth > 1)
        recorder_walk(&recorder, max_depth - 1, KERNEL_bd_shade_hits, KERNEL_bd_extend_walks);
    recorder_kernel(&recorder, KERNEL_bd_start_camera, false);
    if (steps.split)
        record_split_walk(&recorder, max_depth);
    else
        recorder_walk(&recorder, max_depth, KERNEL_bd_shade_hits, KERNEL_bd_extend_walks);
    record_connections(&recorder, &steps);
    if (frame->pool.enabled)
        recorder_kernel(&recorder, KERNEL_pool_end, false);
    if (frame->partition.split_direct) {
        recorder_kernel(&recorder, KERNEL_bd_splat_direct, false);
        recorder_step(&recorder, STEP_SPLAT);
    }
    recorder_kernel(&recorder, KERNEL_bd_splat, false);
    *list = recorder_list(&recorder, frame, BD_HEADER_WORDS, BD_FIELDS, BD_FIELD_COUNT);
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
