/* Instant bidirectional path tracing: light and camera subpaths whose vertices are connected as they are made (t = 1
 * and s = 1) and not stored. */
#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "path/bd_state.h"
#include "path/ib_weight.h"
#include "render/bd_fields.h"
#include "render/integrator.h"

#include <assert.h>

/* Connections (s, t) use random numbers 64 s + t (path/bd_random.h). */
#define IBPT_DEPTH_LIMIT 63

/* With 2 instead of 1, most pictures of given error take 3 to 25 % less time (docs/TUNING.md). */
#define IBPT_ROULETTE_SCALE 2.0f

/* Steps per segment: rays, vertex, connection, shadow rays, contribution, [splats,] next direction, skip. */
#define SEGMENT_STEPS_MAX 9

/* The connection of a vertex, its visibility and contribution. */
static void record_connection(Recorder *recorder, bool media)
{
    recorder_kernel(recorder, KERNEL_ib_connect, true);
    recorder_step(recorder, STEP_TRACE_SHADOW);
    if (media)
        recorder_kernel(recorder, KERNEL_ib_connect, true); /* connection_traced in path/bd_connect.h */
    recorder_kernel(recorder, KERNEL_ib_add_connections, true);
}

/* The light subpath: every vertex but y_0 is connected to the lens. */
static void record_light(Recorder *recorder, uint segments, bool media)
{
    size_t each = media ? 9 : 8, end = recorder->count + (size_t)segments * each - 2;
    for (uint i = 1; i <= segments; ++i) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        recorder_kernel(recorder, KERNEL_ib_shade_hits, true);
        record_connection(recorder, media);
        recorder_step(recorder, STEP_SPLAT);
        if (i == segments)
            break;
        recorder_kernel(recorder, KERNEL_ib_extend_walks, true);
        recorder_skip(recorder, end);
    }
    assert(recorder->count == end);
}

static void record_camera(Recorder *recorder, uint segments, bool media)
{
    size_t each = media ? 8 : 7, end = recorder->count + (size_t)(segments - 1) * each + 2;
    for (uint i = 1; i <= segments; ++i) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        recorder_kernel(recorder, KERNEL_ib_shade_hits, true);
        if (i == segments)
            break;
        record_connection(recorder, media);
        recorder_kernel(recorder, KERNEL_ib_extend_walks, true);
        recorder_skip(recorder, end);
    }
    assert(recorder->count == end);
}

static bool ibpt_list(FrameParams *frame, StepList *list, Error *error)
{
    uint max_depth = frame->path.max_depth;
    bool media = (frame_features(frame) & FEATURE_MEDIUM) != 0;
    size_t capacity = 4 + 2 * (size_t)max_depth * SEGMENT_STEPS_MAX;
    Recorder recorder;
    if (!recorder_init(&recorder, capacity, error))
        return false;
    recorder_kernel(&recorder, KERNEL_ib_start_light, false);
    if (max_depth > 1)
        record_light(&recorder, max_depth - 1, media);
    recorder_kernel(&recorder, KERNEL_bd_start_camera, false);
    record_camera(&recorder, max_depth, media);
    recorder_kernel(&recorder, KERNEL_bd_splat, false);
    *list = recorder_list(&recorder, frame, IB_HEADER_WORDS, BD_FIELDS, IB_FIELD_COUNT);
    list->words_per_item[BUFFER_VERTICES] = VERTEX_WORDS;
    return true;
}

const Integrator *integrator_ibpt(void)
{
    static const Integrator integrator = {.name = "ibpt",
                                          .summary = "three-strategy bidirectional path tracing",
                                          .depth_limit = IBPT_DEPTH_LIMIT,
                                          .strategies = STRATEGIES_IBPT,
                                          .roulette_scale = IBPT_ROULETTE_SCALE,
                                          .list = ibpt_list};
    return &integrator;
}
