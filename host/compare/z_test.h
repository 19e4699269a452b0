/* Tests whether two renderings of a scene differ by more than their noise, which is estimated from two independent
 * half-images of each (layers halfA and halfB, render/layers.h).
 *
 * A value is the mean of one channel over a tile of 8 x 8 pixels; the halves of a single pixel would give its variance
 * with only one degree of freedom. With a and b the halves of a pixel, (a + b) / 2 is tested, and the expected square
 * of d = (a - b) / 2 is its variance, even if a and b have different variances. For a tile of n pixels and both
 * renderings
 *
 *   V = R sum d^2 / n^2,   R = (sum over renderings of (sum of d)^2) / (sum of d^2),
 *
 * where R is the variance inflation by correlation between neighbouring pixels, 1 if they are independent. The larger
 * of the tile's own R and the mean over 5 x 5 tiles and all channels is used, at least 1. The difference of the tile
 * means divided by sqrt(V) is compared with Student's t of (3 (sum x^2)^2 / sum x^4 - 2) / R degrees of freedom, at
 * least 1 and at most 2 n (Satterthwaite 1946 with the fourth moment of a normal x). x is d or the difference of the
 * renderings at a pixel, whichever gives fewer: many degrees of freedom for similar, independent pixels; few if a
 * single bright pixel or chain dominates the variance, or a single pixel the difference, such as one at a lamp's edge
 * that both halves happened to hit or to miss. */
#ifndef TWINLIGHT_COMPARE_Z_TEST_H
#define TWINLIGHT_COMPARE_Z_TEST_H

#include "base/error.h"

#include <stddef.h>

#define Z_TEST_TILE 8
#define Z_TEST_ALPHA 0.01 /* significance level for the whole image */
#define Z_TEST_SHARE 0.9975 /* fraction of values that must be within the bound */

typedef struct ZTest {
    size_t values; /* number tested: all except constant, equal ones */
    size_t outside; /* number with a probability below `bound` */
    double bound; /* probability threshold 1 - (1 - alpha)^(1 / values) (Sidak 1967) */
    double least; /* smallest probability */
    double below_5_percent; /* fraction of values with a probability below 0.05; near 0.05 if the renderings agree */
    double correlation; /* mean R */
    bool passed; /* fraction within the bound >= Z_TEST_SHARE */
} ZTest;

/* halves[i]: halves A and B of rendering i, width x height x 3 linear RGB; values that are not finite count as 0. Fails
 * when out of memory. */
bool z_test_compute(const float *const halves[2][2], int width, int height, ZTest *test, Error *error);

#endif
