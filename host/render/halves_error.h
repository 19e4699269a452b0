/* The error of a picture, from two independent halves of it. With shares p and q of the halves A and B, the picture
 * I = p A + q B has the variance that p q (A - B)^2 has as its mean, if the shares are in proportion to the inverse of the
 * halves' variances. */
#ifndef TWINLIGHT_RENDER_HALVES_ERROR_H
#define TWINLIGHT_RENDER_HALVES_ERROR_H

#include "film/film.h"
#include "render/job.h"

typedef struct HalvesError {
    double value; /* relative error: sqrt(relMSE) (compare/metrics.h), of pixels or of tiles; or its percentile */
    double
        deviation; /* standard error of `value`, from the differences between neighbouring tiles, or of the percentile */
} HalvesError;

/* Estimates the error of the films' sum, as `goal` measures it. Where a pixel's own value is uncertain, the relative error is
 * that to a value between it and the mean of its tile (an empirical Bayes estimate; Efron and Morris 1973): a noisy
 * pixel that is dark by chance would make its error seem small, or large. Fails out of memory. */
bool halves_error(const Film halves[2], const ErrorGoal *goal, HalvesError *error_found, Error *error);

/* The same of the mean of two images of width x height x 3 values. */
bool halves_error_of_images(const float *const images[2], int width, int height, const ErrorGoal *goal,
                            HalvesError *error_found, Error *error);

#endif
