/* Path tracing: which kernels run when. */
#include "integrator.h"

#include "kernel_list.h"
#include "path_state.h"

#include <assert.h>
#include <stdlib.h>

/* Two steps around the loop, seven in it, two in its last turn. */
static size_t steps_record(Step *steps, uint max_depth)
{
    size_t n = 0, last = 1 + (size_t)(max_depth - 1) * 7 + 2;
    steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_start_paths};
    for (uint depth = 1;; ++depth) {
        steps[n++] = (Step){.kind = STEP_TRACE_CLOSEST};
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_shade_hits, .live_only = true};
        if (depth == max_depth)
            break;
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_sample_lights, .live_only = true};
        steps[n++] = (Step){.kind = STEP_TRACE_SHADOW};
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_add_lights, .live_only = true};
        steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_extend_paths, .live_only = true};
        steps[n++] = (Step){.kind = STEP_SKIP_IF_IDLE, .target = (unsigned)last};
    }
    assert(n == last);
    steps[n++] = (Step){.kind = STEP_KERNEL, .kernel = KERNEL_pt_splat};
    return n;
}

#define PATH_FIELD(field, words, is_float, name)                                                                       \
    {                                                                                                                  \
        BUFFER_PATHS, field, words, is_float, name                                                                     \
    }
static const StateField PATH_FIELDS[] = {
    PATH_FIELD(PATH_PIXEL, 1, false, "pixel"),
    PATH_FIELD(PATH_SAMPLE, 1, false, "sample"),
    PATH_FIELD(PATH_DEPTH, 1, false, "depth"),
    PATH_FIELD(PATH_FLAGS, 1, false, "flags"),
    PATH_FIELD(PATH_WEIGHT, 1, true, "filter weight"),
    PATH_FIELD(PATH_BETA, 3, true, "throughput"),
    PATH_FIELD(PATH_RADIANCE, 3, true, "radiance"),
    PATH_FIELD(PATH_PDF_W, 1, true, "density of the last direction"),
    PATH_FIELD(PATH_ETA_SCALE, 1, true, "eta^2"),
    PATH_FIELD(PATH_POINT, 3, true, "vertex"),
    PATH_FIELD(PATH_NG, 3, true, "geometric normal"),
    PATH_FIELD(PATH_FRAME, 3, true, "shading normal"),
    PATH_FIELD(PATH_FRAME + 3, 3, true, "shading tangent"),
    PATH_FIELD(PATH_WO, 3, true, "outgoing direction"),
    PATH_FIELD(PATH_LIGHT, 3, true, "light sample"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_KIND, 1, false, "BSDF kind"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_FLAGS, 1, false, "BSDF flags"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_COLOR0, 3, true, "BSDF first colour"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_COLOR1, 3, true, "BSDF second colour"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_ALPHA_X, 1, true, "BSDF alpha x"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_ALPHA_Y, 1, true, "BSDF alpha y"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_ETA, 1, true, "BSDF eta"),
    PATH_FIELD(PATH_BSDF + STORED_BSDF_COAT, 1, false, "BSDF coat table"),
};
#undef PATH_FIELD

static bool pt_list(FrameParams *frame, StepList *list, Error *error)
{
    uint max_depth = frame->max_depth;
    size_t capacity = 4 + (size_t)max_depth * 7;
    Step *steps = malloc(capacity * sizeof *steps);
    if (!steps)
        return error_memory(error, capacity * sizeof *steps, "the list of steps");
    *list = (StepList){.steps = steps, .count = steps_record(steps, max_depth)};
    list->words_per_item[BUFFER_PATHS] = PATH_WORDS;
    list->words_per_item[BUFFER_RAYS] = RAY_WORDS;
    list->words_per_item[BUFFER_HITS] = HIT_WORDS;
    list->words_per_item[BUFFER_SHADOWS] = SHADOW_WORDS;
    list->words_per_item[BUFFER_SPLATS] = SPLAT_WORDS;
    list->fields = PATH_FIELDS;
    list->field_count = sizeof PATH_FIELDS / sizeof PATH_FIELDS[0];
    return true;
}

const Integrator *integrator_pt(void)
{
    static const Integrator integrator = {
        .name = "pt", .summary = "path tracing", .depth_limit = 65535, .strategies = STRATEGIES_PT, .list = pt_list};
    return &integrator;
}
