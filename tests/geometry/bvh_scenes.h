/* Scenes that hierarchies find hard, each with the number of walks that the tests send through it. */
#ifndef TWINLIGHT_TESTS_GEOMETRY_BVH_SCENES_H
#define TWINLIGHT_TESTS_GEOMETRY_BVH_SCENES_H

#include "support/geometry_fixture.h"

typedef struct BvhCase {
    const char *name;
    void (*make)(TestScene *test); /* finished */
    uint walks; /* against Embree; all cases together more than 2^20 */
    bool small; /* few enough primitives for brute force */
} BvhCase;

extern const BvhCase BVH_CASES[];
extern const uint BVH_CASE_COUNT;

#endif
