/* The parts of the test of hierarchies. */
#ifndef TWINLIGHT_TESTS_GEOMETRY_TEST_BVH_H
#define TWINLIGHT_TESTS_GEOMETRY_TEST_BVH_H

#include <check.h>

TCase *bvh_adversary_tcase(void);
TCase *bvh_build_tcase(void);
TCase *bvh_opencl_tcase(void);

#endif
