/* MakeNamedMedium and MediumInterface. */
#include "test_import.h"

#include "geometry/medium.h"

#define MEDIUM(parameters) "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" " parameters "\n"

static Medium medium_of(const char *parameters)
{
    char text[512];
    Scene scene;
    snprintf(text, sizeof text, MEDIUM("%s") "WorldBegin", parameters);
    import_text(text, &scene);
    ck_assert_uint_eq(scene.media.count, 2);
    Medium medium = ELEMENT(&scene, media, Medium, 1);
    scene_destroy(&scene);
    return medium;
}

START_TEST(coefficients)
{
    Medium m = medium_of("\"rgb sigma_a\" [ 1 2 3 ] \"rgb sigma_s\" [ 4 5 6 ] \"float scale\" 2 \"float g\" -0.25");
    assert_vec3(m.extinction, 10.0f, 14.0f, 18.0f, 1e-5f);
    assert_vec3(m.scattering, 8.0f, 10.0f, 12.0f, 1e-5f);
    assert_vec3(m.emission, 0.0f, 0.0f, 0.0f, 0.0f);
    ASSERT_FLOAT(m.g, -0.25f);
    m = medium_of("\"float sigma_a\" 0.5 \"float sigma_s\" 0 \"rgb Le\" [ 1 2 3 ] \"float Lescale\" 4");
    assert_vec3(m.extinction, 0.5f, 0.5f, 0.5f, 1e-6f);
    assert_vec3(m.emission, 2.0f, 4.0f, 6.0f, 1e-5f);
    m = medium_of("\"spectrum sigma_a\" [ 300 2 900 2 ] \"float sigma_s\" 1");
    assert_vec3(m.extinction, 3.0f, 3.0f, 3.0f, 1e-4f);
}
END_TEST

/* The default is whole milk; a preset takes precedence over coefficients. */
START_TEST(presets)
{
    Medium m = medium_of("");
    assert_vec3(m.scattering, 2.55f, 3.21f, 3.77f, 1e-6f);
    assert_vec3(vec3_sub(m.extinction, m.scattering), 0.0011f, 0.0024f, 0.014f, 1e-6f);
    m = medium_of("\"string preset\" \"Ketchup\" \"float sigma_a\" 9 \"float scale\" 10");
    assert_vec3(m.scattering, 1.8f, 0.7f, 0.3f, 1e-5f);
    assert_vec3(m.extinction, 2.41f, 10.4f, 14.8f, 1e-5f);
    m = medium_of("\"rgb sigma_s\" [ 0 0 0 ]");
    assert_vec3(m.extinction, 0.0011f, 0.0024f, 0.014f, 1e-6f);
}
END_TEST

/* Media of camera, lights and shapes; one name is for both sides, and media may be defined after they are mentioned. */
START_TEST(interfaces)
{
    Scene scene;
    import_text("MediumInterface \"a\" \"b\" Camera \"perspective\" MediumInterface \"b\" WorldBegin\n"
                "LightSource \"point\" Shape \"sphere\"\n"
                "AttributeBegin MediumInterface \"\" \"a\" Material \"interface\" Shape \"sphere\"\n"
                "MediumInterface \"a\" Shape \"sphere\" AttributeEnd\n"
                "MakeNamedMedium \"a\" \"string type\" \"homogeneous\"\n"
                "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" \"float g\" 0.5",
                &scene);
    ck_assert_uint_eq(scene.camera_settings.medium, 2);
    ck_assert_uint_eq(light_medium(&ELEMENT(&scene, lights, Light, 0)), 2);
    ck_assert_uint_eq(scene.shapes.count, 2); /* an interface between equal media is left out */
    const Shape *plain = &ELEMENT(&scene, shapes, Shape, 0), *interface = &ELEMENT(&scene, shapes, Shape, 1);
    ck_assert_uint_eq(media_inside(plain->flags), 2);
    ck_assert_uint_eq(media_outside(plain->flags), 2);
    ck_assert_uint_eq(plain->flags & SHAPE_INTERFACE, 0);
    ck_assert_uint_eq(media_inside(interface->flags), 0);
    ck_assert_uint_eq(media_outside(interface->flags), 1);
    ck_assert_uint_ne(interface->flags & SHAPE_INTERFACE, 0);
    ck_assert_uint_eq(interface->material, NONE);
    ASSERT_FLOAT(ELEMENT(&scene, media, Medium, 2).g, 0.5f);
    scene_destroy(&scene);
}
END_TEST

/* Features follow from the media that are used. */
START_TEST(features)
{
    static const struct {
        const char *text;
        ulong features;
    } cases[] = {
        {MEDIUM("") "WorldBegin LightSource \"point\" Shape \"sphere\"", 0u},
        {MEDIUM("\"float sigma_s\" 0") "WorldBegin LightSource \"point\" MediumInterface \"m\" \"\" Shape \"sphere\"",
         FEATURE_MEDIUM},
        {MEDIUM("") "MediumInterface \"\" \"m\" Camera \"perspective\" WorldBegin LightSource \"point\"",
         FEATURE_MEDIUM | FEATURE_SCATTERING},
        {MEDIUM("\"float sigma_s\" 0 \"rgb Le\" [ 1 1 1 ]") "WorldBegin MediumInterface \"\" \"m\" "
                                                            "LightSource \"point\"",
         FEATURE_MEDIUM | FEATURE_MEDIUM_EMISSION}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Scene scene;
        Error error = {0};
        import_text(cases[i].text, &scene);
        ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
        ck_assert_uint_eq(scene.features & (FEATURE_MEDIUM | FEATURE_SCATTERING | FEATURE_MEDIUM_EMISSION),
                          cases[i].features);
        scene_destroy(&scene);
    }
}
END_TEST

/* Light from infinity reaches the scene only through empty space: the camera's medium may end at a closed surface. */
START_TEST(medium_around)
{
    static const char *const BEGIN = MEDIUM("\"float sigma_s\" 0") "MediumInterface \"m\" Camera \"perspective\" "
                                                                   "WorldBegin LightSource \"point\" "
                                                                   "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";
    static const char *const INSIDE[] = {"", "MediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\"",
                                         ("MediumInterface \"m\" \"\" ObjectBegin \"o\" Material \"interface\" "
                                          "Shape \"sphere\" ObjectEnd ObjectInstance \"o\"")};
    for (int i = 0; i < 3; ++i) {
        char text[1024];
        Scene scene;
        Error error = {0};
        snprintf(text, sizeof text, "%s%s", BEGIN, INSIDE[i]);
        import_text(text, &scene);
        ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
        const Light *light = &ELEMENT(&scene, lights, Light, 1);
        ck_assert_uint_eq(light_medium(light), i == 0 ? 1 : 0);
        ASSERT_FLOAT(light->emission.x, i == 0 ? 0.0f : 1.0f);
        scene_destroy(&scene);
    }
}
END_TEST

TCase *import_media_case(void)
{
    TCase *tcase = tcase_create("media");
    tcase_add_test(tcase, coefficients);
    tcase_add_test(tcase, presets);
    tcase_add_test(tcase, interfaces);
    tcase_add_test(tcase, features);
    tcase_add_test(tcase, medium_around);
    return tcase;
}
