/* The parts of test_opencl, and what they share. */
#ifndef TWINLIGHT_TEST_OPENCL_H
#define TWINLIGHT_TEST_OPENCL_H

#include "render_fixture.h"
#include "test_util.h"

#include "devices.h"

TCase *opencl_devices_tests(void);
TCase *opencl_program_tests(void);
TCase *opencl_bits_tests(void);
TCase *opencl_pipeline_tests(void);

/* The device of the tests: $OPENCL_TEST_DEVICE or the first. */
static inline void test_device(OclDevice *device)
{
    Error error = {0};
    if (!ocl_device_choose(getenv("OPENCL_TEST_DEVICE"), device, &error))
        ck_abort_msg("%s", error.message);
}

/* One scene for most tests, so that one program is built for all of them: every kind of shape, a lamp and a point
 * light, and depth enough for some batches to end early. */
#define OPENCL_TEST_SCENE                                                                                              \
    "LookAt 0 0 -4  0 0 0  0 1 0\n"                                                                                    \
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 20\n"                                             \
    "Camera \"perspective\" \"float fov\" 50\nWorldBegin\n"                                                            \
    "LightSource \"point\" \"rgb I\" [ 3 4 5 ] \"point3 from\" [ 0 1.8 -1 ]\n"                                         \
    "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.4 ]\n"                                                       \
    "Shape \"trianglemesh\" \"point3 P\" [ -2 -2 2  2 -2 2  2 2 2  -2 2 2 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n"     \
    "Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 -2  2 -2 -2  -2 -2 2  2 -1.8 2 ]\n"                                   \
    "Shape \"sphere\" \"float radius\" 0.7\n"                                                                          \
    "AreaLightSource \"diffuse\" \"rgb L\" [ 9 8 7 ]\n"                                                                \
    "Translate 0 1.9 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.5\n"

#endif
