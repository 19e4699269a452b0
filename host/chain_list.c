#include "chain_list.h"

#include "bd_fields.h"
#include "chain.h"
#include "kernel_list.h"
#include "step_recorder.h"

static uint number_count(const FrameParams *frame)
{
    return NUMBER_VERTICES + (frame->max_depth - 1) * chain_vertex_numbers(frame);
}

uint chain_pass_fields(const FrameParams *frame)
{
    return CHAIN_PASS_NUMBERS + (frame->keep_chains ? number_count(frame) : 0);
}

/* One proposal. The light's walk has up to max_depth - 1 segments (s = d), the camera's one more (s = 0). */
static void record_proposal(Recorder *recorder, uint max_depth, bool splat)
{
    recorder_kernel(recorder, KERNEL_mlt_propose, false);
    recorder_walk(recorder, max_depth - 1, KERNEL_mlt_shade_hits, KERNEL_mlt_extend_walks);
    recorder_kernel(recorder, KERNEL_mlt_start_camera, false);
    recorder_walk(recorder, max_depth, KERNEL_mlt_shade_hits, KERNEL_mlt_extend_walks);
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
    Recorder recorder;
    if (!recorder_init(&recorder, capacity, error))
        return false;
    recorder_kernel(&recorder, KERNEL_mlt_begin, false);
    for (uint i = 0; i <= steps; ++i)
        record_proposal(&recorder, frame->max_depth, i > 0);
    recorder_kernel(&recorder, KERNEL_mlt_end, false);
    *list = recorder_list(&recorder, CHAIN_NUMBERS + number_count(frame), BD_FIELDS, BD_FIELD_COUNT);
    list->pass_fields = chain_pass_fields(frame);
    list->words_per_item[BUFFER_VERTICES] = CHAIN_VERTEX_WORDS;
    list->words_per_item[BUFFER_DENSITIES] = 2 * frame->max_depth;
    return true;
}
