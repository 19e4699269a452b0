/* The test cases that make up test_light. */
#ifndef TWINLIGHT_TESTS_LIGHT_TEST_LIGHT_H
#define TWINLIGHT_TESTS_LIGHT_TEST_LIGHT_H

#include <check.h>

TCase *light_area_case(void);
TCase *light_irradiance_case(void);
TCase *light_environment_case(void);
TCase *light_portal_case(void);
TCase *light_select_case(void);
TCase *light_tree_case(void);
TCase *light_bounds_case(void);
TCase *camera_case(void);
TCase *pixel_filter_case(void);
TCase *mis_case(void);

#endif
