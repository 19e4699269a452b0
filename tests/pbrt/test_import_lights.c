/* Lights: pbrt's scales. An rgb value of 1 1 1 emits 1 1 1; any other spectrum is normalised to luminance 1. */
#include "pbrt/test_import.h"
#include "support/test_files.h"

#include "image/color.h"
#include "layout/scene_view.h"

#include <string.h>

#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 2 0 0 0 1 0 ] "

static LightData light_of(const char *text, Scene *scene)
{
    char whole[512];
    snprintf(whole, sizeof whole, "WorldBegin\n%s", text);
    import_text_in(whole, test_folder, false, scene);
    ck_assert_uint_ge(scene->lights.count, 1);
    const Light *light = &ELEMENT(scene, lights, Light, 0);
    LightData data = {.kind = light_kind(light), .flags = light->flags & ~LIGHT_KIND_MASK, .emission = light->emission};
    if (data.kind != LIGHT_AREA)
        data.detail = *scene_light_detail(scene, light);
    return data;
}

/* The emission of the first light of `text`. */
static void emission_is(const char *text, float r, float g, float b)
{
    Scene scene;
    LightData light = light_of(text, &scene);
    float tolerance = 1e-5f * (1.0f + fabsf(r) + fabsf(g) + fabsf(b));
    assert_vec3(light.emission, r, g, b, tolerance);
    scene_destroy(&scene);
}

START_TEST(rgb_is_taken_as_it_is)
{
    emission_is("LightSource \"point\" \"rgb I\" [ 1 2 3 ]", 1, 2, 3);
    emission_is("LightSource \"point\"", 1, 1, 1);
    emission_is("LightSource \"point\" \"rgb I\" [ 1 2 3 ] \"float scale\" 10", 10, 20, 30);
    emission_is("LightSource \"infinite\"", 1, 1, 1);
    emission_is("LightSource \"infinite\" \"rgb L\" [ 0.5 0.6 0.7 ] \"float scale\" 2", 1, 1.2f, 1.4f);
    emission_is("LightSource \"distant\" \"rgb L\" [ 3 3 3 ]", 3, 3, 3);
    emission_is("AreaLightSource \"diffuse\" \"rgb L\" [ 4 5 6 ] \"float scale\" 0.5 " TRIANGLE, 2, 2.5f, 3);
    emission_is("AreaLightSource \"diffuse\" " TRIANGLE, 1, 1, 1);
}
END_TEST

START_TEST(other_spectra_have_luminance_one)
{
    static const char *const SPECTRA[] = {"\"blackbody I\" 3000", "\"blackbody I\" 9000",
                                          "\"spectrum I\" [ 400 7 700 7 ]", "\"spectrum I\" \"stdillum-A\""};
    for (size_t i = 0; i < sizeof SPECTRA / sizeof *SPECTRA; ++i) {
        char text[256];
        Scene scene;
        snprintf(text, sizeof text, "LightSource \"point\" \"float scale\" 3 %s", SPECTRA[i]);
        LightData light = light_of(text, &scene);
        ASSERT_NEAR(rgb_luminance(light.emission), 3.0f, 3e-3f);
        scene_destroy(&scene);
    }
    float rgb[3];
    color_blackbody(3000.0f, rgb);
    emission_is("LightSource \"point\" \"blackbody I\" 3000", rgb[0], rgb[1], rgb[2]);
}
END_TEST

