/* Whether two renderings of one scene differ by more than their noise, which each shows by two independent halves
 * (layers halfA and halfB, render/layers.h).
 *
 * A value is the mean of one channel over a tile of 8 x 8 pixels; a single pixel's halves would say its variance with
 * one degree of freedom, which tests nothing. With a and b the halves at a pixel, (a + b) / 2 is what is tested, and d
 * = (a - b) / 2 has its variance as the mean of its square, whatever the variances of a and b. For a tile of n pixels
 * and both renderings
 *
 *   V = R sum d^2 / n^2,   R = (sum over renderings of (sum of d)^2) / (sum of d^2),
 *
 * where R is what correlation between neighbouring pixels adds, 1 for independent ones. It is the tile's own or the
 * mean over 5 x 5 tiles and all channels, whichever is larger, at least 1. The difference of the tile's means over
 * sqrt(V) is taken for a t of Student with (3 (sum x^2)^2 / sum x^4 - 2) / R degrees of freedom, at least 1
 * (Satterthwaite 1946 with the fourth moment of a normal x), x being d or the difference of the renderings at a pixel,
 * whichever gives fewer: as many as there are pixels where those are alike and independent, few where one bright dot or
 * one chain makes the variance, and where one pixel makes the difference, such as one at a lamp's edge that both halves
 * happen to see or to miss. */
#ifndef TWINLIGHT_COMPARE_Z_TEST_H
#define TWINLIGHT_COMPARE_Z_TEST_H

#include "base/error.h"

#include <stddef.h>

#define Z_TEST_TILE 8
#define Z_TEST_ALPHA 0.01 /* of the whole picture */
#define Z_TEST_SHARE 0.9975 /* of values that must be within the bound */

typedef struct ZTest {
    size_t values; /* that were tested: all but those that are constant and equal */
    size_t outside; /* that are improbable below `bound` */
    double bound; /* probability: 1 - (1 - alpha)^(1 / values) (Sidak 1967) */
    double least; /* the smallest probability of all */
    double below_5_percent; /* share of values with a probability below 0.05: near 0.05 when all is well */
    double correlation; /* mean R */
    bool passed; /* share within the bound >= Z_TEST_SHARE */
} ZTest;

/* halves[i]: halves A and B of rendering i, width x height x 3 linear RGB; what is not finite counts as 0. Fails when
 * memory is out. */
bool z_test_compute(const float *const halves[2][2], int width, int height, ZTest *test, Error *error);

#endif
