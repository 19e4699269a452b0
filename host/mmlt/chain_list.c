#include "mmlt/chain_list.h"

#include "backend/step_recorder.h"
#include "chain/chain_numbers.h"
#include "layout/kernel_list.h"
#include "render/bd_fields.h"

#include <stdio.h>

static const StateField CHAIN_FIELDS[] = {
    BD_FIELD_LIST,
    {BUFFER_PATHS, CHAIN_KEY, 1, false, "key of the current path"},
    {BUFFER_PATHS, CHAIN_PROPOSED_KEY, 1, false, "key of the proposal"},
    {BUFFER_PATHS, CHAIN_STEP, 1, false, "step"},
    {BUFFER_PATHS, CHAIN_MOVE, 1, false, "mutation, subpaths and banks"},
    {BUFFER_PATHS, CHAIN_LUMINANCE, 1, true, "luminance of the current path"},
    {BUFFER_PATHS, CHAIN_COLOR, 3, true, "its colour"},
    {BUFFER_PATHS, CHAIN_FILM, 1, true, "film x of the current path"},
    {BUFFER_PATHS, CHAIN_FILM + 1u, 1, true, "film y of the current path"},
    {BUFFER_PATHS, CHAIN_PENDING, 1, true, "pending visits"},
    {BUFFER_PATHS, CHAIN_PROPOSED_FILM, 1, true, "film x of the proposal"},
    {BUFFER_PATHS, CHAIN_PROPOSED_FILM + 1u, 1, true, "film y of the proposal"},
    {BUFFER_PATHS, CHAIN_TALLY, MUTATION_COUNT, false, "proposals and acceptances"},
    {BUFFER_PATHS, CHAIN_BAD, 1, false, "first proposal that was not finite"},
    {BUFFER_PATHS, CHAIN_RUN, 1, false, "proposals rejected in a row"},
    {BUFFER_PATHS, CHAIN_EXPECTED, 1, true, "expected luminance of the first proposal"},
    {BUFFER_PATHS, CHAIN_SUBPATHS, CHAIN_NUMBERS - CHAIN_SUBPATHS, false, "subpaths"},
    {BUFFER_PATHS, CHAIN_NUMBERS, NUMBER_VERTICES, false, "coordinates of camera and light"},
};

static uint number_count(const FrameParams *frame)
{
    return NUMBER_VERTICES + (frame->path.max_depth - 1) * chain_vertex_numbers(frame);
}

uint chain_pass_fields(const FrameParams *frame)
{
    return CHAIN_PASS_NUMBERS + (frame->chains.keep ? number_count(frame) : 0);
}

/* Records one proposal. The light subpath has up to max_depth - 1 segments (s = d), the camera subpath up to max_depth
 * (s = 0). */
static void record_proposal(Recorder *recorder, const FrameParams *frame, bool splat)
{
    uint max_depth = frame->path.max_depth;
    recorder_kernel(recorder, KERNEL_mlt_propose, false);
    recorder_walk(recorder, max_depth - 1, KERNEL_mlt_walk, KERNEL_COUNT);
    recorder_kernel(recorder, KERNEL_mlt_start_camera, false);
    recorder_walk(recorder, max_depth, KERNEL_mlt_walk, KERNEL_COUNT);
    recorder_kernel(recorder, KERNEL_mlt_connect, false);
    recorder_step(recorder, STEP_TRACE_SHADOW);
    if (frame_features(frame) & FEATURE_MEDIUM)
        recorder_kernel(recorder, KERNEL_mlt_connect, false); /* connection_traced in path/bd_connect.h */
    recorder_kernel(recorder, KERNEL_mlt_accept, false);
    if (splat)
        recorder_step(recorder, STEP_SPLAT);
}

ChainWords chain_words(const FrameParams *frame)
{
    uint paths = CHAIN_NUMBERS + number_count(frame), densities = 2 * frame->path.max_depth;
    bool media = (frame_features(frame) & FEATURE_MEDIUM) != 0;
    uint rays = media ? RAY_MEDIA_WORDS + HIT_MEDIA_WORDS + SHADOW_MEDIA_WORDS : RAY_WORDS + HIT_WORDS + SHADOW_WORDS;
    return (ChainWords){.state = paths - BD_HEADER_WORDS,
                        .densities = densities,
                        .all = paths + densities + CHAIN_VERTEX_WORDS + rays + SPLAT_WORDS};
}

void chain_memory_print(const FrameParams *frame, unsigned chains)
{
    ChainWords words = chain_words(frame);
    const struct {
        const char *what;
        uint words;
    } rows[] = {{"state", words.state},
                {"densities", words.densities},
                {"walk, vertices, rays", words.all - words.state - words.densities},
                {"all", words.all}};
    printf("%u chains of up to %u segments\n", chains, frame->path.max_depth);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i)
        printf("%-22s %5zu bytes a chain %10.1f MB\n", rows[i].what, rows[i].words * sizeof(uint),
               1e-6 * (double)chains * (double)(rows[i].words * sizeof(uint)));
}

bool chain_list(const FrameParams *frame, uint steps, StepList *list, Error *error)
{
    size_t per_step = 6 + 3 * (2 * (size_t)frame->path.max_depth - 1), capacity = (steps + 1) * per_step + 2;
    Recorder recorder;
    if (!recorder_init(&recorder, capacity, error))
        return false;
    recorder_kernel(&recorder, KERNEL_mlt_begin, false);
    for (uint i = 0; i <= steps; ++i)
        record_proposal(&recorder, frame, i > 0);
    recorder_kernel(&recorder, KERNEL_mlt_end, false);
    *list = recorder_list(&recorder, frame, CHAIN_NUMBERS + number_count(frame), CHAIN_FIELDS,
                          sizeof CHAIN_FIELDS / sizeof CHAIN_FIELDS[0]);
    list->pass_fields = chain_pass_fields(frame);
    list->words_per_item[BUFFER_VERTICES] = CHAIN_VERTEX_WORDS;
    list->words_per_item[BUFFER_DENSITIES] = 2 * frame->path.max_depth;
    return true;
}