START_TEST(power_and_illuminance)
{
    float four_pi = 4.0f * PI;
    emission_is("LightSource \"point\" \"float power\" 100", 100 / four_pi, 100 / four_pi, 100 / four_pi);
    emission_is("LightSource \"point\" \"float power\" 100 \"rgb I\" [ 2 0 0 ] \"float scale\" 3", 600 / four_pi, 0, 0);
    emission_is("LightSource \"distant\" \"float illuminance\" 5 \"float scale\" 2", 10, 10, 10);
    emission_is("LightSource \"infinite\" \"float illuminance\" 5", 5 / PI, 5 / PI, 5 / PI);
    /* A cone of 90 degrees without falloff is a hemisphere. */
    emission_is("LightSource \"spot\" \"float power\" 10 \"float coneangle\" 90 \"float conedeltaangle\" 0",
                10 / (2 * PI), 10 / (2 * PI), 10 / (2 * PI));
    /* The triangle's area is 1: radiance = power / pi; if two-sided, each side has half of it. */
    emission_is("AreaLightSource \"diffuse\" \"float power\" 10 " TRIANGLE, 10 / PI, 10 / PI, 10 / PI);
    emission_is("AreaLightSource \"diffuse\" \"float power\" 10 \"bool twosided\" true " TRIANGLE, 5 / PI, 5 / PI,
                5 / PI);
    emission_is("Scale 3 3 3 AreaLightSource \"diffuse\" \"float power\" 10 " TRIANGLE, 10 / (9 * PI), 10 / (9 * PI),
                10 / (9 * PI));
    emission_is("AreaLightSource \"diffuse\" \"float power\" 10 Shape \"sphere\"", 10 / (4 * PI * PI),
                10 / (4 * PI * PI), 10 / (4 * PI * PI));
}
END_TEST

START_TEST(power_is_that_of_each_primitive)
{
    Scene scene;
    import_world("AreaLightSource \"diffuse\" \"float power\" 1\n"
                 "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 2 0 0 0 1 0 0 4 0 ] \"integer indices\" [ 0 1 2 0 1 3 ]",
                 &scene);
    ASSERT_NEAR(ELEMENT(&scene, lights, Light, 0).emission.x, 1 / PI, 1e-6f);
    ASSERT_NEAR(ELEMENT(&scene, lights, Light, 1).emission.x, 0.25f / PI, 1e-6f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(places_and_directions)
{
    Scene scene;
    LightData light = light_of("Translate 1 2 3 Scale 2 2 2 LightSource \"point\" \"point3 from\" [ 1 0 0 ]", &scene);
    ck_assert_uint_eq(light.kind, LIGHT_POINT);
    assert_vec3(light.detail.position, 3, 2, 3, 0.0f);
    scene_destroy(&scene);
    light = light_of("Rotate 90 1 0 0 LightSource \"distant\"", &scene);
    ck_assert_uint_eq(light.kind, LIGHT_DISTANT);
    /* From the origin toward +z by default; the rotation about x takes z to -y. */
    assert_vec3(light.detail.direction, 0, -1, 0, 1e-6f);
    scene_destroy(&scene);
    light = light_of("LightSource \"distant\" \"point3 from\" [ 1 1 0 ] \"point3 to\" [ 1 -3 0 ]", &scene);
    assert_vec3(light.detail.direction, 0, -1, 0, 1e-6f);
    scene_destroy(&scene);
    light = light_of("Translate 1 0 0 LightSource \"spot\" \"point3 from\" [ 0 5 0 ] \"point3 to\" [ 0 0 0 ]", &scene);
    ck_assert_uint_eq(light.kind, LIGHT_SPOT);
    assert_vec3(light.detail.position, 1, 5, 0, 0.0f);
    assert_vec3(light.detail.direction, 0, -1, 0, 1e-6f);
    ASSERT_NEAR(light.detail.cos_total, 0.8660254f, 1e-6f);
    ASSERT_NEAR(light.detail.cos_falloff, 0.9063078f, 1e-6f);
    scene_destroy(&scene);
}
END_TEST

/* What a projective transform does to points does not matter to lights without a place, unless it moves them. */
START_TEST(projective_transforms)
{
    static const char *const REFUSED[] = {"[ 1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1 ] LightSource \"point\"",
                                          "[ 1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1 ] LightSource \"goniometric\"",
                                          "[ 1 0 0 0 0 1 0 0 0 0 1 0.5 3 0 0 1 ] LightSource \"distant\"",
                                          "[ 1 0 0 0 0 1 0 0.5 0 0 1 0 0 0 0 1 ] Texture \"t\" \"float\" \"wrinkled\"",
                                          "[ 1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1 ] Shape \"sphere\""};
    Scene scene;
    import_world("ConcatTransform [ 0 1 0 0 -1 0 0 0.5 0 0 1 8.87 0 0 0 1 ] Rotate 90 0 0 1\n"
                 "LightSource \"distant\" \"point3 to\" [ 1 0 0 ]",
                 &scene);
    assert_vec3(ELEMENT(&scene, light_details, LightDetail, 0).direction, -1.0f, 0.0f, 0.0f, 1e-6f);
    scene_destroy(&scene);
    for (size_t i = 0; i < sizeof REFUSED / sizeof *REFUSED; ++i) {
        char text[256];
        snprintf(text, sizeof text, "WorldBegin Transform %s", REFUSED[i]);
        ck_assert_msg(strstr(import_error(text), "a projective transform is not supported"), "%s", REFUSED[i]);
    }
}
END_TEST

START_TEST(area_lights)
{
    Scene scene;
    import_world("AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true " TRIANGLE
                 "Shape \"sphere\" AttributeEnd\n" TRIANGLE "AreaLightSource \"diffuse\" \"rgb L\" [ 0 0 0 ] " TRIANGLE,
                 &scene);
    ck_assert_uint_eq(scene.lights.count, 2);
    const Light *light = &ELEMENT(&scene, lights, Light, 0);
    ck_assert_uint_eq(light->flags, LIGHT_AREA | LIGHT_TWO_SIDED);
    ck_assert_uint_eq(light->primitive, 0);
    ASSERT_NEAR(light->area, 1.0f, 1e-6f);
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 1).first_light, 1);
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 2).first_light, NONE);
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 3).first_light, NONE);
    scene_destroy(&scene);
}
END_TEST

