/* Estimators of synthetic noise, whose generations a combination learns from. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_ESTIMATORS_H
#define TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_ESTIMATORS_H

#include "mmlt/test_combination.h"

#define SIDE 32
#define PIXELS ((size_t)SIDE * SIDE)

typedef struct Estimators {
    Film films[ESTIMATOR_COUNT];
    Combination combination;
    uint draws;
} Estimators;

void estimators_init(Estimators *estimators);
void estimators_destroy(Estimators *estimators);

/* Uniform with mean 0 and variance 1. */
double noise(Estimators *estimators);

/* Every pixel of the estimator gets `mean` + noise of standard deviation `deviation` at one sample per pixel. */
void estimator_set(Estimators *estimators, int s, double samples, double mean, double deviation);

/* Sets the rare light of a pixel, at 4 steps and 2 samples of path tracing per pixel: as chains and as path tracing
 * find it. */
void rare_set(Estimators *estimators, size_t pixel, double by_chains, double by_paths);

/* Combines what the estimators have; the mean of the picture. */
double generation(Estimators *estimators);

#endif
