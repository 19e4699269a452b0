/* The parts of test_blend. */
#ifndef TWINLIGHT_TESTS_TEST_BLEND_H
#define TWINLIGHT_TESTS_TEST_BLEND_H

#include "test_util.h"

/* What is made of variances that are known. */
TCase *blend_known_tests(void);

#endif
