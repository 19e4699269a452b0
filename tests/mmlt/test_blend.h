/* The parts of test_blend. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_BLEND_H
#define TWINLIGHT_TESTS_MMLT_TEST_BLEND_H

#include "support/test_util.h"

/* Blends of given variances. */
TCase *blend_known_tests(void);

#endif
