/* What a combination (mmlt/combination.h) knows of its estimators, and learns of them in every generation. */
#ifndef TWINLIGHT_MMLT_COMBINATION_LEARN_H
#define TWINLIGHT_MMLT_COMBINATION_LEARN_H

#include "film/film.h"
#include "film/pixel_series.h"

#include <stdatomic.h>

#define TILE_SIDE 8 /* pixels a side */

typedef enum Estimator { ESTIMATOR_CHAINS, ESTIMATOR_POOL, ESTIMATOR_PATHS, ESTIMATOR_COUNT } Estimator;

/* Series of pictures more: what chains see that pools do not show, and that path tracing does not. */
#define SERIES_EXCESS ESTIMATOR_COUNT
#define SERIES_RARE (ESTIMATOR_COUNT + 1)
#define SERIES_COUNT (ESTIMATOR_COUNT + 2)

typedef struct CombinationTile {
    double spread[SERIES_COUNT]; /* variance of one sample, summed over the pixels */
    double direct; /* the same of direct light */
    double light, indirect; /* sums of luminances */
    double weight[ESTIMATOR_COUNT]; /* of the latest generation */
} CombinationTile;

typedef struct Combination {
    int size[2], tiles[2];
    PixelSeries pixels[SERIES_COUNT], sums[SERIES_COUNT]; /* luminances of pixels, and summed over tiles */
    PixelSeries direct; /* of pixels */
    double *density_ratio; /* of a tile: by how much more rarely pools visit it than if they visited all alike */
    double *gaps; /* of a tile: that less what a pool has visited of a pixel, where it is less, summed over pools */
    CombinationTile *known; /* a tile */
    bool ready[SERIES_COUNT]; /* the estimator's variances are there */
    double weight[ESTIMATOR_COUNT]; /* of the latest generation, mean over the tiles */
    int shown; /* 1 + the estimator that has all of it in generations that have samples of it; 0: as is best */
} Combination;

/* Errors of places darker than the root of this part of the mean square light count as there. */
#define DARK_PART 0.1

size_t combination_tile_count(const Combination *combination);
size_t combination_tile_of(const Combination *combination, size_t pixel);

/* What the estimators of a generation show joins the series, as long as *stop is 0. picture, tiles: room for as many
 * values. */
void combination_films_learn(Combination *combination, Film *const films[], float *picture, float *tiles,
                             const atomic_int *stop);

/* What is known of the tiles from the series. ratios: room for as many as there are tiles. */
void combination_variances_update(Combination *combination, double *ratios);

#endif
