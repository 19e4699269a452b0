#include "render/verify.h"

#include "layout/kernel_list.h"
#include "path/path_state.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Items compared at once: enough to keep a device busy, few enough to keep a few hundred bytes of each. */
#define BLOCK_ITEMS 8192u

#define KERNEL_NAME(name, count, ...) #name,
static const char *const KERNEL_NAMES[KERNEL_COUNT] = {KERNEL_LIST(KERNEL_NAME)};
#undef KERNEL_NAME

/* The buffers that all integrators share (layout/state.h). */
#define SHARED_FIELD(buffer, field, words, is_float, name)                                                             \
    {                                                                                                                  \
        buffer, field, words, is_float, name                                                                           \
    }
static const StateField SHARED_FIELDS[] = {
    SHARED_FIELD(BUFFER_RAYS, RAY_ORIGIN, 3, true, "ray origin"),
    SHARED_FIELD(BUFFER_RAYS, RAY_DIRECTION, 3, true, "ray direction"),
    SHARED_FIELD(BUFFER_RAYS, RAY_T_MAX, 1, true, "ray length"),
    SHARED_FIELD(BUFFER_HITS, HIT_T, 1, true, "hit distance"),
    SHARED_FIELD(BUFFER_HITS, HIT_PRIMITIVE, 1, false, "hit primitive"),
    SHARED_FIELD(BUFFER_HITS, HIT_INSTANCE, 1, false, "hit instance"),
    SHARED_FIELD(BUFFER_HITS, HIT_U, 1, true, "hit u"),
    SHARED_FIELD(BUFFER_HITS, HIT_V, 1, true, "hit v"),
    SHARED_FIELD(BUFFER_SHADOWS, RAY_ORIGIN, 3, true, "shadow ray origin"),
    SHARED_FIELD(BUFFER_SHADOWS, RAY_DIRECTION, 3, true, "shadow ray direction"),
    SHARED_FIELD(BUFFER_SHADOWS, RAY_T_MAX, 1, true, "shadow ray length"),
    SHARED_FIELD(BUFFER_SHADOWS, SHADOW_OCCLUDED, 1, false, "occlusion"),
    SHARED_FIELD(BUFFER_SPLATS, SPLAT_PIXEL, 1, false, "splat pixel"),
    SHARED_FIELD(BUFFER_SPLATS, SPLAT_COLOR, 3, true, "splat colour"),
    SHARED_FIELD(BUFFER_SPLATS, SPLAT_OFFSET, 1, false, "splat offset"),
};
#undef SHARED_FIELD

/* ---- one side's state -------------------------------------------------------------------------------------------- */

/* State of a block: all buffers in a row, each [field][BLOCK_ITEMS]. */
typedef struct BlockState {
    uint *words;
    size_t offset[BUFFER_COUNT];
} BlockState;

typedef struct Verifier {
    const BackendMember *sides;
    const StepList *list;
    FrameParams frame; /* for the current block */
    uint words_per_item;
    BlockState state[2];
    uint *pass; /* initial contents of the list's pass_words, restored before every run; NULL: none */
} Verifier;

static size_t pass_bytes(const StepList *list)
{
    return list->pass_words ? (size_t)list->pass_fields * list->pass_stride * sizeof(uint) : 0;
}

static bool verifier_init(Verifier *verifier, const BackendMember sides[2], const FrameParams *frame,
                          const StepList *list, Error *error)
{
    *verifier = (Verifier){.sides = sides, .list = list, .frame = *frame};
    size_t offset[BUFFER_COUNT] = {0};
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id) {
        offset[id] = (size_t)verifier->words_per_item * BLOCK_ITEMS;
        verifier->words_per_item += list->words_per_item[id];
    }
    for (int side = 0; side < 2; ++side) {
        size_t words = (size_t)verifier->words_per_item * BLOCK_ITEMS;
        verifier->state[side].words = calloc(words, sizeof(uint));
        memcpy(verifier->state[side].offset, offset, sizeof offset);
        if (!verifier->state[side].words)
            return error_memory(error, words * sizeof(uint), "the state of two backends");
    }
    size_t bytes = pass_bytes(list);
    verifier->pass = bytes > 0 ? malloc(bytes) : NULL;
    if (bytes > 0 && !verifier->pass)
        return error_memory(error, bytes, "a copy of a pass's words");
    if (bytes > 0)
        memcpy(verifier->pass, list->pass_words, bytes);
    return true;
}

