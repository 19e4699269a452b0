/* What tests of --error share. */
#ifndef TWINLIGHT_TESTS_RENDER_TEST_ERROR_H
#define TWINLIGHT_TESTS_RENDER_TEST_ERROR_H

#include "render/job.h"

#include "film/film.h"

#include <check.h>

#define WIDTH 61 /* the last tiles are not whole */
#define HEIGHT 45

typedef struct NoisyPicture {
    Film halves[2];
    float truth[3 * WIDTH * HEIGHT], picture[3 * WIDTH * HEIGHT];
} NoisyPicture;

/* The error by the truth, in the measure of the goal. */
double error_true(const NoisyPicture *made, const ErrorGoal *goal);

TCase *estimate_case(void);

#endif
