/* Where chains and pools spend their samples on the film.
 *
 * Relative error counts, so dark places need as many samples as bright ones; but chains of target f go where light is.
 * Their target is therefore f times a target importance that falls with a place's known brightness, and splats are
 * divided by it (two-stage targets, Hoberock and Hart 2010). Pools, whose samples are independent, visit pixels in
 * proportion to the root of their error: n samples leave an error v / n, and the sum over all pixels is least for n
 * proportional to sqrt(v) (Neyman 1934).
 *
 * Both are constant over each of IMPORTANCE_SIDE x IMPORTANCE_SIDE cells of the crop window. */
#ifndef TWINLIGHT_MMLT_IMPORTANCE_H
#define TWINLIGHT_MMLT_IMPORTANCE_H

#include "layout/frame_params.h"
#include "mmlt/combination.h"

/* Target importances are within these. */
#define IMPORTANCE_LEAST 1e-12
#define IMPORTANCE_MOST 1e12

/* Sets all target importances to 1. */
void importance_even(float importance[IMPORTANCE_CELLS]);

/* Computes target importances from what `combination` has learned of the picture, scaled to leave the mean contribution
 * weight unchanged. All 1 if the picture is black so far, or if its light gives no importances within the bounds. */
void importance_learn(const Combination *combination, float importance[IMPORTANCE_CELLS]);

/* Computes the visits of a pool per cell (Guide.visits): the pixels of a cell are visited the more often the larger
 * their relative error.
 *
 * samples: of each estimator, for which errors are predicted (combination_errors). visited[cell]: how often earlier
 * pools have visited the cell's pixels, relative to the mean. The last of `visits` is 0, which means that all pixels
 * are visited equally, while errors are unknown or if the film is too large. Fails only when out of memory. */
bool importance_visits(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                       const double visited[IMPORTANCE_CELLS], uint visits[IMPORTANCE_CELLS + 1], Error *error);

/* Saves the visits of a film of this size, or restores such as importance_visits computes: each pixel of a cell has the
 * same number of 1 ... VISITS_MOST. */
void importance_visits_archive(Archive *archive, uint visits[IMPORTANCE_CELLS + 1], const int size[2]);

/* The density ratio of a cell: how many times less often pools with these visits sample it than if they visited all
 * pixels equally. 0: the cell has no pixels. */
double importance_density_ratio(const Combination *combination, const uint visits[IMPORTANCE_CELLS + 1], uint cell);

#endif
