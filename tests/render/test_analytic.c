/* Images against numbers that do not come from the renderer; see support/analytic.h. */
#include "support/analytic.h"

int main(void)
{
    Suite *suite = suite_create("analytic");
    suite_add_tcase(suite, analytic_area_case());
    suite_add_tcase(suite, analytic_glass_case());
    suite_add_tcase(suite, analytic_opaque_case());
    suite_add_tcase(suite, analytic_intensity_case());
    suite_add_tcase(suite, analytic_lights_case());
    suite_add_tcase(suite, analytic_media_case());
    suite_add_tcase(suite, analytic_environment_case());
    suite_add_tcase(suite, analytic_camera_case());
    suite_add_tcase(suite, analytic_textures_case());
    suite_add_tcase(suite, analytic_bumps_case());
    suite_add_tcase(suite, analytic_instances_case());
    return test_run(suite);
}
