#include "mmlt/paths_estimator.h"

#include "backend/step_recorder.h"
#include "base/timing.h"
#include "camera/film_sum.h"
#include "chain/chain.h"
#include "mmlt/tuning.h"
#include "render/integrator.h"
#include "render/layers.h"
#include "render/photon_worth.h"

#include <float.h>
#include <math.h>

/* Makes the estimator's list for `frame`, which is complete then. */
static bool list_make(Estimator *estimator, FrameParams *frame, const Integrator *integrator, uint strategies,
                      const RenderRun *run, const Guide *guide, Error *error)
{
    frame->path.strategies = strategies;
    estimator_film_params(estimator, &frame->film);
    bool made = integrator->list(frame, &estimator->list, error);
    estimator->list.guide = guide;
    estimator->list.photons = &run->photons;
    return made;
}

static uint sequences_of(const RenderRun *run)
{
    return render_layers_compare_halves(run->options->layers) ? REPLICAS : 1;
}

bool paths_draw_everywhere(double part, double all)
{
    return part > PHOTONS_EVERYWHERE_PART || (part > PHOTONS_EVERYWHERE_LEAST && part > PHOTONS_EVERYWHERE_SHARE * all);
}

/* Sets *everywhere: whether path tracing draws by photons at all receivers. Not with layers by depth: what a path draws
 * at one vertex has several depths. */
static bool everywhere_choose(const RenderRun *run, const Film *film, bool *everywhere, Error *error)
{
    const double part = run->photons_part;
    double all = 0.0;
    *everywhere = false;
    if (film->depth_kinds != 0)
        return true;
    bool depends = part <= PHOTONS_EVERYWHERE_PART && paths_draw_everywhere(part, 0.0);
    if (depends && !photon_map_part(run, true, &all, error))
        return false;
    *everywhere = run->options->chains.photons_everywhere || paths_draw_everywhere(part, all);
    return true;
}

bool paths_estimator_init(PathsEstimator *paths, const RenderRun *run, Film *film, bool direct_only, bool completes,
                          const Guide *guide, Error *error)
{
    *paths = (PathsEstimator){.own = {.film = film},
                              .frame = run->frame,
                              .complete = {.film = film},
                              .complete_frame = run->frame,
                              .completes = completes,
                              .combined = !direct_only,
                              .forced_end = PATHS_FORCED,
                              .forced_each = 1,
                              .sequences = sequences_of(run)};
    paths->frame.partition.split_direct = !direct_only;
    paths->shows_more = pt_shows_more(&paths->frame);
    bool everywhere = false;
    if (!direct_only && !everywhere_choose(run, film, &everywhere, error))
        return false;
    paths->frame.photons.everywhere = paths->complete_frame.photons.everywhere = everywhere;
    if (direct_only && paths->frame.path.max_depth >= CHAIN_DEPTH_MIN)
        paths->frame.path.max_depth = CHAIN_DEPTH_MIN - 1;
    return list_make(&paths->own, &paths->frame, integrator_pt(), STRATEGIES_PT, run, guide, error) &&
           (!completes ||
            list_make(&paths->complete, &paths->complete_frame, integrator_pt(), STRATEGIES_PT, run, guide, error));
}

bool paths_estimator_init_bidirectional(PathsEstimator *paths, const RenderRun *run, Film *film, const Guide *guide,
                                        Error *error)
{
    *paths = (PathsEstimator){.own = {.film = film},
                              .frame = run->frame,
                              .bidirectional = true,
                              .combined = true,
                              .sequences = sequences_of(run)};
    paths->frame.partition.split_direct = 1;
    paths->frame.scene.guide_count = 0;
    return list_make(&paths->own, &paths->frame, integrator_bdpt(), STRATEGIES_BDPT & ~STRATEGY_CAMERA_DIRECT, run,
                     guide, error);
}

void paths_estimator_destroy(PathsEstimator *paths)
{
    step_list_destroy(&paths->own.list);
    step_list_destroy(&paths->complete.list);
}

/* Whether the samples so far are those that were wanted: not fewer, which would all be due at once. */
static bool samples_made(const PathsEstimator *paths)
{
    double most = (double)film_samples_most(paths->own.film->reconstruction);
    return (double)paths->done <= most && fmin(rint(paths->wanted), most) <= (double)paths->done;
}

void paths_estimator_archive(Archive *archive, PathsEstimator *paths)
{
    archive_same(archive, paths->sequences, "stratified sequences");
    ARCHIVE_FIELD(archive, paths->done);
    ARCHIVE_FIELD(archive, paths->of_sequence);
    archive_doubles(archive, &paths->wanted, 1, (NumberRange){0.0, DBL_MAX}, "samples of path tracing that are wanted");
    if (!archive->saves && !samples_made(paths))
        archive_fail(archive, "samples of path tracing: %llu of %.9g that are wanted", (unsigned long long)paths->done,
                     paths->wanted);
    ARCHIVE_FIELD(archive, paths->fresh);
    ARCHIVE_FIELD(archive, paths->seconds);
}

