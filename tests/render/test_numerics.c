/* Hard cases of arithmetic, each as a rendering: docs/NUMERICS.md lists them with the figures printed here, and with
 * related unit tests. */
#include "support/numerics.h"

int main(void)
{
    Suite *suite = suite_create("numerics");
    suite_add_tcase(suite, numerics_scale_case());
    suite_add_tcase(suite, numerics_lights_case());
    suite_add_tcase(suite, numerics_film_case());
    return test_run(suite);
}
