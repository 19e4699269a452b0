/* What tests of caustics share. */
#ifndef TWINLIGHT_TESTS_PATH_TEST_CAUSTIC_H
#define TWINLIGHT_TESTS_PATH_TEST_CAUSTIC_H

#include <check.h>

#define SMOOTH_GLASS "Material \"dielectric\" \"float eta\" 1.5\n"
#define BALL_LAMP(radius, L)                                                                                           \
    "AttributeBegin Translate 1 2 -1 AreaLightSource \"diffuse\" \"rgb L\" [ " L " " L " " L                           \
    " ] Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] Shape \"sphere\" \"float radius\" " radius                  \
    " AttributeEnd\n"
#define LITTLE_BEAD "AttributeBegin Translate 0 -0.5 0 Shape \"sphere\" \"float radius\" 0.15 AttributeEnd\n"

TCase *photons_case(void);
TCase *search_case(void);

#endif