static void verifier_destroy(Verifier *verifier)
{
    for (int side = 0; side < 2; ++side)
        free(verifier->state[side].words);
    free(verifier->pass);
}

/* Context of a StateSink. */
typedef struct BlockWriter {
    const Verifier *verifier;
    BlockState *state;
} BlockWriter;

/* Called by several threads, for disjoint items. */
static void block_write(void *context, BufferId buffer, const uint *words, uint first, uint count, uint stride)
{
    const BlockWriter *writer = context;
    uint *out = writer->state->words + writer->state->offset[buffer];
    for (uint field = 0; field < writer->verifier->list->words_per_item[buffer]; ++field)
        memcpy(out + (size_t)field * BLOCK_ITEMS + first, words + (size_t)field * stride, count * sizeof(uint));
}

/* Runs the first `steps` steps of the list on both sides. */
static bool block_run(Verifier *verifier, size_t steps, Error *error)
{
    StepList list = *verifier->list;
    list.count = steps;
    for (int side = 0; side < 2; ++side) {
        BlockWriter writer = {verifier, &verifier->state[side]};
        const BackendMember *member = &verifier->sides[side];
        if (verifier->pass)
            memcpy(list.pass_words, verifier->pass, pass_bytes(&list));
        if (!member->interface->inspect(member->backend, &verifier->frame, &list, block_write, &writer, error))
            return false;
    }
    return true;
}

/* ---- a difference ------------------------------------------------------------------------------------------------ */

typedef struct Difference {
    BufferId buffer;
    uint field, item;
    uint bits[2];
} Difference;

/* Finds the lowest item that differs, and its first differing field. */
static bool block_difference(const Verifier *verifier, Difference *difference)
{
    difference->item = NONE;
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id) {
        for (uint field = 0; field < verifier->list->words_per_item[id]; ++field) {
            size_t offset = verifier->state[0].offset[id] + (size_t)field * BLOCK_ITEMS;
            const uint *a = verifier->state[0].words + offset, *b = verifier->state[1].words + offset;
            uint limit =
                difference->item < verifier->frame.pass.item_count ? difference->item : verifier->frame.pass.item_count;
            if (memcmp(a, b, limit * sizeof(uint)) == 0)
                continue;
            uint item = 0;
            while (a[item] == b[item])
                ++item;
            *difference = (Difference){(BufferId)id, field, item, {a[item], b[item]}};
        }
    }
    return difference->item != NONE;
}

static const StateField *field_find(const StateField *fields, size_t count, const Difference *difference)
{
    for (size_t i = 0; i < count; ++i)
        if (fields[i].buffer == difference->buffer && difference->field >= fields[i].first &&
            difference->field < fields[i].first + fields[i].words)
            return &fields[i];
    return NULL;
}

static void field_print(char *out, size_t size, const StateField *field, const Difference *difference)
{
    static const char *const component[3] = {".x", ".y", ".z"};
    if (field)
        snprintf(out, size, "%s%s", field->name, field->words == 3 ? component[difference->field - field->first] : "");
    else
        snprintf(out, size, "word %u of buffer %d", difference->field, (int)difference->buffer);
}

static void value_print(char *out, size_t size, bool is_float, uint bits)
{
    if (is_float)
        snprintf(out, size, "%.9g (0x%08x)", (double)bits_float(bits), bits);
    else
        snprintf(out, size, "%u (0x%08x)", bits, bits);
}

/* "kernel pt_shade_hits (segment 2)": the segment is the number of closest-hit steps up to and including this step. */
static void step_print(char *out, size_t size, const StepList *list, size_t index)
{
    const Step *step = &list->steps[index];
    unsigned segment = 0;
    for (size_t i = 0; i <= index; ++i)
        segment += list->steps[i].kind == STEP_TRACE_CLOSEST;
    const char *name = step->kind == STEP_KERNEL          ? KERNEL_NAMES[step->kernel]
                       : step->kind == STEP_TRACE_CLOSEST ? "closest hits"
                       : step->kind == STEP_TRACE_SHADOW  ? "shadow rays"
                                                          : "the end of all paths";
    snprintf(out, size, "%s%s (segment %u)", step->kind == STEP_KERNEL ? "kernel " : "", name, segment);
}

