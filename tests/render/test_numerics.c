/* Hard cases of arithmetic, each as a picture: docs/NUMERICS.md lists them with the figures that are printed here, and
 * the tests of single functions that belong to them. */
#include "support/numerics.h"

int main(void)
{
    Suite *suite = suite_create("numerics");
    suite_add_tcase(suite, numerics_scale_case());
    suite_add_tcase(suite, numerics_lights_case());
    suite_add_tcase(suite, numerics_film_case());
    return test_run(suite);
}
