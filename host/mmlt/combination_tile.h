/* The optimal combination of the estimates of a tile, and the error of a picture that is combined so. */
#ifndef TWINLIGHT_MMLT_COMBINATION_TILE_H
#define TWINLIGHT_MMLT_COMBINATION_TILE_H

#include "mmlt/combination_variances.h"

/* Weights for a tile, and the variance by them, given the samples of each estimator. */
typedef struct TileCombination {
    /* weight of path tracing plus rare, against chains and pool plus excess */
    double paths;
    double chains; /* weight of the chains against the pool; both share the excess */
    double paths_rare; /* weight of path tracing's own rare light against the chains' */
    double bidirectional; /* weight of bidirectional path tracing against all others */
    double variance;
} TileCombination;

/* What the combinations of all tiles have in common. */
typedef struct CombinationTerms {
    const double *samples; /* of each estimator */
    double correlation; /* Combination.chains_correlation */
    double rare_most; /* largest weight of path tracing's own rare light */
    double bidirectional_most; /* largest weight of bidirectional path tracing */
    double bidirectional_first; /* its weight if its variance is not known */
} CombinationTerms;

/* The terms for these numbers of samples, which must outlive them. factor: of the chains' variances. every: from one
 * tile in so many. */
CombinationTerms combination_terms(const Combination *combination, const double samples[ESTIMATOR_COUNT], double factor,
                                   size_t every);

/* The weights of least variance for a tile. */
TileCombination tile_combination(const CombinationTile *tile, const CombinationTerms *terms);

/* Relative square error of the picture (up to a constant factor) from this many samples of each estimator. with_direct:
 * of all light, and not just of what is combined. every: of one tile in so many. */
double combination_error(const Combination *combination, const double samples[ESTIMATOR_COUNT], bool with_direct,
                         size_t every);

#endif
