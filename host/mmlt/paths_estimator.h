/* Path tracing beside the chains: easy light of all lengths, and all direct light. */
#ifndef TWINLIGHT_MMLT_PATHS_ESTIMATOR_H
#define TWINLIGHT_MMLT_PATHS_ESTIMATOR_H

#include "mmlt/estimator.h"
#include "mmlt/generation.h"

typedef struct PathsEstimator {
    Estimator own; /* film.sums: direct light, unless there is no other; rare_sums: the rare part of light_sums */
    FrameParams frame;
    uint64_t delivered; /* single-pixel samples in the generation under way */
    uint64_t done; /* samples of every pixel so far ... */
    uint64_t of_half[REPLICAS]; /* ... in even and in odd generations, the layers' halves: a stratified sequence each */
    double wanted; /* the same according to the plan, fractions included */
} PathsEstimator;

/* Makes film and list. run->frame: as from render_frame, not yet changed for chains. direct_only: of paths that chains
 * do not make. guide: for passes. Call paths_estimator_destroy even on failure. */
bool paths_estimator_init(PathsEstimator *paths, const RenderRun *run, bool direct_only, const Guide *guide,
                          Error *error);
void paths_estimator_destroy(PathsEstimator *paths);

/* Runs whole samples of all pixels until there have been as many as wanted, after `more` of them are wanted. In the
 * first two generations of either replica generation g ends with at least g + 1, so that variances become known.
 * *whole: set to false if stopped before the end. */
bool paths_estimator_run(PathsEstimator *paths, const Generation *generation, double more, bool *whole, Error *error);

/* Turns the film of a generation that was stopped into a picture by its own: finished samples count for their pixels. */
void paths_estimator_alone(PathsEstimator *paths);

#endif
