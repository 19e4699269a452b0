/* The variances of a combination's estimators in every tile, from the images of the generations so far. */
#ifndef TWINLIGHT_MMLT_COMBINATION_VARIANCES_H
#define TWINLIGHT_MMLT_COMBINATION_VARIANCES_H

#include "mmlt/combination_learn.h"

/* Recomputes combination->known from the series. other: of the other replica, or `combination` itself if there is
 * none. */
void combination_variances_update(Combination *combination, const Combination *other);

/* What a tile's variance is relative to. mean_light: combination_mean_light. */
double tile_relative_square(const CombinationTile *tile, double mean_light);

#endif
