/* Builds the tables that shared/layout/distribution.h samples. */
#ifndef TWINLIGHT_SCENE_DISTRIBUTION_BUILD_H
#define TWINLIGHT_SCENE_DISTRIBUTION_BUILD_H

#include "base/array.h"
#include "layout/scene_types.h"

/* Fills out[0 ... n-1] with an alias table (Vose, "A linear algorithm for generating random numbers with a given
 * distribution", 1991) for n weights in any unit. The table's probabilities equal weight / sum to a relative error of
 * 1e-6 for weights above 1e-30 of the mean; an index of weight 0 is never chosen. Fails if a weight is negative or not
 * finite, if no weight is positive, or if n is 0 or above 2^32 - 2. */
bool alias_build(const double *weights, size_t n, AliasBucket *out, Error *error);

/* Appends the CDFs of a piecewise-constant density over the unit square to `lookup` (an Array of float) and fills *out.
 * weights: width x height values in row order, row 0 at v = 0, proportional to the integral of the density over each
 * cell (cells are weighted by their size by the caller). Every CDF value is a multiple of 2^-23, and every cell of
 * positive weight gets at least 2^-23 of its row (and every such row of the marginal), so that rounding loses no cell
 * and sampling with random_float matches the density exactly. A table of zeros is allowed; its density is 0. Fails if a
 * weight is negative or not finite, and if width or height is 0 or above 2^20. */
bool distribution2d_build(const float *weights, uint width, uint height, Array *lookup, Distribution2D *out,
                          Error *error);

#endif
