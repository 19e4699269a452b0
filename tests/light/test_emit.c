/* The building blocks of bidirectional paths at their ends: rays from lights, connections to the lens, splats. */
#include "light/test_emit.h"

#include "support/test_util.h"

int main(void)
{
    Suite *suite = suite_create("emit");
    suite_add_tcase(suite, emit_area_case());
    suite_add_tcase(suite, emit_direction_case());
    suite_add_tcase(suite, emit_power_case());
    suite_add_tcase(suite, emit_distance_case());
    suite_add_tcase(suite, emit_aims_case());
    suite_add_tcase(suite, emit_openings_case());
    suite_add_tcase(suite, emit_camera_case());
    suite_add_tcase(suite, emit_spherical_case());
    suite_add_tcase(suite, emit_splat_case());
    suite_add_tcase(suite, emit_image_case());
    return test_run(suite);
}