static bool invisible(const char *shape)
{
    char text[384];
    Scene scene;
    snprintf(text, sizeof text,
             "Texture \"none\" \"float\" \"constant\" \"float value\" 0\n"
             "Texture \"holes\" \"float\" \"checkerboard\" AreaLightSource \"diffuse\" \"bool twosided\" true %s",
             shape);
    LightData light = light_of(text, &scene);
    ck_assert_uint_eq(light.flags & ~(uint)LIGHT_INVISIBLE, LIGHT_TWO_SIDED);
    scene_destroy(&scene);
    return (light.flags & LIGHT_INVISIBLE) != 0;
}

START_TEST(lights_of_alpha_0_are_invisible)
{
    ck_assert(invisible(TRIANGLE "\"float alpha\" 0"));
    ck_assert(invisible(TRIANGLE "\"texture alpha\" \"none\""));
    ck_assert(invisible("ObjectBegin \"o\" " TRIANGLE "\"float alpha\" 0 ObjectEnd ObjectInstance \"o\""));
    ck_assert(!invisible(TRIANGLE));
    ck_assert(!invisible(TRIANGLE "\"float alpha\" 0.1"));
    ck_assert(!invisible(TRIANGLE "\"texture alpha\" \"holes\""));
}
END_TEST

START_TEST(light_attributes)
{
    Scene scene;
    LightData light =
        light_of("Attribute \"light\" \"float scale\" 5 \"rgb L\" [ 2 2 2 ] LightSource \"infinite\"", &scene);
    assert_vec3(light.emission, 10, 10, 10, 1e-5f);
    scene_destroy(&scene);
}
END_TEST

/* map.pfm: width x height pixels of 1/2. */
static void map_write(int width, int height)
{
    FILE *file = fopen(test_path("map.pfm"), "wb");
    ck_assert_ptr_nonnull(file);
    fprintf(file, "PF\n%d %d\n-1.0\n", width, height);
    for (int i = 0; i < 3 * width * height; ++i) {
        float half = 0.5f;
        fwrite(&half, sizeof half, 1, file);
    }
    fclose(file);
}

