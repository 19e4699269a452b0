/* Bidirectional path tracing: a walk from a light, a walk from the camera, and every connection between them. */
#include "bd_state.h"
#include "integrator.h"
#include "kernel_list.h"

#include <assert.h>
#include <stdlib.h>

/* Bits of BD_LIGHT_DELTA; also what vertices and pairs are worth storing and making. */
#define BDPT_DEPTH_LIMIT 31

/* Steps being recorded. */
typedef struct Recorder {
    Step *steps;
    size_t count;
} Recorder;

static void record(Recorder *recorder, StepKind kind)
{
    recorder->steps[recorder->count++] = (Step){.kind = kind};
}

static void record_kernel(Recorder *recorder, unsigned kernel, bool live_only)
{
    recorder->steps[recorder->count++] = (Step){.kind = STEP_KERNEL, .kernel = kernel, .live_only = live_only};
}

/* `segments` segments of a walk; nothing is drawn at the last vertex. */
static void record_walk(Recorder *recorder, uint segments)
{
    size_t end = recorder->count + (size_t)segments * 4 - 2;
    for (uint i = 1; i <= segments; ++i) {
        record(recorder, STEP_TRACE_CLOSEST);
        record_kernel(recorder, KERNEL_bd_shade_hits, true);
        if (i == segments)
            break;
        record_kernel(recorder, KERNEL_bd_extend_walks, true);
        recorder->steps[recorder->count++] = (Step){.kind = STEP_SKIP_IF_IDLE, .target = (unsigned)end};
    }
    assert(recorder->count == end);
}

static void record_connection(Recorder *recorder, uint t)
{
    record_kernel(recorder, KERNEL_bd_connect, false);
    record(recorder, STEP_TRACE_SHADOW);
    record_kernel(recorder, KERNEL_bd_add_connections, false);
    if (t == 1)
        record(recorder, STEP_SPLAT);
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

static const StateField BD_FIELDS[] = {
    {BUFFER_PATHS, BD_PIXEL, 1, false, "pixel"},
    {BUFFER_PATHS, BD_SAMPLE, 1, false, "sample"},
    {BUFFER_PATHS, BD_WEIGHT, 1, true, "filter weight"},
    {BUFFER_PATHS, BD_RADIANCE, 3, true, "radiance"},
    {BUFFER_PATHS, BD_LENGTHS, 1, false, "numbers of vertices"},
    {BUFFER_PATHS, BD_LIGHT_DELTA, 1, false, "delta vertices of the light"},
    {BUFFER_PATHS, BD_CAMERA_DELTA, 1, false, "delta vertices of the camera"},
    {BUFFER_PATHS, BD_EMITTER, 1, false, "light"},
    {BUFFER_PATHS, BD_EMITTER_FLAGS, 1, false, "flags of the light"},
    {BUFFER_PATHS, BD_CONNECT, 1, true, "ratio of the light's densities"},
    {BUFFER_PATHS, BD_SIDE, 1, false, "side"},
    {BUFFER_PATHS, BD_DEPTH, 1, false, "depth"},
    {BUFFER_PATHS, BD_BETA, 3, true, "throughput"},
    {BUFFER_PATHS, BD_PDF, 1, true, "density of the last direction"},
    {BUFFER_PATHS, BD_WALK_FLAGS, 1, false, "flags of the walk"},
    {BUFFER_PATHS, BD_ETA_SCALE, 1, true, "eta^2"},
    {BUFFER_PATHS, BD_BACK, 1, true, "factor of the way back"},
    {BUFFER_PATHS, BD_S, 1, false, "s"},
    {BUFFER_PATHS, BD_T, 1, false, "t"},
    {BUFFER_PATHS, BD_CONTRIBUTION, 3, true, "contribution of the connection"},
    {BUFFER_PATHS, BD_TARGET, 1, false, "pixel of the connection"},
};

static bool bdpt_list(FrameParams *frame, StepList *list, Error *error)
{
    uint max_depth = frame->max_depth;
    /* Two walks, their beginnings and the splat, and four steps a pair. */
    size_t capacity = 8 * (size_t)max_depth + 8 + 2 * (size_t)max_depth * (max_depth + 1);
    Recorder recorder = {malloc(capacity * sizeof(Step)), 0};
    if (!recorder.steps)
        return error_memory(error, capacity * sizeof(Step), "the list of steps");
    record_kernel(&recorder, KERNEL_bd_start_light, false);
    if (max_depth > 1)
        record_walk(&recorder, max_depth - 1);
    record_kernel(&recorder, KERNEL_bd_start_camera, false);
    record_walk(&recorder, max_depth);
    record_connections(&recorder, max_depth);
    record_kernel(&recorder, KERNEL_bd_splat, false);
    assert(recorder.count <= capacity);
    *list = (StepList){.steps = recorder.steps,
                       .count = recorder.count,
                       .fields = BD_FIELDS,
                       .field_count = sizeof BD_FIELDS / sizeof BD_FIELDS[0]};
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
