/* The same image, bit for bit, on the CPU and on the device. */
#include "test_opencl.h"

#include "backend_ocl.h"

#include <string.h>

static void films_equal(const char *what, const Film *a, const Film *b)
{
    size_t pixels = film_pixels(a);
    ck_assert_int_eq(a->quantum_exponent, b->quantum_exponent);
    for (size_t i = 0; i < 3 * pixels; ++i)
        if (a->sums[i] != b->sums[i])
            ck_abort_msg("%s: sum %zu differs: %lld on the CPU, %lld on the device", what, i, (long long)a->sums[i],
                         (long long)b->sums[i]);
    for (size_t i = 0; i < pixels; ++i)
        if (a->counts[i] != b->counts[i])
            ck_abort_msg("%s: pixel %zu has %u samples on the CPU, %u on the device", what, i, a->counts[i],
                         b->counts[i]);
}

/* Renders on both; film, rays and diagnostics are to be the same. */
static void backends_agree(const char *what, RenderSetup setup)
{
    RenderedImage cpu, device;
    setup.backend = NULL;
    fixture_render(&setup, &cpu);
    setup.backend = backend_ocl();
    fixture_render(&setup, &device);
    ck_assert_msg(fixture_mean(&cpu) > 0.0, "%s: the picture is black", what);
    films_equal(what, &cpu.film, &device.film);
    ck_assert_uint_eq(cpu.result.backend.closest_rays, device.result.backend.closest_rays);
    ck_assert_uint_eq(cpu.result.backend.shadow_rays, device.result.backend.shadow_rays);
    ck_assert_uint_eq(cpu.result.samples, device.result.samples);
    for (int i = 0; i < cpu.result.diagnostic_count; ++i)
        ck_assert_uint_eq(cpu.result.diagnostics[i], device.result.diagnostics[i]);
    fixture_destroy(&cpu);
    fixture_destroy(&device);
}

/* ---- scenes ------------------------------------------------------------------------------------------------------ */

static bool device_promises(void)
{
    OclDevice device;
    test_device(&device);
    return device.info.same_bits;
}

/* Every material and kind of light that the scenes of the tree leave out, lens and other cameras. */
#define SPHERE_AT(x, y) "AttributeBegin Translate " #x " " #y " 0 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"
static const char
    MATERIALS[] =
        "LookAt 0 1 -5  0 0 0  0 1 0\n"
        "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\n"
        "PixelFilter \"mitchell\"\n"
        "Camera \"perspective\" \"float fov\" 45 \"float lensradius\" 0.05 \"float focaldistance\" "
        "5\nWorldBegin\n"
        "LightSource \"infinite\" \"rgb L\" [ 0.3 0.4 0.5 ]\n"
        "LightSource \"distant\" \"rgb L\" [ 1 0.9 0.8 ] \"point3 from\" [ 1 2 -1 ] \"point3 to\" [ 0 0 0 ]\n"
        "LightSource \"spot\" \"rgb I\" [ 9 9 9 ] \"point3 from\" [ 0 3 -2 ] \"point3 to\" [ 0 0 0 ]\n"
        "Texture \"squares\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 0.1 0.2 0.3 ] \"rgb tex2\" [ 0.8 "
        "0.7 0.6 ]\n"
        "Texture \"bumps\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 0.02\n"
        "Material \"diffuse\" \"texture reflectance\" \"squares\" \"texture displacement\" "
        "\"bumps\"\n" SPHERE_AT(-1.5, 0.5) "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.8 0.7 ] "
                                           "\"float uroughness\" 0.3 \"float vroughness\" 0.1\n" SPHERE_AT(-0.5, 0.5) "Material \"dielectric\" \"float eta\" 1.5\n" SPHERE_AT(
                                               0.5,
                                               0.5) "Material \"dielectric\" \"float eta\" 1.4 \"float "
                                                    "roughness\" 0.2\n" SPHERE_AT(
                                                        1.5,
                                                        0.5) "Material "
                                                             "\"thindielectric\""
                                                             "\n" SPHERE_AT(
                                                                 -1.5,
                                                                 -0.5) "Mater"
                                                                       "ial "
                                                                       "\"coa"
                                                                       "teddi"
                                                                       "ffuse"
                                                                       "\" "
                                                                       "\"rgb"
                                                                       " refl"
                                                                       "ectan"
                                                                       "ce\" "
                                                                       "[ "
                                                                       "0.2 "
                                                                       "0.5 "
                                                                       "0.3 "
                                                                       "] "
                                                                       "\"flo"
                                                                       "at "
                                                                       "rough"
                                                                       "ness"
                                                                       "\" "
                                                                       "0."
                                                                       "1"
                                                                       "\n" SPHERE_AT(
                                                                           -0.5,
                                                                           -0.5) "Material "
                                                                                 "\"diffusetransmissi"
                                                                                 "on\" \"rgb "
                                                                                 "reflectance\" [ "
                                                                                 "0.3 0.3 0.3 ] "
                                                                                 "\"rgb "
                                                                                 "transmittance\" [ "
                                                                                 "0.4 0.3 0.2 "
                                                                                 "]\n" SPHERE_AT(
                                                                                     0.5,
                                                                                     -0.5) "MakeNamedMaterial \"a\" "
                                                                                           "\"string type\" "
                                                                                           "\"diffuse\" \"rgb "
                                                                                           "reflectance\" [ 0.9 0.1 "
                                                                                           "0.1 ]\n"
                                                                                           "MakeNamedMaterial \"b\" "
                                                                                           "\"string type\" "
                                                                                           "\"conductor\" \"rgb "
                                                                                           "reflectance\" [ 1 1 1 ] "
                                                                                           "\"float roughness\" 0\n"
                                                                                           "Material \"mix\" \"string "
                                                                                           "materials\" [ \"a\" \"b\" "
                                                                                           "] \"float amount\" "
                                                                                           "0.3\n" SPHERE_AT(
                                                                                               1.5,
                                                                                               -0.5) "Texture "
                                                                                                     "\"holes\" "
                                                                                                     "\"float\" "
                                                                                                     "\"checkerboard\" "
                                                                                                     "\"float tex1\" 1 "
                                                                                                     "\"float tex2\" "
                                                                                                     "0.4\n"
                                                                                                     "Material "
                                                                                                     "\"diffuse\"\n"
                                                                                                     "Shape "
                                                                                                     "\"bilinearmesh\" "
                                                                                                     "\"point3 P\" [ "
                                                                                                     "-3 -1 -3  3 -1 "
                                                                                                     "-3  -3 -1 3  3 "
                                                                                                     "-1 3 ] \"texture "
                                                                                                     "alpha\" "
                                                                                                     "\"holes\"\n"
                                                                                                     "AreaLightSource "
                                                                                                     "\"diffuse\" "
                                                                                                     "\"rgb L\" [ 4 4 "
                                                                                                     "4 ] \"bool "
                                                                                                     "twosided\" true\n"
                                                                                                     "Shape "
                                                                                                     "\"trianglemesh\" "
                                                                                                     "\"point3 P\" [ "
                                                                                                     "-1 2 0  1 2 0  0 "
                                                                                                     "2 1 ]\n"
                                                                                                     "Shape \"disk\" "
                                                                                                     "\"float radius\" "
                                                                                                     "0.2 \"float "
                                                                                                     "height\" -1\n";