START_TEST(environment_maps)
{
    static const char MAP[] = "WorldBegin LightSource \"infinite\" \"string filename\" \"map.pfm\"";
    ImportOptions options = {.lenient = false};
    Error error;
    Scene scene;
    map_write(64, 64);
    LightData light =
        light_of("Rotate 90 0 0 1 LightSource \"infinite\" \"string filename\" \"map.pfm\" \"float scale\" 3", &scene);
    ck_assert_uint_eq(light.kind, LIGHT_INFINITE_IMAGE);
    ck_assert_uint_eq(light.flags, 0);
    assert_vec3(light.emission, 3, 3, 3, 0.0f);
    ck_assert_uint_eq(ELEMENT(&scene, images, TextureImage, light.detail.image).wrap, WRAP_OCTAHEDRAL);
    assert_vec3(affine_vector(light.detail.world_from_light, vec3(1, 0, 0)), 0, 1, 0, 1e-6f);
    scene_destroy(&scene);
    /* A constant map of radiance 1/2 lights a plane with pi / 2; pbrt measures half of that, so its scale is twice a
     * constant light's. */
    light = light_of("LightSource \"infinite\" \"string filename\" \"map.pfm\" \"float illuminance\" 5", &scene);
    ASSERT_NEAR(light.emission.x * 0.5f, 2.0f * 5.0f / PI, 0.01f);
    scene_destroy(&scene);
    map_write(4, 2);
    scene_init(&scene);
    ck_assert(!pbrt_import_text(MAP, strlen(MAP), "test.pbrt", test_folder, &options, &scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "an infinite light's image that is not square (4 x 2)"));
    scene_destroy(&scene);
    import_text_in(MAP, test_folder, true, &scene);
    ck_assert_uint_eq(ELEMENT(&scene, lights, Light, 0).flags, LIGHT_INFINITE_IMAGE | LIGHT_EQUIRECTANGULAR);
    scene_destroy(&scene);
}
END_TEST

/* "mapping" says that a map is one of latitude and longitude, whatever its size, and measures it as one: of radiance
 * 1/2, it lights a plane as a map in the other mapping does. */
START_TEST(latitude_longitude_maps)
{
    Scene scene;
    map_write(64, 32);
    LightData light =
        light_of("LightSource \"infinite\" \"string filename\" \"map.pfm\" \"string mapping\" \"latlong\" "
                 "\"float illuminance\" 5",
                 &scene);
    ck_assert_uint_eq(light.kind, LIGHT_INFINITE_IMAGE);
    ck_assert_uint_eq(light.flags, LIGHT_EQUIRECTANGULAR);
    ck_assert_uint_eq(ELEMENT(&scene, images, TextureImage, light.detail.image).wrap, WRAP_REPEAT);
    ASSERT_NEAR(light.emission.x * 0.5f, 2.0f * 5.0f / PI, 0.01f);
    scene_destroy(&scene);
    map_write(8, 8);
    light = light_of("LightSource \"infinite\" \"string filename\" \"map.pfm\" \"string mapping\" \"latlong\"", &scene);
    ck_assert_uint_eq(light.flags, LIGHT_EQUIRECTANGULAR);
    scene_destroy(&scene);
    light =
        light_of("LightSource \"infinite\" \"string filename\" \"map.pfm\" \"string mapping\" \"equalarea\"", &scene);
    ck_assert_uint_eq(light.flags, 0);
    scene_destroy(&scene);
}
END_TEST

/* The points of a portal are in world space, whatever the current transform; the directions of the map are not. A world
 * far from the origin is moved there, and its portals with it. */
START_TEST(portals)
{
    static const char PORTAL[] = "\"point3 portal\" [ 2 -1 0.5  2 -1 2.5  2 2 2.5  2 2 0.5 ]";
    char text[400];
    Scene scene;
    map_write(8, 8);
    snprintf(text, sizeof text,
             "Rotate 90 0 0 1 Translate 5 6 7 LightSource \"infinite\" \"string filename\" \"map.pfm\" %s", PORTAL);
    LightData light = light_of(text, &scene);
    ck_assert_uint_eq(light.kind, LIGHT_PORTAL);
    ck_assert_uint_lt(light.detail.image, 1);
    assert_vec3(affine_vector(light.detail.world_from_light, vec3(1, 0, 0)), 0, 1, 0, 1e-6f);
    Portal portal = ELEMENT(&scene, portals, Portal, light.detail.portal);
    assert_vec3(portal.corner, 2, -1, 0.5f, 0.0f);
    assert_vec3(portal.axes.n, 1, 0, 0, 1e-6f);
    scene_destroy(&scene);
    snprintf(text, sizeof text, "LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] %s", PORTAL);
    light = light_of(text, &scene);
    ck_assert_uint_eq(light.kind, LIGHT_PORTAL);
    ck_assert_uint_eq(light.detail.image, NONE);
    assert_vec3(light.emission, 1, 2, 3, 0.0f);
    scene_destroy(&scene);
    light = light_of("LightSource \"infinite\" \"point3 portal\" [ 9002 0 0  9002 0 1  9002 1 1  9002 1 0 ] "
                     "Translate 9000 0 0 Shape \"sphere\"",
                     &scene);
    assert_vec3(vec3_add(ELEMENT(&scene, portals, Portal, light.detail.portal).corner, scene.origin), 9002, 0, 0, 0.0f);
    scene_destroy(&scene);
}
END_TEST

