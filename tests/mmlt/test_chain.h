/* The parts of test_chain. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_CHAIN_H
#define TWINLIGHT_TESTS_MMLT_TEST_CHAIN_H

#include "support/test_util.h"

/* what chains and pools show of a single path */
TCase *chain_shown_tests(void);

#endif
