/* Path tracing: the order of its kernels. */
#include "render/integrator.h"

#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "path/caustic.h"
#include "path/path_state.h"

#include <assert.h>

/* The kernels of a list. */
typedef struct PathSteps {
    uint max_depth;
    bool split; /* what no other estimator shows is splatted apart */
    bool split_depths; /* what each segment brings is splatted apart */
    bool caustics;
    bool caustic_shadows; /* caustic_has_shadows */
    bool own_last; /* with `split`: that is more than direct light, and splatted at the end */
} PathSteps;

/* Steps of caustics_record. The first segment has no skip and no shadow ray. */
static size_t caustics_count(const PathSteps *steps)
{
    return 1 + 2 + (steps->caustic_shadows ? 4 : 3) * (size_t)CAUSTIC_VERTICES;
}

/* A direction drawn by photons. */
static void caustics_record(Recorder *recorder, const PathSteps *steps)
{
    size_t end = recorder->count + caustics_count(steps);
    recorder_kernel(recorder, KERNEL_pt_start_caustics, false);
    for (uint i = 0; i <= CAUSTIC_VERTICES; ++i) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        if (i > 0)
            recorder_skip(recorder, end);
        if (i > 0 && steps->caustic_shadows)
            recorder_step(recorder, STEP_TRACE_SHADOW);
        recorder_kernel(recorder, KERNEL_pt_walk_caustics, true);
    }
    assert(recorder->count == end);
}

/* From the vertex after `depth` segments to the next ray. Kernels after caustics see no live rays. */
static void vertex_record(Recorder *recorder, const PathSteps *steps, uint depth)
{
    recorder_kernel(recorder, KERNEL_pt_sample_lights, true);
    recorder_step(recorder, STEP_TRACE_SHADOW);
    recorder_kernel(recorder, KERNEL_pt_add_lights, true);
    const uint draws = receiver_draw_count(depth);
    for (uint i = 0; i < draws && steps->caustics; ++i)
        caustics_record(recorder, steps);
    recorder_kernel(recorder, KERNEL_pt_extend_paths, !steps->caustics);
}

/* The light that paths have gathered since the last splat: its rare part first, if it is split off. */
static void splat_record(Recorder *recorder, const PathSteps *steps)
{
    if (steps->split) {
        recorder_kernel(recorder, KERNEL_pt_splat_rare, false);
        recorder_step(recorder, STEP_SPLAT);
    }
    recorder_kernel(recorder, KERNEL_pt_splat, false);
}

/* What no other estimator shows. */
static void own_record(Recorder *recorder)
{
    recorder_kernel(recorder, KERNEL_pt_splat_own, false);
    recorder_step(recorder, STEP_SPLAT);
}

/* The second segment, with which direct light ends, is never skipped if that is split off. Splitting by depth disables
 * skips: a skipped splat would repeat a stale one. Without caustics
 * skips come before the ray query, which the device is then still busy with; with caustics the latest query before that
 * place is one of theirs. */
static void steps_record(Recorder *recorder, const PathSteps *steps)
{
    const bool skips = !steps->split_depths;
    recorder_kernel(recorder, KERNEL_pt_start_paths, false);
    for (uint depth = 1;; ++depth) {
        recorder_step(recorder, STEP_TRACE_CLOSEST);
        if (skips && steps->caustics && depth > (steps->split ? 2u : 1u))
            recorder_skip(recorder, RECORDER_END);
        recorder_kernel(recorder, KERNEL_pt_shade_hits, true);
        if (steps->split && depth == 2 && !steps->own_last)
            own_record(recorder);
        if (depth == steps->max_depth)
            break;
        if (steps->split_depths && depth > 2) {
            splat_record(recorder, steps);
            recorder_step(recorder, STEP_SPLAT);
        }
        vertex_record(recorder, steps, depth);
        if (skips && !steps->caustics && (!steps->split || depth > 1))
            recorder_skip(recorder, RECORDER_END);
    }
    recorder_skips_end(recorder);
    if (steps->split && steps->own_last)
        own_record(recorder);
    splat_record(recorder, steps);
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
    PATH_FIELD(PATH_RECEIVER, RECEIVER_WORDS, true, "receiver"),
    PATH_FIELD(PATH_DELTA, 1, false, "delta lobes"),
    PATH_FIELD(PATH_OWN, 3, true, "radiance that no other estimator shows"),
    PATH_FIELD(PATH_CAUSTIC_SEGMENTS, 1, false, "segments of the caustic path"),
    PATH_FIELD(PATH_CAUSTIC_LIGHT, 1, false, "light of its photon"),
    PATH_FIELD(PATH_CAUSTIC_BETA, 3, true, "throughput of the caustic path"),
    PATH_FIELD(PATH_RARE, 3, true, "rare radiance"),
    PATH_FIELD(PATH_LIGHT_SHOWN, 1, true, "shown part of the light sample"),
    PATH_FIELD(PATH_OFFSET, 1, false, "place in the pixel's filter"),
    PATH_FIELD(PATH_CAUSTIC_OVER, 1, true, "path tracing over the caustic path"),
    PATH_FIELD(PATH_CAUSTIC_DRAWN, 1, false, "directions drawn by photons"),
    PATH_FIELD(PATH_LIGHT_PDF, 1, true, "density of the light sample"),
    PATH_FIELD(PATH_LIGHT_OTHER, 1, true, "density of its direction by the BSDF"),
};
#define PATH_FIELDS_OF_MEDIA 2 /* the last ones */
#undef PATH_FIELD

bool pt_shows_more(const FrameParams *frame)
{
    return frame->photons.count > 0 || (frame_features(frame) & FEATURE_MEDIUM_EMISSION) != 0;
}

static bool pt_list(FrameParams *frame, StepList *list, Error *error)
{
    Recorder recorder;
    const PathSteps steps = {.max_depth = frame->path.max_depth,
                             .split = frame->partition.split_direct != 0,
                             .split_depths = frame->film.split_depths != 0,
                             .caustics = frame->photons.count > 0,
                             .caustic_shadows = caustic_has_shadows(frame_features(frame)),
                             .own_last = pt_shows_more(frame)};
    size_t per_segment = 11 + (steps.caustics ? RECEIVER_DRAWS * caustics_count(&steps) : 0);
    if (!recorder_init(&recorder, 10 + (size_t)frame->path.max_depth * per_segment, error))
        return false;
    steps_record(&recorder, &steps);
    bool media = (frame_features(frame) & FEATURE_MEDIUM) != 0;
    size_t fields = sizeof PATH_FIELDS / sizeof PATH_FIELDS[0];
    *list = recorder_list(&recorder, frame, media ? PATH_MEDIA_WORDS : PATH_WORDS, PATH_FIELDS,
                          media ? fields : fields - PATH_FIELDS_OF_MEDIA);
    return true;
}

const Integrator *integrator_pt(void)
{
    static const Integrator integrator = {.name = "pt",
                                          .summary = "path tracing",
                                          .depth_limit = 65535,
                                          .strategies = STRATEGIES_PT,
                                          .photons = true,
                                          .list = pt_list};
    return &integrator;
}