START_TEST(test_bits_of_shapes)
{
    if (device_promises())
        backends_agree("shapes", (RenderSetup){.text = OPENCL_TEST_SCENE, .samples = 5, .max_depth = 30, .seed = 3});
}
END_TEST

START_TEST(test_bits_of_materials)
{
    if (device_promises())
        backends_agree("materials",
                       (RenderSetup){.text = MATERIALS, .samples = 8, .max_depth = 12, .seed = 1ull << 40});
}
END_TEST

/* The scenes of the tree are compared in test_cli.sh. */
static const char *const PUBLIC_SCENES[] = {"cornell-box/gray.pbrt", "veach-mis/gray.pbrt", "veach-bidir/gray.pbrt",
                                            "coffee/gray.pbrt"};

START_TEST(test_bits_of_public_scenes)
{
    char path[1200];
    if (getenv("SCENES") && device_promises() && test_public_scene(PUBLIC_SCENES[_i], path, sizeof path))
        backends_agree(path, (RenderSetup){.path = path, .width = 40, .height = 24, .samples = 4, .seed = 7});
}
END_TEST

/* ---- any batch, any number of threads, with overlap and without -------------------------------------------------- */

START_TEST(test_bits_for_any_batch)
{
    static const uint BATCHES[] = {33, 63, 100, 1000, 0};
    RenderSetup setup = {.text = OPENCL_TEST_SCENE, .samples = 2, .max_depth = 5, .backend = backend_ocl()};
    RenderedImage reference, image;
    fixture_render(&setup, &reference);
    for (int i = 0; i < 5; ++i) {
        setup.batch = BATCHES[i];
        setup.threads = 1 + 2 * i;
        if (i == 3)
            setenv("TWINLIGHT_OVERLAP", "0", 1);
        fixture_render(&setup, &image);
        films_equal("another batch", &reference.film, &image.film);
        ck_assert_uint_eq(reference.result.backend.closest_rays, image.result.backend.closest_rays);
        fixture_destroy(&image);
    }
    fixture_destroy(&reference);
}
END_TEST

TCase *opencl_bits_tests(void)
{
    TCase *bits = tcase_create("bits");
    tcase_set_timeout(bits, 120); /* the first time, kernels are built */
    tcase_add_test(bits, test_bits_of_shapes);
    tcase_add_test(bits, test_bits_of_materials);
    tcase_add_loop_test(bits, test_bits_of_public_scenes, 0, 4);
    tcase_add_test(bits, test_bits_for_any_batch);
    return bits;
}
