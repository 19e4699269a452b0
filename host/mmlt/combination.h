/* Several estimates of the same picture in one: what the chains of a generation show, what the pool's samples show from
 * which they began, and what path tracing sees. In easy light path tracing is the best of them, in hard light the
 * chains, and which it is changes from place to place.
 *
 * Each tile of the picture takes a weight of every estimator, in inverse proportion to its variance (Graybill and Deal
 * 1959), which is estimated from the generations before: a weight that depends on nothing of the generation it is
 * applied to leaves the mean of that one right, where its chains are new. The combination of all is consistent.
 *
 * A path that carries more than a limit is a bright dot where a pool or path tracing has met it by chance; each shows
 * as much of it as the limit, and the rest is left to the chains, which come by many of its like. What it carries
 * depends on how probable it is that the estimator makes it, so both leave different parts. The same variances say how
 * the time is divided. */
#ifndef TWINLIGHT_MMLT_COMBINATION_H
#define TWINLIGHT_MMLT_COMBINATION_H

#include "mmlt/combination_learn.h"

/* The work of so many samples of every estimator, in samples of path tracing: with typical times of the CPU backend,
 * not those of the machine, so that the image does not depend on it. */
double combination_work(const double samples[ESTIMATOR_COUNT]);

/* For films like `film`. */
bool combination_init(Combination *combination, const Film *film, Error *error);
void combination_destroy(Combination *combination);

/* The estimators of one generation: light_sums from light_samples paths each (0: the estimator has nothing this time).
 * The film of the paths has direct light in `sums`, that of the chains what pools do not show, and in rare_sums what
 * path tracing does not. Makes the film of the chains the combination of all, with that direct light, in the weights
 * that `teacher` has learnt, then teaches `combination` what they were. Both may be the same where generations know
 * nothing of each other. Once *stop is 1 nothing more is learnt: no generation follows. */
bool combination_generation(Combination *combination, Combination *teacher, Film *const films[ESTIMATOR_COUNT],
                            const atomic_int *stop, Error *error);

/* Relative square error of a tile's pixels from so many samples of every estimator, direct light left out. Zeros before
 * enough is known. */
void combination_errors(const Combination *combination, const double samples[ESTIMATOR_COUNT], double *errors);

/* How many samples for every step of a chain. */
typedef struct Plan {
    double paths_per_step, pool_per_step;
} Plan;

/* The plan that makes the relative error of the whole picture smallest in a given time; zeros before enough is
 * known. */
Plan combination_plan(const Combination *combination);

#endif
