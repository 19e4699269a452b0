/* The error of a picture, from two independent halves of it. With shares p and q of the halves A and B, the picture I =
 * p A + q B has the variance that p q (A - B)^2 has as its mean, if the shares are in proportion to the inverse of the
 * halves' variances. */
#ifndef TWINLIGHT_RENDER_HALVES_ERROR_H
#define TWINLIGHT_RENDER_HALVES_ERROR_H

#include "film/film.h"
#include "render/job.h"

typedef struct HalvesError {
    /* Relative error: of pixels sqrt(relMSE trimmed), of tiles sqrt(relMSE 8 x 8) (compare/metrics.h); or its
     * percentile. */
    double value;
    double
        deviation; /* standard error of `value`, from the differences between neighbouring tiles, or of the percentile */
} HalvesError;

/* Estimates the error of the films' sum, as `goal` measures it, of pixels relative to tile_light (render/tile_light.h),
 * of tiles to their mean. The worst pixels are left out because what they are relative to is not known: one that a
 * single bright path has met may have that light, or be a firefly on a dark place. Fails out of memory. */
bool halves_error(const Film halves[2], const ErrorGoal *goal, HalvesError *error_found, Error *error);

/* The same of the mean of two images of width x height x 3 values. */
bool halves_error_of_images(const float *const images[2], int width, int height, const ErrorGoal *goal,
                            HalvesError *error_found, Error *error);

#endif
