/* Bidirectional path tracing beside the chains: all light of the paths that chains make, each sample with a light
 * subpath of its own. It leaves nothing to chains, so that it has fireflies; but where light comes from behind an
 * opening or from a covered lamp, all other estimators are worse. Its direct light, by the strategies of path
 * tracing (s <= 1), counts with that of path tracing, sample for sample; what photons draw (path/caustic.h) and
 * media emit is left to path tracing.
 *
 * A rendering begins with it where light comes through openings (layout/openings.h). Elsewhere a trial on some
 * pixels, which is not shown, tells its variance, unless path tracing alone would do. Then the plan has as much of
 * it as is best, which may be none. */
#ifndef TWINLIGHT_MMLT_BIDIRECTIONAL_ESTIMATOR_H
#define TWINLIGHT_MMLT_BIDIRECTIONAL_ESTIMATOR_H

#include "mmlt/paths_estimator.h"
#include "mmlt/plan.h"

typedef struct BidirectionalEstimator {
    PathsEstimator whole; /* samples of every pixel */
    bool allowed; /* otherwise no generation has any */
    uint trial; /* single-pixel samples of the trial in the generation under way; 0: no trial */
} BidirectionalEstimator;

/* As paths_estimator_init_bidirectional. allowed: otherwise there is nothing to make. */
bool bidirectional_estimator_init(BidirectionalEstimator *estimator, const RenderRun *run, Film *film, bool allowed,
                                  const Guide *guide, Error *error);
void bidirectional_estimator_destroy(BidirectionalEstimator *estimator);

/* Saves what the next generation needs, or restores it. */
void bidirectional_estimator_archive(Archive *archive, BidirectionalEstimator *estimator);

/* After the first generation: the next ones have it if light comes through openings, or if it alone is shown, unless a
 * sample of every pixel takes too large a part of the rendering; those that take little have two each. sample: seconds of
 * such a sample of path tracing. */
void bidirectional_estimator_begin(BidirectionalEstimator *estimator, const Plan *plan, const RenderRun *run,
                                   double sample);

/* Plans the samples of a generation with `count` chains: `trial`, or whole.fresh. known: its variance is. Returns their
 * number. */
double bidirectional_estimator_plan(BidirectionalEstimator *estimator, const Generation *generation, const Plan *plan,
                                    uint count, bool known);

/* Runs these. The film's light_sums hold all of their light. *whole: set to false if stopped before the end. */
bool bidirectional_estimator_run(BidirectionalEstimator *estimator, const Generation *generation, bool *whole,
                                 Error *error);

#endif
