/* Where the chains of a picture go, and pools more often than elsewhere. The error that counts is relative: dark places
 * need as many visits as bright ones, but chains that go after f spend them where light is. So they go after f times an
 * importance that is the smaller the brighter a place is known to be, and what they carry to the film is divided by it.
 * Pools, whose samples are independent, visit a pixel the more often the larger the error is there: n samples leave an
 * error v / n, and the sum of all is least where n is in proportion to the root of v (Neyman 1934). */
#ifndef TWINLIGHT_MMLT_IMPORTANCE_H
#define TWINLIGHT_MMLT_IMPORTANCE_H

#include "layout/scene_types.h"
#include "mmlt/combination.h"

/* No place before another. */
void importance_even(float importance[IMPORTANCE_CELLS]);

/* From what `combination` has learnt of the picture so far. Scaled such that the mean worth of a path stays what it is
 * without. */
void importance_learn(const Combination *combination, float importance[IMPORTANCE_CELLS]);

/* How often a pool visits the pixels of every cell, as frame->visits: the more often the larger the relative error is
 * there, as `combination` knows it from so many samples of every estimator and from pools that have visited a cell's
 * pixels visited[cell] times as often as the picture's. Where too little is known, all alike: the last is 0. */
bool importance_visits(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                       const double visited[IMPORTANCE_CELLS], uint visits[IMPORTANCE_CELLS + 1], Error *error);

/* By how much more rarely pools of such visits visit a cell's pixels than if they visited all alike. 0: it has no
 * pixels. */
double importance_density_ratio(const Combination *combination, const uint visits[IMPORTANCE_CELLS + 1], uint cell);

/* Tells `combination` of the visits of the pools that it learns from next. */
void importance_tell(const uint visits[IMPORTANCE_CELLS + 1], Combination *combination);

#endif
