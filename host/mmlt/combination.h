/* Combines the estimates of a generation's picture: the Markov chains, the bootstrap pool they start from, path tracing,
 * and bidirectional path tracing where there are samples of it. Path tracing is best in easy light, chains in hard
 * light, bidirectional path tracing where light comes from behind an opening; the combination decides per tile.
 *
 * Each tile weights the estimators in inverse proportion to their variances (Graybill and Deal 1959), as estimated from
 * earlier generations. Weights that do not depend on the generation they are applied to leave its mean unbiased, if its
 * chains are new; the combination over all generations is consistent.
 *
 * A bright path that a pool or path tracing finds by chance would be a firefly. Each shows a path only up to a clamping
 * threshold and leaves the rest to the chains, which have many more samples of such paths: the excess (of the pool) and
 * the rare light (of path tracing). Contribution depends on the density with which an estimator makes the path, so the
 * two rests differ. Bidirectional path tracing leaves nothing. The same variances determine how time is divided
 * (mmlt/combination_rates.h). */
#ifndef TWINLIGHT_MMLT_COMBINATION_H
#define TWINLIGHT_MMLT_COMBINATION_H

#include "mmlt/combination_variances.h"

/* Allocates for films of the crop size of `film`. Destroy it even on failure. */
bool combination_init(Combination *combination, const Film *film, Error *error);
void combination_destroy(Combination *combination);

/* From now on `combination` uses the memory of `other`, which must outlive it, for what is known of tiles and for
 * scratch. For two replicas that take turns: a generation's weights are set from what is known after the one before it,
 * and what was known before that is not needed any more. Both must be for the same crop and not have learnt
 * anything. */
void combination_share(Combination *combination, const Combination *other);

/* Saves what is known, or restores it into a combination for films of the same size. Any numbers will do: weights are
 * in [0, 1] whatever variances are, and light that is not finite counts as unknown. */
void combination_archive(Archive *archive, Combination *combination);

/* Sets the weights of a generation of `samples` of each estimator, from what is known: CombinationTile.weight and
 * paths_rare of every tile, and their means. Returns the weight of the generation's picture in that of all, at least 1:
 * its worth, in samples of path tracing. */
uint64_t combination_weights_set(Combination *combination, const double samples[ESTIMATOR_COUNT]);

/* errors[tile]: the predicted relative square error from `samples` of each estimator, without direct light and up to a
 * constant factor; all 0 until variances are known. */
void combination_errors(const Combination *combination, const double samples[ESTIMATOR_COUNT], double *errors);

#endif
