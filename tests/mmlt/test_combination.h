/* The parts of test_combination. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_H
#define TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_H

#include "support/test_util.h"

/* combinations of given variances */
TCase *combination_known_tests(void);

#endif
