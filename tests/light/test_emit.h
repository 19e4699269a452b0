/* The test cases that make up test_emit. */
#ifndef TWINLIGHT_TESTS_LIGHT_TEST_EMIT_H
#define TWINLIGHT_TESTS_LIGHT_TEST_EMIT_H

#include <check.h>

TCase *emit_area_case(void);
TCase *emit_direction_case(void);
TCase *emit_power_case(void);
TCase *emit_distance_case(void);
TCase *emit_aims_case(void);
TCase *emit_openings_case(void);
TCase *emit_camera_case(void);
TCase *emit_spherical_case(void);
TCase *emit_splat_case(void);
TCase *emit_image_case(void);

#endif
