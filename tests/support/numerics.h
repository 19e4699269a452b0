/* The parts of test_numerics: effects of floats, of rare paths and of bad numbers on images (docs/NUMERICS.md). */
#ifndef TWINLIGHT_TESTS_SUPPORT_NUMERICS_H
#define TWINLIGHT_TESTS_SUPPORT_NUMERICS_H

#include "support/bidirectional.h"

/* A lit red quad and a coincident blue one, the red first, once made of triangles and once of patches. */
#define COINCIDENT_SCENE                                                                                               \
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\nPixelFilter \"box\"\n"                        \
    "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nWorldBegin\n"                               \
    "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"                                                                   \
    "Material \"diffuse\" \"rgb reflectance\" [ 0.8 0 0 ]\n"                                                           \
    "Shape \"trianglemesh\" \"point3 P\" [ -3.1 -2.3 0.3  0 -2 -0.1  0.2 2.2 0.3  -3 2.1 0.7 ] "                       \
    "\"integer indices\" [ 0 1 2 0 2 3 ]\n"                                                                            \
    "Shape \"bilinearmesh\" \"point3 P\" [ 0 -2 -0.1  3 -2.3 0.4  0.2 2.2 0.3  3 2 0.9 ]\n"                            \
    "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0.8 ]\n"                                                           \
    "Shape \"trianglemesh\" \"point3 P\" [ -3.1 -2.3 0.3  0 -2 -0.1  0.2 2.2 0.3  -3 2.1 0.7 ] "                       \
    "\"integer indices\" [ 0 1 2 0 2 3 ]\n"                                                                            \
    "Shape \"bilinearmesh\" \"point3 P\" [ 0 -2 -0.1  3 -2.3 0.4  0.2 2.2 0.3  3 2 0.9 ]\n"

TCase *numerics_film_case(void);
TCase *numerics_lights_case(void);
TCase *numerics_scale_case(void);

#endif
