/* Elementary functions, generators, warps and tabulated distributions. */
#include "math/test_math.h"

int main(void)
{
    Suite *suite = suite_create("math");
    suite_add_tcase(suite, test_math_elementary());
    suite_add_tcase(suite, test_math_elementary_pairs());
    suite_add_tcase(suite, test_math_rng());
    suite_add_tcase(suite, test_math_sobol());
    suite_add_tcase(suite, test_math_warp());
    suite_add_tcase(suite, test_math_sphere_maps());
    suite_add_tcase(suite, test_math_alias());
    suite_add_tcase(suite, test_math_distribution2d());
    return test_run(suite);
}
