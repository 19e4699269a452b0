/* Whole samples of every pixel beside the chains. Path tracing: easy light of all lengths, and direct light. And
 * bidirectional path tracing: direct light, and all light of the paths that chains make
 * (mmlt/bidirectional_estimator.h). */
#ifndef TWINLIGHT_MMLT_PATHS_ESTIMATOR_H
#define TWINLIGHT_MMLT_PATHS_ESTIMATOR_H

#include "mmlt/estimator.h"
#include "mmlt/generation.h"

typedef struct PathsEstimator {
    Estimator own; /* direct light apart from the rest, with which the other estimators are combined */
    FrameParams frame;
    Estimator complete; /* all light together, if `completes`: it takes less time */
    FrameParams complete_frame;
    bool completes;
    bool bidirectional; /* by bidirectional path tracing: all of its light but direct light is in light_sums */
    bool combined; /* with the other estimators, which learn from it; otherwise it shows what these do not make */
    /* Generations forced_first ... forced_end - 1 have so many samples of every pixel each, whatever is wanted. */
    uint forced_first, forced_end, forced_each;
    bool shows_more; /* pt_shows_more */
    /* Samples of every pixel by bidirectional path tracing in the generation under way, whose direct light is in the
     * film. */
    uint64_t beside;
    uint64_t delivered; /* single-pixel samples in the generation under way */
    uint64_t done; /* samples of every pixel so far ... */
    uint sequences; /* stratified ones: 1, or one for even and one for odd generations, so that the layers' halves are
                       independent, which costs noise; docs/TUNING.md */
    uint64_t of_sequence[REPLICAS]; /* samples of every pixel so far */
    double wanted; /* the same of all according to the plan, fractions included, and what it did not ask for (`due`) */
    uint64_t fresh; /* samples of every pixel in the generation under way */
    double seconds; /* that these took */
} PathsEstimator;

/* Whether path tracing beside chains draws by photons at all receivers (path/caustic_rest.h), if those where no light
 * subpath can make the path bring `part` of the light, and all `all`, as photon_map_part says. */
bool paths_draw_everywhere(double part, double all);

/* Makes the lists. run->frame: as from render_frame, not yet changed for chains. film: the generation's. direct_only:
 * of paths that chains do not make. completes: `complete`, too. guide: for passes. Call paths_estimator_destroy even on
 * failure. */
bool paths_estimator_init(PathsEstimator *paths, const RenderRun *run, Film *film, bool direct_only, bool completes,
                          const Guide *guide, Error *error);

/* The same of bidirectional path tracing, which no generation has before mmlt/bidirectional_estimator.h says so. */
bool paths_estimator_init_bidirectional(PathsEstimator *paths, const RenderRun *run, Film *film, const Guide *guide,
                                        Error *error);

void paths_estimator_destroy(PathsEstimator *paths);

/* Saves what the next generation needs, or restores it. */
void paths_estimator_archive(Archive *archive, PathsEstimator *paths);

/* The samples of every pixel in the generation, if `more` of them are wanted than before it: whole ones, until there
 * have been about as many as wanted. After n of the generations that are forced there are at least n times forced_each;
 * and one if others are in the film beside which it shows more. */
uint64_t paths_estimator_due(const PathsEstimator *paths, const Generation *generation, double more);

/* Sets `fresh` and own.samples to that. */
void paths_estimator_plan(PathsEstimator *paths, const Generation *generation, double more);

/* The samples of every pixel that are wanted, but not yet done: what rounding has left. */
static inline double paths_estimator_owed(const PathsEstimator *paths)
{
    return paths->wanted - (double)paths->done;
}

/* The number of the generation's first sample of a pixel: its place in a stratified sequence, or in the second, which
 * begins at 2^30. */
uint paths_estimator_number(const PathsEstimator *paths, const Generation *generation);

/* Runs these. complete: by `complete`, and the film says that its samples are. *whole: set to false if stopped before
 * the end. */
bool paths_estimator_run(PathsEstimator *paths, const Generation *generation, bool complete, bool *whole, Error *error);

/* Counts the generation's samples. */
void paths_estimator_count(PathsEstimator *paths, const Generation *generation);

/* Turns the film after a run that was stopped into a picture by its own: finished samples count for their pixels. */
void paths_estimator_alone(const PathsEstimator *paths);

#endif
