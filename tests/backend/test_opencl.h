/* The parts of test_opencl, and what they share. */
#ifndef TWINLIGHT_TESTS_BACKEND_TEST_OPENCL_H
#define TWINLIGHT_TESTS_BACKEND_TEST_OPENCL_H

#include "support/render_fixture.h"
#include "support/test_util.h"

#include "devices.h"

TCase *opencl_devices_tests(void);
TCase *opencl_program_tests(void);
TCase *opencl_bits_tests(void);
TCase *opencl_bidirectional_tests(void);
TCase *opencl_inspect_tests(void);
TCase *opencl_pipeline_tests(void);

/* The device under test: $OPENCL_TEST_DEVICE, or the first. */
static inline void test_device(OclDevice *device)
{
    Error error = {0};
    if (!ocl_device_choose(getenv("OPENCL_TEST_DEVICE"), device, &error))
        ck_abort_msg("%s", error.message);
}

/* Whether its images must be bitwise the CPU's. */
static inline bool test_device_promises(void)
{
    OclDevice device;
    test_device(&device);
    if (!device.info.promises_division)
        ocl_device_probe(&device, false);
    return device.info.same_bits;
}

/* The scene of most tests, so that one program is built for all of them: every kind of shape, an area and a point
 * light, and enough depth for some batches to end early. */
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

/* All materials and kinds of light that OPENCL_TEST_SCENE lacks, textures, alpha, a lens. */
#define OPENCL_MATERIALS_SCENE                                                                                         \
    "LookAt 0 1 -5  0 0 0  0 1 0\n"                                                                                    \
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\n"                                             \
    "PixelFilter \"mitchell\"\n"                                                                                       \
    "Camera \"perspective\" \"float fov\" 45 \"float lensradius\" 0.05 \"float focaldistance\" 5\n"                    \
    "WorldBegin\n"                                                                                                     \
    "LightSource \"infinite\" \"rgb L\" [ 0.3 0.4 0.5 ]\n"                                                             \
    "LightSource \"distant\" \"rgb L\" [ 1 0.9 0.8 ] \"point3 from\" [ 1 2 -1 ] \"point3 to\" [ 0 0 0 ]\n"             \
    "LightSource \"spot\" \"rgb I\" [ 9 9 9 ] \"point3 from\" [ 0 3 -2 ] \"point3 to\" [ 0 0 0 ]\n"                    \
    "Texture \"squares\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 0.1 0.2 0.3 ] \"rgb tex2\" [ 0.8 "               \
    "0.7 0.6 ]\n"                                                                                                      \
    "Texture \"bumps\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 0.02\n"                              \
    "Material \"diffuse\" \"texture reflectance\" \"squares\" \"texture displacement\" \"bumps\"\n"                    \
    "AttributeBegin Translate -1.5 0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                        \
    "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.8 0.7 ] \"float uroughness\" 0.3 \"float "                     \
    "vroughness\" 0.1\n"                                                                                               \
    "AttributeBegin Translate -0.5 0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                        \
    "Material \"dielectric\" \"float eta\" 1.5\n"                                                                      \
    "AttributeBegin Translate 0.5 0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                         \
    "Material \"dielectric\" \"float eta\" 1.4 \"float roughness\" 0.2\n"                                              \
    "AttributeBegin Translate 1.5 0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                         \
    "Material \"thindielectric\"\n"                                                                                    \
    "AttributeBegin Translate -1.5 -0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                       \
    "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.2 0.5 0.3 ] \"float roughness\" 0.1\n"                         \
    "AttributeBegin Translate -0.5 -0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                       \
    "Material \"diffusetransmission\" \"rgb reflectance\" [ 0.3 0.3 0.3 ] \"rgb transmittance\" [ 0.4 "                \
    "0.3 0.2 ]\n"                                                                                                      \
    "AttributeBegin Translate 0.5 -0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                        \
    "Texture \"noise\" \"float\" \"fbm\" \"integer octaves\" 3\n"                                                      \
    "Texture \"windy\" \"float\" \"windy\"\n"                                                                          \
    "Texture \"dots\" \"spectrum\" \"dots\" \"float uscale\" 8 \"float vscale\" 8\n"                                   \
    "Texture \"stone\" \"spectrum\" \"marble\" \"float scale\" 5\n"                                                    \
    "Texture \"sides\" \"spectrum\" \"directionmix\" \"texture tex1\" \"stone\" \"texture tex2\" \"dots\"\n"           \
    "Texture \"ramp\" \"spectrum\" \"bilerp\" \"rgb v11\" [ 0.2 0.9 0.4 ]\n"                                           \
    "Texture \"all\" \"spectrum\" \"mix\" \"texture tex1\" \"sides\" \"texture tex2\" \"ramp\"\n"                      \
    "Material \"diffuse\" \"texture reflectance\" \"all\" \"texture displacement\" \"windy\"\n"                        \
    "AttributeBegin Translate -0.2 1.4 0 Shape \"cylinder\" \"float radius\" 0.3 \"float phimax\" 300 AttributeEnd\n"  \
    "Texture \"scratches\" \"float\" \"wrinkled\" \"integer octaves\" 2 \"float roughness\" 0.3\n"                     \
    "Material \"coatedconductor\" \"float interface.roughness\" 0.05 \"texture conductor.roughness\" \"scratches\"\n"  \
    "AttributeBegin Translate -1 1.4 0 Shape \"cylinder\" \"float radius\" 0.3 \"float zmax\" 0.4 AttributeEnd\n"      \
    "Material \"coatedconductor\" \"float thickness\" 0.1\n"                                                           \
    "AttributeBegin Translate 0.6 1.4 0 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n"                          \
    "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0.9 0.1 0.1 ]\n"                        \
    "MakeNamedMaterial \"b\" \"string type\" \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float "                     \
    "roughness\" 0\n"                                                                                                  \
    "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.3\n"                                     \
    "AttributeBegin Translate 1.5 -0.5 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"                        \
    "Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 1 \"float tex2\" 0.4\n"                               \
    "Material \"diffuse\"\n"                                                                                           \
    "Shape \"bilinearmesh\" \"point3 P\" [ -3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3 ] \"texture alpha\" \"holes\"\n"         \
    "AreaLightSource \"diffuse\" \"rgb L\" [ 4 4 4 ] \"bool twosided\" true\n"                                         \
    "Shape \"trianglemesh\" \"point3 P\" [ -1 2 0  1 2 0  0 2 1 ]\n"                                                   \
    "Shape \"disk\" \"float radius\" 0.2 \"float height\" -1\n"

#endif
