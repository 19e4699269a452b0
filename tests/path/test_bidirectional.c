/* Bidirectional integrators: weights, individual strategies, their sum, the film, and numerically hard cases. */
#include "support/bidirectional.h"

int main(void)
{
    Suite *suite = suite_create("bidirectional");
    suite_add_tcase(suite, bidirectional_weights_case());
    suite_add_tcase(suite, bidirectional_walks_case());
    suite_add_tcase(suite, bidirectional_running_case());
    suite_add_tcase(suite, bidirectional_strategies_case());
    suite_add_tcase(suite, bidirectional_film_case());
    suite_add_tcase(suite, bidirectional_spread_case());
    suite_add_tcase(suite, bidirectional_hard_case());
    suite_add_tcase(suite, bidirectional_sums_case());
    return test_run(suite);
}
