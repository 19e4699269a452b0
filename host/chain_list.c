#include "chain_list.h"

#include "bd_fields.h"
#include "chain.h"
#include "kernel_list.h"

#include <assert.h>
#include <stdlib.h>

static uint number_count(const FrameParams *frame)
{
    return NUMBER_VERTICES + (frame->max_depth - 1) * chain_vertex_numbers(frame);
}

uint chain_pass_fields(const FrameParams *frame)
{
    return CHAIN_PASS_NUMBERS + (frame->keep_chains ? number_count(frame) : 0);
}

/* Up to `segments` segments of a walk; nothing is drawn at the last vertex. */
static void record_walk(Recorder *recorder, uint segments)
{
    size_t end = recorder->count + (size_t)segments * 4 - 2;
    for (uint i = 1; i <= segments; ++i) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        recorder_kernel(recorder, KERNEL_mlt_shade_hits, true);
        if (i == segments)
            break;
        recorder_kernel(recorder, KERNEL_mlt_extend_walks, true);
        recorder_skip(recorder, end);
    }
    assert(recorder->count == end);
}

/* One proposal. The light's walk has up to max_depth - 1 segments (s = d), the camera's one more (s = 0). */
static void record_proposal(Recorder *recorder, uint max_depth, bool splat)
{
    recorder_kernel(recorder, KERNEL_mlt_propose, false);
    record_walk(recorder, max_depth - 1);
    recorder_kernel(recorder, KERNEL_mlt_start_camera, false);
    record_walk(recorder, max_depth);
    recorder_kernel(recorder, KERNEL_mlt_connect, false);
    recorder_step(recorder, STEP_TRACE_SHADOW);
    recorder_kernel(recorder, KERNEL_mlt_accept, false);
    if (splat)
        recorder_step(recorder, STEP_SPLAT);
}

ChainWords chain_words(const FrameParams *frame)
{
    uint paths = CHAIN_NUMBERS + number_count(frame), densities = 2 * frame->max_depth;
    return (ChainWords){.state = paths - BD_HEADER_WORDS,
                        .densities = densities,
                        .all = paths + densities + CHAIN_VERTEX_WORDS + RAY_WORDS + HIT_WORDS + SHADOW_WORDS +
                               SPLAT_WORDS};
}

bool chain_list(const FrameParams *frame, uint steps, StepList *list, Error *error)
{
    size_t per_step = 5 + 4 * (2 * (size_t)frame->max_depth - 1), capacity = (steps + 1) * per_step + 2;
    Recorder recorder = {malloc(capacity * sizeof(Step)), 0};
    if (!recorder.steps)
        return error_memory(error, capacity * sizeof(Step), "the list of steps");
    recorder_kernel(&recorder, KERNEL_mlt_begin, false);
    for (uint i = 0; i <= steps; ++i)
        record_proposal(&recorder, frame->max_depth, i > 0);
    recorder_kernel(&recorder, KERNEL_mlt_end, false);
    assert(recorder.count <= capacity);
    *list = (StepList){.steps = recorder.steps,
                       .count = recorder.count,
                       .pass_fields = chain_pass_fields(frame),
                       .fields = BD_FIELDS,
                       .field_count = BD_FIELD_COUNT};
    list->words_per_item[BUFFER_PATHS] = CHAIN_NUMBERS + number_count(frame);
    list->words_per_item[BUFFER_RAYS] = RAY_WORDS;
    list->words_per_item[BUFFER_HITS] = HIT_WORDS;
    list->words_per_item[BUFFER_SHADOWS] = SHADOW_WORDS;
    list->words_per_item[BUFFER_SPLATS] = SPLAT_WORDS;
    list->words_per_item[BUFFER_VERTICES] = CHAIN_VERTEX_WORDS;
    list->words_per_item[BUFFER_DENSITIES] = 2 * frame->max_depth;
    return true;
}
