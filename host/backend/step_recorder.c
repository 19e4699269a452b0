#include "backend/step_recorder.h"

#include "layout/kernel_list.h"
#include "layout/state.h"

#include <assert.h>
#include <stdlib.h>

bool recorder_init(Recorder *recorder, size_t capacity, Error *error)
{
    *recorder = (Recorder){.steps = malloc(capacity * sizeof(Step)), .capacity = capacity};
    return recorder->steps || error_memory(error, capacity * sizeof(Step), "the list of steps");
}

static void record(Recorder *recorder, Step step)
{
    assert(recorder->count < recorder->capacity);
    recorder->steps[recorder->count++] = step;
}

void recorder_step(Recorder *recorder, StepKind kind)
{
    record(recorder, (Step){.kind = kind});
}

void recorder_kernel(Recorder *recorder, unsigned kernel, bool live_only)
{
    record(recorder, (Step){.kind = STEP_KERNEL, .kernel = kernel, .live_only = live_only});
}

void recorder_skip(Recorder *recorder, size_t target)
{
    record(recorder, (Step){.kind = STEP_SKIP_IF_IDLE, .target = (unsigned)target});
}

void recorder_skips_end(Recorder *recorder)
{
    for (size_t i = 0; i < recorder->count; ++i)
        if (recorder->steps[i].kind == STEP_SKIP_IF_IDLE && recorder->steps[i].target == (unsigned)RECORDER_END)
            recorder->steps[i].target = (unsigned)recorder->count;
}

void recorder_walk(Recorder *recorder, uint segments, unsigned shade, unsigned extend)
{
    size_t each = extend == KERNEL_COUNT ? 3 : 4, end = recorder->count + (segments - (size_t)1) * each + 2;
    for (uint i = 1; i <= segments; ++i) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        recorder_kernel(recorder, shade, true);
        if (i == segments)
            break;
        if (extend != KERNEL_COUNT)
            recorder_kernel(recorder, extend, true);
        recorder_skip(recorder, end);
    }
    assert(recorder->count == end);
}

StepList recorder_list(const Recorder *recorder, const FrameParams *frame, uint path_words, const StateField *fields,
                       size_t field_count)
{
    bool media = (frame_features(frame) & FEATURE_MEDIUM) != 0;
    StepList list = {.steps = recorder->steps, .count = recorder->count, .fields = fields, .field_count = field_count};
    list.words_per_item[BUFFER_PATHS] = path_words;
    list.words_per_item[BUFFER_RAYS] = media ? RAY_MEDIA_WORDS : RAY_WORDS;
    list.words_per_item[BUFFER_HITS] = media ? HIT_MEDIA_WORDS : HIT_WORDS;
    list.words_per_item[BUFFER_SHADOWS] = media ? SHADOW_MEDIA_WORDS : SHADOW_WORDS;
    list.words_per_item[BUFFER_SPLATS] = SPLAT_WORDS;
    return list;
}

void step_list_destroy(StepList *list)
{
    free((void *)(uintptr_t)list->steps);
    *list = (StepList){0};
}
