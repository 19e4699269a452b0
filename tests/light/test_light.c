/* Lights, camera, pixel filter and MIS weights. */
#include "light/test_light.h"

#include "support/test_util.h"

int main(void)
{
    Suite *suite = suite_create("light");
    suite_add_tcase(suite, light_area_case());
    suite_add_tcase(suite, light_irradiance_case());
    suite_add_tcase(suite, light_environment_case());
    suite_add_tcase(suite, light_portal_case());
    suite_add_tcase(suite, light_select_case());
    suite_add_tcase(suite, light_tree_case());
    suite_add_tcase(suite, light_bounds_case());
    suite_add_tcase(suite, camera_case());
    suite_add_tcase(suite, pixel_filter_case());
    suite_add_tcase(suite, mis_case());
    return test_run(suite);
}
