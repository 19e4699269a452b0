/* What the four estimators that share MMLT's image have in common: the Markov chains (mmlt/chains_estimator.h), the
 * bootstrap pool that they start from (mmlt/pool_estimator.h), path tracing (mmlt/paths_estimator.h), and, where it
 * helps, bidirectional path tracing (mmlt/bidirectional_estimator.h). Each runs passes of its own list, one after the
 * other into the same film; what they leave there is combined to one image (mmlt/combined_image.h). */
#ifndef TWINLIGHT_MMLT_ESTIMATOR_H
#define TWINLIGHT_MMLT_ESTIMATOR_H

#include "film/film.h"
#include "render/run.h"

/* Index of an estimator in what there is of each: samples, weights, variances. */
typedef enum EstimatorKind {
    ESTIMATOR_CHAINS,
    ESTIMATOR_POOL,
    ESTIMATOR_PATHS,
    ESTIMATOR_BIDIRECTIONAL,
    ESTIMATOR_COUNT
} EstimatorKind;

typedef struct Estimator {
    StepList list;
    Film *film; /* the generation's */
    bool hidden; /* its splats are not shown */
    uint64_t samples; /* in the generation under way: steps of chains, samples of the others */
} Estimator;

/* Sets what passes whose splats go to the film know of it. */
void estimator_film_params(const Estimator *estimator, FilmParams *params);

/* Runs such a pass. parts: a stopped pass leaves the splats of the items that were finished. *delivered: receives their
 * number, frame->pass.item_count unless stopped. */
bool estimator_pass(Estimator *estimator, RenderRun *run, const FrameParams *frame, bool parts, uint64_t *delivered,
                    Error *error);

/* The cost of `samples` of each estimator, in samples of path tracing. Uses typical costs on the CPU backend, not
 * measured ones, so that the image does not depend on the machine. */
double estimators_work(const double samples[ESTIMATOR_COUNT]);

/* One estimator's part of that. */
double estimator_work(EstimatorKind kind, const double samples[ESTIMATOR_COUNT]);

/* The cost of one sample. */
double estimator_cost(EstimatorKind kind);

#endif