uint64_t paths_estimator_due(const PathsEstimator *paths, const Generation *generation, double more)
{
    uint64_t most = film_samples_most(paths->own.film->reconstruction);
    uint64_t target = (uint64_t)fmin(rint(paths->wanted + more), (double)most);
    if (generation->index >= paths->forced_first && generation->index < paths->forced_end) {
        uint64_t forced = (uint64_t)(generation->index - paths->forced_first + 1) * paths->forced_each;
        target = target < forced ? forced : target;
    }
    if (paths->shows_more && paths->beside > 0 && target <= paths->done)
        target = paths->done + 1;
    target = target < most ? target : most;
    return target > paths->done ? target - paths->done : 0;
}

void paths_estimator_plan(PathsEstimator *paths, const Generation *generation, double more)
{
    paths->fresh = paths_estimator_due(paths, generation, more);
    double all = (double)(paths->done + paths->fresh);
    /* Later generations do not make less for what the first ones had to make, unless nothing is learnt of it. */
    bool forced = paths->combined && paths->wanted + more < all - 0.5;
    paths->wanted = forced ? all : paths->wanted + more;
    paths->own.samples = paths->fresh * generation->run->crop_pixels;
}

/* A pass of one path that is not shown: a device builds its kernels now, and not while passes are timed. */
static bool kernels_prepare(Estimator *estimator, FrameParams frame, RenderRun *run, Error *error)
{
    uint64_t delivered;
    frame.pass.first_item = 0;
    frame.pass.item_count = 1;
    estimator->hidden = true;
    bool done = estimator_pass(estimator, run, &frame, true, &delivered, error);
    estimator->hidden = false;
    return done;
}

static uint sequence_of(const PathsEstimator *paths, const Generation *generation)
{
    return generation->index % paths->sequences;
}

/* The number of the first sample of the generation's sequence. */
static uint sequence_first(const PathsEstimator *paths, const Generation *generation)
{
    uint sequence = sequence_of(paths, generation);
    return generation->run->options->first_sample + sequence * SEQUENCE_SAMPLES;
}

uint paths_estimator_number(const PathsEstimator *paths, const Generation *generation)
{
    return sequence_first(paths, generation) + (uint)paths->of_sequence[sequence_of(paths, generation)];
}

void paths_estimator_count(PathsEstimator *paths, const Generation *generation)
{
    paths->done += paths->fresh;
    paths->of_sequence[sequence_of(paths, generation)] += paths->fresh;
}

/* Runs the generation's passes. */
static bool passes_run(PathsEstimator *paths, const Generation *generation, bool complete, bool *whole, Error *error)
{
    RenderRun *run = generation->run;
    Estimator *estimator = complete ? &paths->complete : &paths->own;
    FrameParams *frame = complete ? &paths->complete_frame : &paths->frame;
    uint64_t items = paths->own.samples;
    uint first = paths_estimator_number(paths, generation);
    frame->partition.clamp_threshold = generation->clamp_threshold;
    frame->partition.own_more = paths->fresh > 0 ? (float)paths->beside / (float)paths->fresh : 0.0f;
    frame->path.sobol = run->options->independent ? 0 : 1 + sequence_first(paths, generation);
    paths->delivered = 0;
    for (uint64_t next = 0; next < items && *whole; next += frame->pass.item_count) {
        uint64_t delivered, left = items - next;
        frame->pass.sample_index = first + (uint)(next / run->crop_pixels);
        frame->pass.first_item = (uint)(next % run->crop_pixels);
        frame->pass.item_count = left < PATHS_MAX ? (uint)left : PATHS_MAX;
        if (!estimator_pass(estimator, run, frame, true, &delivered, error))
            return false;
        paths->delivered += delivered;
        *whole = delivered == frame->pass.item_count;
    }
    return true;
}

bool paths_estimator_run(PathsEstimator *paths, const Generation *generation, bool complete, bool *whole, Error *error)
{
    RenderRun *run = generation->run;
    Film *film = paths->own.film;
    if (generation->index == 0 && run->options->seconds > 0.0 &&
        (!kernels_prepare(&paths->own, paths->frame, run, error) ||
         (paths->completes && !kernels_prepare(&paths->complete, paths->complete_frame, run, error))))
        return false;
    double begin = timing_now(), *seconds = &run->chains.direct_seconds;
    if (!passes_run(paths, generation, complete, whole, error))
        return false;
    if (*whole && paths->bidirectional)
        film_normalize_bidirectional(film, paths->fresh);
    else if (*whole && paths->combined)
        film_normalize(film, paths->fresh);
    if (*whole && complete)
        film->complete_samples = paths->own.samples;
    paths_estimator_count(paths, generation);
    paths->seconds = timing_now() - begin;
    seconds = paths->bidirectional ? &run->chains.bidirectional_seconds : seconds;
    *seconds += paths->seconds;
    return true;
}

void paths_estimator_alone(const PathsEstimator *paths)
{
    Film *film = paths->own.film;
    for (size_t i = 0; i < 3 * film_pixels(film); ++i) {
        film->sums[i] =
            film_sum_rounded((double)film_sum_shown(film->sums[i]) + (double)film_sum_shown(film->light_sums[i]));
        film->light_sums[i] = 0;
    }
    film->light_samples = 0;
}
