#include "mmlt/bidirectional_estimator.h"

#include "base/timing.h"
#include "film/pixel_order.h"
#include "mmlt/tuning.h"

#include <math.h>

/* The first sample number of trials: behind those of both stratified sequences. */
#define TRIAL_FIRST 0x60000000u

/* The most samples of a pixel that a generation is forced to have. */
#define FORCED_MOST 2u

bool bidirectional_estimator_init(BidirectionalEstimator *estimator, const RenderRun *run, Film *film, bool allowed,
                                  const Guide *guide, Error *error)
{
    *estimator = (BidirectionalEstimator){.allowed = allowed};
    return !allowed || paths_estimator_init_bidirectional(&estimator->whole, run, film, guide, error);
}

void bidirectional_estimator_destroy(BidirectionalEstimator *estimator)
{
    paths_estimator_destroy(&estimator->whole);
}

void bidirectional_estimator_archive(Archive *archive, BidirectionalEstimator *estimator)
{
    archive_same(archive, estimator->allowed, "bidirectional path tracing");
    if (!estimator->allowed)
        return;
    paths_estimator_archive(archive, &estimator->whole);
    archive_count(archive, &estimator->whole.forced_first, 0, 1, "first generations");
    ARCHIVE_FIELD(archive, estimator->whole.forced_end);
    archive_count(archive, &estimator->whole.forced_each, 0, FORCED_MOST, "samples of first generations");
}

void bidirectional_estimator_begin(BidirectionalEstimator *estimator, const Plan *plan, const RenderRun *run,
                                   double sample)
{
    const bool shown = run->options->chains.shown == 1 + ESTIMATOR_BIDIRECTIONAL;
    const double cost = estimator_cost(ESTIMATOR_BIDIRECTIONAL) / estimator_cost(ESTIMATOR_PATHS),
                 part = plan->timed ? cost * sample / run->options->seconds
                                    : cost * (double)plan->pixels / (double)plan->total;
    if (!estimator->allowed || !(shown || (part <= BIDIRECTIONAL_PART && run->frame.openings.count > 0)))
        return;
    estimator->whole.forced_first = 1;
    estimator->whole.forced_end = shown ? NONE : 1 + BIDIRECTIONAL_FORCED;
    estimator->whole.forced_each = (double)FORCED_MOST * part <= BIDIRECTIONAL_PART_EACH ? FORCED_MOST : 1;
}

/* Single-pixel samples of a trial that follows `done` work. */
static uint trial_samples(const Plan *plan)
{
    double most = TRIAL_SAMPLES * (double)plan->pixels,
           wanted = TRIAL_PART * (double)plan->done / estimator_cost(ESTIMATOR_BIDIRECTIONAL);
    return (uint)fmin(wanted, most);
}

/* As many as are planned or forced, but no more than there is time for. */
static void whole_plan(PathsEstimator *whole, const Generation *generation, const Plan *plan, uint count)
{
    paths_estimator_plan(whole, generation, plan_bidirectional_samples(plan, count));
    if ((double)whole->fresh <= plan->bidirectional_most)
        return;
    whole->fresh = (uint64_t)plan->bidirectional_most;
    whole->own.samples = whole->fresh * generation->run->crop_pixels;
    whole->wanted = (double)(whole->done + whole->fresh);
}

double bidirectional_estimator_plan(BidirectionalEstimator *estimator, const Generation *generation, const Plan *plan,
                                    uint count, bool known)
{
    PathsEstimator *whole = &estimator->whole;
    estimator->trial = 0;
    whole->fresh = whole->own.samples = 0;
    if (!estimator->allowed || count == 0)
        return 0.0;
    if (known || generation->index < whole->forced_end)
        whole_plan(whole, generation, plan, count);
    else if (generation->index >= PATHS_FORCED && !plan->easy)
        estimator->trial = trial_samples(plan);
    return (double)whole->own.samples + estimator->trial;
}

/* The trial's pixels are spread over the image, from a random one on. */
static bool trial_run(BidirectionalEstimator *estimator, const Generation *generation, bool *whole, Error *error)
{
    RenderRun *run = generation->run;
    Estimator *own = &estimator->whole.own;
    FrameParams frame = estimator->whole.frame;
    const FilmParams *film = &frame.film;
    uint64_t delivered;
    double place = generation_random(run, generation->index, GENERATION_TRIAL_PLACE) * (double)run->crop_pixels,
           begin = timing_now();
    frame.path.sobol = 0;
    frame.pass.sample_index = run->options->first_sample + TRIAL_FIRST + 2u * generation->index;
    frame.pass.pixel_first = (uint)place;
    frame.pass.pixel_stride = pixel_order_stride(film->crop_x1 - film->crop_x0, film->crop_y1 - film->crop_y0);
    frame.pass.item_count = estimator->trial;
    if (!estimator_pass(own, run, &frame, false, &delivered, error))
        return false;
    *whole = delivered == estimator->trial;
    film_normalize_bidirectional(own->film, 0);
    run->chains.bidirectional_seconds += timing_now() - begin;
    return true;
}

bool bidirectional_estimator_run(BidirectionalEstimator *estimator, const Generation *generation, bool *whole,
                                 Error *error)
{
    if (estimator->trial > 0)
        return trial_run(estimator, generation, whole, error);
    return paths_estimator_run(&estimator->whole, generation, false, whole, error);
}
