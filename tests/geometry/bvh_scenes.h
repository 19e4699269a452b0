/* Scenes that are hard for hierarchies, each with the number of random walks that the tests trace through it. */
#ifndef TWINLIGHT_TESTS_GEOMETRY_BVH_SCENES_H
#define TWINLIGHT_TESTS_GEOMETRY_BVH_SCENES_H

#include "support/geometry_fixture.h"

typedef struct BvhCase {
    const char *name;
    void (*make)(TestScene *test); /* makes the scene and calls test_scene_finish */
    uint walks; /* compared with Embree, more than 2^20 over all cases; in make check a quarter */
    bool small; /* few enough primitives for brute force */
} BvhCase;

extern const BvhCase BVH_CASES[];
extern const uint BVH_CASE_COUNT;

#endif
