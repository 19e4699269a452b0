/* What tests of caustics share. */
#ifndef TWINLIGHT_TESTS_PATH_TEST_CAUSTIC_H
#define TWINLIGHT_TESTS_PATH_TEST_CAUSTIC_H

#include <check.h>

TCase *photons_case(void);

#endif