static bool difference_report(const Verifier *verifier, size_t step, const Difference *difference, Error *error)
{
    const StateField *field = field_find(verifier->list->fields, verifier->list->field_count, difference);
    if (!field)
        field = field_find(SHARED_FIELDS, sizeof SHARED_FIELDS / sizeof SHARED_FIELDS[0], difference);
    char where[128], what[96], values[2][48], device[2][64];
    step_print(where, sizeof where, verifier->list, step);
    field_print(what, sizeof what, field, difference);
    for (int side = 0; side < 2; ++side) {
        BackendStatistics statistics;
        verifier->sides[side].interface->statistics(verifier->sides[side].backend, &statistics);
        value_print(values[side], sizeof values[side], field && field->is_float, difference->bits[side]);
        snprintf(device[side], sizeof device[side], "%s, %.40s", verifier->sides[side].interface->name,
                 statistics.device);
    }
    return error_set(error, "%s, item %llu: %s is %s on %s but %s on %s", where,
                     (unsigned long long)verifier->frame.pass.first_item + difference->item, what, values[0], device[0],
                     values[1], device[1]);
}

/* ---- the blocks -------------------------------------------------------------------------------------------------- */

/* Whether no item has a live ray. */
static bool block_is_idle(const Verifier *verifier)
{
    const BlockState *state = &verifier->state[0];
    const uint *t_max = state->words + state->offset[BUFFER_RAYS] + (size_t)RAY_T_MAX * BLOCK_ITEMS;
    for (uint item = 0; item < verifier->frame.pass.item_count; ++item)
        if (bits_float(t_max[item]) > 0.0f)
            return false;
    return true;
}

/* Length of the next prefix: one step more, or one beyond the target of a skip that is taken. */
static size_t steps_next(const Verifier *verifier, size_t steps)
{
    const Step *last = &verifier->list->steps[steps - 1];
    bool idle = last->kind == STEP_SKIP_IF_IDLE && block_is_idle(verifier);
    return (idle ? last->target : steps) + 1;
}

/* Compares after every step, leaving out those that are skipped. */
static bool block_verify_steps(Verifier *verifier, const atomic_int *stop, uint64_t *prefixes, Error *error)
{
    Difference difference;
    for (size_t steps = 1; steps <= verifier->list->count && !*stop; steps = steps_next(verifier, steps)) {
        if (!block_run(verifier, steps, error))
            return false;
        if (block_difference(verifier, &difference))
            return difference_report(verifier, steps - 1, &difference, error);
        ++*prefixes;
    }
    return true;
}

/* Compares after the last step; on a difference, finds the first step with one. */
static bool block_verify_end(Verifier *verifier, Error *error)
{
    static const atomic_int never = 0;
    Difference difference;
    uint64_t prefixes = 0;
    if (!block_run(verifier, verifier->list->count, error))
        return false;
    if (!block_difference(verifier, &difference))
        return true;
    if (!block_verify_steps(verifier, &never, &prefixes, error))
        return false;
    return error_set(error, "the two backends differ after the last step, but not when they are run again step by "
                            "step: one of them does not reproduce its own bits");
}

bool verify_run(const BackendMember sides[2], const FrameParams *frame, const StepList *list, uint64_t items,
                const atomic_int *stop, VerifyReport *report, Error *error)
{
    Verifier verifier;
    bool same = verifier_init(&verifier, sides, frame, list, error);
    *report = (VerifyReport){.words = verifier.words_per_item};
    for (uint64_t first = 0; same && first < items && !*stop; first += BLOCK_ITEMS) {
        uint64_t left = items - first;
        verifier.frame.pass.first_item = (uint)(frame->pass.first_item + first);
        verifier.frame.pass.item_count = left < BLOCK_ITEMS ? (uint)left : BLOCK_ITEMS;
        same = first == 0 ? block_verify_steps(&verifier, stop, &report->prefixes, error)
                          : block_verify_end(&verifier, error);
        report->items += same && (first > 0 || !*stop) ? verifier.frame.pass.item_count : 0;
    }
    verifier_destroy(&verifier);
    return same;
}
