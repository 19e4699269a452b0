/* The parts of test_combination. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_H
#define TWINLIGHT_TESTS_MMLT_TEST_COMBINATION_H

#include "mmlt/combination_rates.h"
#include "mmlt/combined_image.h"
#include "support/test_util.h"

/* Combines a generation whose estimators have left these films, with light_samples samples of each (0, or NULL: none), by
 * the teacher's weights, and lets the learner learn from it. The chains' film becomes the combination. */
void films_combine(Combination *learner, Combination *teacher, Film *const films[ESTIMATOR_COUNT]);

/* What few samples tell; light above the clamping thresholds; combinations of given variances; bidirectional path
 * tracing. */
TCase *combination_few_tests(void);
TCase *combination_rare_tests(void);
TCase *combination_known_tests(void);
TCase *combination_bidirectional_tests(void);

#endif