static void emission_not_negative(const char *text)
{
    Scene scene;
    Vec3 emission = light_of(text, &scene).emission;
    ck_assert_msg(emission.x >= 0.0f && emission.y >= 0.0f && emission.z >= 0.0f, "%s: %g %g %g", text,
                  (double)emission.x, (double)emission.y, (double)emission.z);
    scene_destroy(&scene);
}

/* Chains follow luminance (chain/mutation.h), so no light may have a negative channel: spectra whose colour is outside
 * sRGB's gamut are clamped at 0, and negative numbers are rejected (tests/bad has those of a point light). */
START_TEST(no_light_is_negative)
{
    static const char *const REFUSED[] = {
        "LightSource \"spot\" \"rgb I\" [ 1 1 -1 ]",
        "LightSource \"distant\" \"rgb L\" [ -1 1 1 ]",
        "LightSource \"infinite\" \"rgb L\" [ 1 -1 1 ]",
        "LightSource \"infinite\" \"float scale\" -1",
        "LightSource \"point\" \"spectrum I\" [ 400 1 500 -1 600 1 ]",
        "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 -1 ] " TRIANGLE,
        "AreaLightSource \"diffuse\" \"float scale\" -1 " TRIANGLE,
        "Attribute \"light\" \"rgb L\" [ 1 1 -1 ] LightSource \"infinite\"",
    };
    char text[256];
    for (size_t i = 0; i < sizeof REFUSED / sizeof *REFUSED; ++i) {
        snprintf(text, sizeof text, "WorldBegin\n%s", REFUSED[i]);
        ck_assert_ptr_nonnull(strstr(import_error(text), "negative"));
    }
    for (int nanometre = 380; nanometre <= 720; nanometre += 10) {
        snprintf(text, sizeof text, "LightSource \"point\" \"spectrum I\" [ %d 0 %d 1 %d 0 ]", nanometre - 5, nanometre,
                 nanometre + 5);
        emission_not_negative(text);
    }
    emission_not_negative("LightSource \"infinite\" \"blackbody L\" 400");
    emission_not_negative("AreaLightSource \"diffuse\" \"blackbody L\" 1000 " TRIANGLE);
    emission_not_negative("LightSource \"point\" \"float power\" -1");
    emission_not_negative("LightSource \"distant\" \"float illuminance\" -1");
}
END_TEST

TCase *import_lights_case(void)
{
    TCase *tcase = tcase_create("lights");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, rgb_is_taken_as_it_is);
    tcase_add_test(tcase, other_spectra_have_luminance_one);
    tcase_add_test(tcase, power_and_illuminance);
    tcase_add_test(tcase, power_is_that_of_each_primitive);
    tcase_add_test(tcase, places_and_directions);
    tcase_add_test(tcase, projective_transforms);
    tcase_add_test(tcase, area_lights);
    tcase_add_test(tcase, lights_of_alpha_0_are_invisible);
    tcase_add_test(tcase, light_attributes);
    tcase_add_test(tcase, environment_maps);
    tcase_add_test(tcase, latitude_longitude_maps);
    tcase_add_test(tcase, portals);
    tcase_add_test(tcase, no_light_is_negative);
    return tcase;
}
