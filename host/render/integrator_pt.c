/* Path tracing: the order of its kernels. */
#include "render/integrator.h"

#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "path/path_state.h"

#include <assert.h>

/* Records two steps around the loop, seven per segment, and two in the last. Splitting off direct light adds two in the
 * second, which is never skipped. Splitting by depth adds two in each later one but the last and disables skips: a
 * skipped splat would repeat a stale one. */
static void steps_record(Recorder *recorder, uint max_depth, bool split, bool split_depths)
{
    size_t last = 1 + (size_t)(max_depth - 1) * 7 + 2 + (split ? 1 : 0);
    recorder_kernel(recorder, KERNEL_pt_start_paths, false);
    for (uint depth = 1;; ++depth) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        recorder_kernel(recorder, KERNEL_pt_shade_hits, true);
        if (split && depth == 2) {
            recorder_kernel(recorder, KERNEL_pt_splat_direct, false);
            recorder_step(recorder, STEP_SPLAT);
        }
        if (depth == max_depth)
            break;
        if (split_depths && depth > 2) {
            recorder_kernel(recorder, KERNEL_pt_splat, false);
            recorder_step(recorder, STEP_SPLAT);
        }
        recorder_kernel(recorder, KERNEL_pt_sample_lights, true);
        recorder_step(recorder, STEP_TRACE_SHADOW);
        recorder_kernel(recorder, KERNEL_pt_add_lights, true);
        recorder_kernel(recorder, KERNEL_pt_extend_paths, true);
        if (!split_depths && (!split || depth > 1))
            recorder_skip(recorder, last);
    }
    assert(split_depths || recorder->count == last);
    recorder_kernel(recorder, KERNEL_pt_splat, false);
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
    PATH_FIELD(PATH_LIMIT, 1, true, "limit"),
    PATH_FIELD(PATH_SURVIVED, 1, true, "survived"),
    PATH_FIELD(PATH_GATHERED, 1, false, "gathered"),
};
#undef PATH_FIELD

static bool pt_list(FrameParams *frame, StepList *list, Error *error)
{
    Recorder recorder;
    if (!recorder_init(&recorder, 6 + (size_t)frame->path.max_depth * 9, error))
        return false;
    steps_record(&recorder, frame->path.max_depth, frame->partition.split_direct != 0, frame->film.split_depths != 0);
    *list = recorder_list(&recorder, PATH_WORDS, PATH_FIELDS, sizeof PATH_FIELDS / sizeof PATH_FIELDS[0]);
    return true;
}

const Integrator *integrator_pt(void)
{
    static const Integrator integrator = {
        .name = "pt", .summary = "path tracing", .depth_limit = 65535, .strategies = STRATEGIES_PT, .list = pt_list};
    return &integrator;
}
