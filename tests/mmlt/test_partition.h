/* What each of MMLT's estimators does with one and the same path: the kernels of the bootstrap pool, of chains and of
 * path tracing, run for single paths. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_PARTITION_H
#define TWINLIGHT_TESTS_MMLT_TEST_PARTITION_H

#include "layout/scene_types.h"

#include <stdbool.h>

#define PARTITION_DEPTH 5u /* most segments of a path */
#define PARTITION_LIGHTS 4u /* most infinite lights of a scene */

typedef struct Partition Partition;

/* Aborts the test if the scene cannot be read. The target importance varies from cell to cell. */
Partition *partition_open(const char *text);
void partition_close(Partition *partition);

/* Makes sample `item` of the pool: both walks and all their connections. */
void partition_sample(Partition *partition, uint item, float clamp_threshold);

/* A path of the sample: one for every strategy (s, t), or for s = 0 at infinity one for every infinite light. */
typedef struct PathParts {
    double pool; /* part of the path that the pool shows */
    double excess; /* part of a chain's visits that is left by the pool, in the mean over their random numbers */
    double paths; /* part that path tracing shows */
    double paths_rare; /* part that it keeps as its own rare light; NAN where it gathers nothing or several lights */
    double rare; /* part of a chain's visits that is left by path tracing */
    double pool_carried, chain_carried; /* f by pool and by chain */
    double paths_carried; /* what the path carries in path tracing, over the threshold there */
    double told; /* the same as the chain has it; NAN where that is below the threshold, so that nothing is divided */
} PathParts;

typedef enum PathFound {
    PATH_NONE, /* the sample has no such path */
    PATH_UNFOUND, /* path tracing cannot make it */
    PATH_FOUND
} PathFound;

/* light: index among the infinite lights, for s = 0 at infinity, where a chain stands for one of them at a time; those
 * for which it hardly ever stands are left out (PATH_NONE). Else 0. */
PathFound partition_path(Partition *partition, uint s, uint t, uint light, PathParts *parts);

#endif
