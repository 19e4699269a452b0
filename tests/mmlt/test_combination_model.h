/* Combinations of given variances, and the least variance that can be had of them, by search. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_MODEL_H
#define TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_MODEL_H

#include "mmlt/test_combination.h"
#include "support/test_files.h"

/* Width and height differ, and half of the last row of tiles is outside the image. */
#define WIDTH 64
#define HEIGHT 44
#define PIXELS ((size_t)WIDTH * HEIGHT)

typedef struct Known {
    Film film;
    Combination combination;
    unsigned state;
} Known;

/* 2^x, x uniform from -most to most. */
double octaves(Known *known, double most);

/* Sets random variances for all estimators, and random numbers of samples from which they were estimated. */
void known_tell(Known *known, double range);

/* Makes a combination of random variances, of which that of bidirectional path tracing counts as unknown. */
void known_init(Known *known, unsigned seed);
void known_destroy(Known *known);

/* The weight of path tracing's own rare light, against the chains', with which rare light has the least variance: in
 * the tile or, if that is less, in all tiles together. The chains' variance counts twice, and as their errors are
 * correlated. None where light may be hidden from path tracing. factor: of the chains' variance in `all`. */
double rare_weight(const Combination *all, const CombinationTile *tile, const double samples[ESTIMATOR_COUNT],
                   double factor);

/* A tile, samples of each estimator, the weight of path tracing's own rare light, and the correlation of the chains'
 * errors. */
typedef struct TileTerms {
    const CombinationTile *tile;
    const double *samples;
    double v, correlation;
} TileTerms;

/* Variance of a tile in which path tracing has the weight w and the rest is split between chains (weight c) and pool.
 * The excess that pools clamp comes from chains and goes with chains and pool; the rare remainder of path tracing goes
 * with path tracing. Model of mmlt/combination.c: the rare remainder is correlated with the other estimate through the
 * chains' weight c in it. What chains have part in has the variance of correlated errors. */
double combined_variance(const TileTerms *terms, double w, double c);

/* Ternary search in [0, 1] for the weight with the least variance, which is convex in either: of path tracing
 * (of_paths), or of chains relative to the pool. */
double weight_search(const TileTerms *terms, bool of_paths, double c);

double least_variance(const TileTerms *terms, double *w, double *c);

/* DARK_PART of the squared mean light. */
double dark_square(const Combination *combination);

/* The variance of chains is a / T_pool + b / T_steps. In a given total time it is least if pools have the part sqrt(a)
 * / (sqrt(a) + sqrt(b)), which is POOL_TIME. Returns the variance of one step relative to that of the past. */
double chains_vary(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                   const double costs[ESTIMATOR_COUNT]);

/* A tile with the chains' variances times `factor`. */
CombinationTile tile_with(const Combination *combination, size_t tile, double factor);

/* The image's error with these numbers of samples. */
double picture_error(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                     const double costs[ESTIMATOR_COUNT]);

#endif
