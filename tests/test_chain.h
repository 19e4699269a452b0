/* The parts of test_chain. */
#ifndef TWINLIGHT_TESTS_TEST_CHAIN_H
#define TWINLIGHT_TESTS_TEST_CHAIN_H

#include "test_util.h"

/* What chains and pools show of one path. */
TCase *chain_shown_tests(void);

#endif
