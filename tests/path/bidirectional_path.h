/* Densities of a whole path, and its weights for each strategy by the kernels' function. */
#ifndef TWINLIGHT_TESTS_PATH_BIDIRECTIONAL_PATH_H
#define TWINLIGHT_TESTS_PATH_BIDIRECTIONAL_PATH_H

#include "path/strategy.h"

#define PATH_SEGMENTS_MAX 31

/* A path x_0 ... x_k, x_0 on the lens and x_k on a light. */
typedef struct TestPath {
    uint k;
    float camera[PATH_SEGMENTS_MAX + 1]; /* density of x_i when sampled from the camera */
    float light[PATH_SEGMENTS_MAX + 1]; /* and when sampled from the light */
    bool delta[PATH_SEGMENTS_MAX + 1];
    float connect; /* as in StrategyEnds */
    bool hittable;
} TestPath;

/* Whether the set includes (s, k + 1 - s) and that strategy can make the path. */
bool test_path_possible(const TestPath *path, uint set, uint s);

/* The weights of strategy (s, k + 1 - s); the second returns the first of them. */
StrategyWeights test_path_weights(const TestPath *path, uint set, uint exponent, uint s);
float test_path_weight(const TestPath *path, uint set, uint exponent, uint s);

#endif
