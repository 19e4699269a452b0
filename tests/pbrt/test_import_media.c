/* MakeNamedMedium and MediumInterface. */
#include "test_import.h"

#include "geometry/medium.h"
#include "math/noise.h"

#include <string.h>

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

/* The sample of a grid's cell, which is in the only brick. */
static float grid_sample(const Scene *scene, uint x, uint y, uint z, uint word)
{
    const MediumGrid *grid = &ELEMENT(scene, grids, MediumGrid, 0);
    uint first = ELEMENT(scene, texels, uint, grid->bricks), at = (z + 1) * 81 + (y + 1) * 9 + x + 1;
    return bits_float(ELEMENT(scene, texels, uint, first + at * grid->words + word));
}

/* A grid's samples are divided by the largest, which multiplies the coefficients; its box is p0, p1 of the medium's
 * space, before WorldBegin as well as after it. */
START_TEST(uniform_grid)
{
    static const char GRID[] =
        "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer nz\" 2\n"
        "\"float density\" [ 1 2 3 4 ] \"point3 p0\" [ 1 0 0 ] \"point3 p1\" [ 0 2 4 ]\n"
        "\"rgb sigma_a\" [ 1 2 3 ] \"float sigma_s\" 0.5 \"float scale\" 2 \"float g\" 0.25\n";
    for (int before = 0; before < 2; ++before) {
        char text[1024];
        Scene scene;
        snprintf(text, sizeof text, "Translate 10 0 0 %s WorldBegin Identity Translate 10 0 0 %s", before ? GRID : "",
                 before ? "" : GRID);
        import_text(text, &scene);
        const Medium *m = &ELEMENT(&scene, media, Medium, 1);
        assert_vec3(m->extinction, 12.0f, 20.0f, 28.0f, 1e-5f);
        assert_vec3(m->scattering, 4.0f, 4.0f, 4.0f, 1e-5f);
        ASSERT_FLOAT(m->g, 0.25f);
        ck_assert_uint_eq(m->grid, 1);
        ASSERT_FLOAT(grid_sample(&scene, 0, 0, 0, 0), 0.25f);
        ASSERT_FLOAT(grid_sample(&scene, 1, 0, 0, 0), 0.5f);
        ASSERT_FLOAT(grid_sample(&scene, 1, 0, 1, 0), 1.0f);
        ASSERT_FLOAT(grid_sample(&scene, 2, 0, 0, 0), 0.0f);
        const MediumGrid *grid = &ELEMENT(&scene, grids, MediumGrid, 0);
        assert_vec3(affine_point(grid->grid_from_world, vec3(10.0f, 0.0f, 0.0f)), 0.5f, 0.5f, 0.5f, 1e-5f);
        assert_vec3(affine_point(grid->grid_from_world, vec3(11.0f, 2.0f, 4.0f)), 2.5f, 1.5f, 2.5f, 1e-5f);
        scene_destroy(&scene);
    }
}
END_TEST

/* Extinction and scattering of each colour; one that is left out is 1. */
START_TEST(rgb_grid)
{
    Scene scene;
    import_text("MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"integer ny\" 2 \"float scale\" 3\n"
                "\"rgb sigma_a\" [ 1 2 3  4 6 5 ] \"rgb sigma_s\" [ 0 2 1  4 0 3 ]\n"
                "MakeNamedMedium \"s\" \"string type\" \"rgbgrid\" \"rgb sigma_s\" [ 1 2 0 ] WorldBegin",
                &scene);
    const Medium *m = &ELEMENT(&scene, media, Medium, 1), *s = &ELEMENT(&scene, media, Medium, 2);
    assert_vec3(m->extinction, 24.0f, 18.0f, 24.0f, 1e-5f);
    assert_vec3(m->scattering, 12.0f, 6.0f, 9.0f, 1e-5f);
    ASSERT_FLOAT(grid_sample(&scene, 0, 0, 0, 0), 0.125f);
    ASSERT_FLOAT(grid_sample(&scene, 0, 1, 0, 5), 1.0f);
    ASSERT_FLOAT(grid_sample(&scene, 0, 1, 0, 4), 0.0f);
    assert_vec3(s->extinction, 2.0f, 3.0f, 1.0f, 1e-5f);
    assert_vec3(s->scattering, 1.0f, 2.0f, 0.0f, 1e-5f);
    scene_destroy(&scene);
}
END_TEST

/* The grids of emission, their factors, and what these are parts of. */
START_TEST(grid_emission_read)
{
    static const struct {
        const char *text;
        Vec3 emission;
        uint words;
        float first; /* of the second sample's words */
    } cases[] = {
        {"\"uniformgrid\" \"float density\" [ 1 2 ] \"rgb Le\" [ 1 2 3 ]", {4.0f, 8.0f, 12.0f}, 0, 0.0f},
        {"\"uniformgrid\" \"float density\" [ 1 2 ] \"rgb Le\" [ 1 2 3 ] \"float Lescale\" [ 5 3 ]",
         {20.0f, 40.0f, 60.0f},
         1,
         0.6f},
        {"\"uniformgrid\" \"float density\" [ 1 2 ] \"float temperature\" [ 900 300 ]",
         {4.0f, 4.0f, 4.0f},
         1,
         0.333333f},
        {"\"uniformgrid\" \"float density\" [ 1 2 ] \"float temperature\" [ 300 900 ] \"float Lescale\" [ 0.25 0.5 ]\n"
         "\"float temperatureoffset\" 100 \"float temperaturecutoff\" 7 \"float temperaturescale\" 2",
         {2.0f, 2.0f, 2.0f},
         2,
         1.0f},
        {"\"uniformgrid\" \"float density\" [ 1 2 ] \"float Lescale\" [ 0.25 0.5 ]", {0.0f, 0.0f, 0.0f}, 0, 0.0f},
        {"\"rgbgrid\" \"rgb sigma_a\" [ 1 1 2  4 2 2 ] \"rgb Le\" [ 1 1 1  2 1 0 ] \"float Lescale\" 0.5",
         {2.0f * 8.0f * 0.5f * 106.856895f, 2.0f * 2.0f * 0.5f * 106.856895f, 2.0f * 2.0f * 0.5f * 106.856895f},
         6,
         1.0f}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[512];
        Scene scene;
        snprintf(text, sizeof text,
                 "MakeNamedMedium \"m\" \"string type\" %s \"integer nx\" 2 \"float scale\" 2 WorldBegin",
                 cases[i].text);
        import_text(text, &scene);
        const Medium *m = &ELEMENT(&scene, media, Medium, 1);
        Vec3 e = cases[i].emission;
        assert_vec3(m->emission, e.x, e.y, e.z, 1e-5f * (1.0f + e.x));
        const MediumGrid *grid = &ELEMENT(&scene, grids, MediumGrid, 0);
        ck_assert_uint_eq(grid->emission, cases[i].words > 0 ? 2 : 0);
        if (cases[i].words > 0) {
            const SceneView view = {.grids = grid, .texels = scene.texels.data};
            Vec3 value = grid_factors(&view, 1u, vec3(0.75f, 0.5f, 0.5f), false);
            ck_assert_uint_eq(grid[1].words, cases[i].words);
            ck_assert_uint_eq(grid[1].aligned, 1);
            if (cases[i].words != 2)
                TEST_NEAR(value.x, cases[i].first, 1e-5);
            ck_assert_uint_eq(grid[1].table != NONE, i == 2 || i == 3);
        }
        if (i == 3) {
            ASSERT_FLOAT(grid[1].kelvin_scale, 1800.0f);
            ASSERT_FLOAT(grid[1].kelvin_offset, -200.0f);
        }
        scene_destroy(&scene);
    }
}
END_TEST

/* pbrt's density of clouds, written down from its definition, in double but for the noise. */
static double cloud_at(const double p[3], double density, double wispiness, double frequency)
{
    double at[3], weight = 0.05 * wispiness, scale = 10.0, sum = 0.0, part = 0.5;
    for (int i = 0; i < 3; ++i)
        at[i] = frequency * p[i];
    for (int n = 0; n < 2; ++n) {
        Vec3 q = vec3((float)(scale * at[0]), (float)(scale * at[1]), (float)(scale * at[2]));
        double here = (double)noise(q);
        at[0] += weight * ((double)noise(vec3(q.x + 0.01f, q.y, q.z)) - here) / 0.01;
        at[1] += weight * ((double)noise(vec3(q.x, q.y + 0.01f, q.z)) - here) / 0.01;
        at[2] += weight * ((double)noise(vec3(q.x, q.y, q.z + 0.01f)) - here) / 0.01;
        weight *= 0.5;
        scale *= 1.99;
    }
    scale = 1.0;
    for (int n = 0; n < 5; ++n) {
        sum += part * (double)noise(vec3((float)(scale * at[0]), (float)(scale * at[1]), (float)(scale * at[2])));
        part *= 0.5;
        scale *= 1.99;
    }
    sum = fmin(fmax((1.0 - p[1]) * 4.5 * density * sum, 0.0), 1.0);
    return fmin(sum + 2.0 * fmax(0.0, 0.5 - p[1]), 1.0);
}

/* A cloud's grid has its density at the samples, which include the faces of its box. */
START_TEST(cloud)
{
    Scene scene;
    import_text(
        "Translate 3 0 0 MakeNamedMedium \"m\" \"string type\" \"cloud\" \"float density\" 2 \"float wispiness\" 0.7\n"
        "\"float frequency\" 1.5 \"point3 p0\" [ 0 0.25 0 ] \"point3 p1\" [ 1 0.75 1.5 ] \"float sigma_s\" 3 "
        "WorldBegin",
        &scene);
    const MediumGrid *grid = &ELEMENT(&scene, grids, MediumGrid, 0);
    const SceneView view = {.grids = grid, .texels = scene.texels.data};
    assert_vec3(ELEMENT(&scene, media, Medium, 1).extinction, 4.0f, 4.0f, 4.0f, 1e-5f);
    ck_assert_uint_eq(grid->size_x, 48);
    ck_assert_uint_eq(grid->size_y, 24);
    ck_assert_uint_eq(grid->size_z, 72);
    for (int i = 0; i <= 48; i += 4)
        for (int j = 0; j <= 24; j += 4)
            for (int k = 0; k <= 72; k += 4) {
                const double p[3] = {i / 48.0, 0.25 + 0.5 * j / 24.0, 1.5 * k / 72.0};
                Vec3 factors = grid_factors(&view, 0u, vec3((float)p[0] + 3.0f, (float)p[1], (float)p[2]), true);
                TEST_NEAR(factors.y, cloud_at(p, 2.0, 0.7, 1.5), 2e-3);
            }
    scene_destroy(&scene);
    import_text("MakeNamedMedium \"m\" \"string type\" \"cloud\" \"float frequency\" 4000\n"
                "\"point3 p1\" [ 1 0.001 0.001 ] WorldBegin",
                &scene);
    ck_assert_ptr_nonnull(strstr(import_log(), "warning: the medium \"m\" has more detail than the 2049 x"));
    scene_destroy(&scene);
}
END_TEST

/* A far world is moved to the origin, and the grids of media with it; the boxes of those that are used belong to it. */
START_TEST(grid_bounds)
{
    static const char TEXT[] =
        "WorldBegin Translate 1000 0 0 LightSource \"point\"\n"
        "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float density\" 1 \"point3 p1\" [ 1 1 4 ]\n"
        "MakeNamedMedium \"n\" \"string type\" \"uniformgrid\" \"float density\" 1 \"point3 p1\" [ 9 9 9 ]\n"
        "MediumInterface \"m\" \"\" Shape \"sphere\"";
    Scene scene;
    Error error = {0};
    import_text(TEXT, &scene);
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    ck_assert_uint_ne(scene.features & FEATURE_MEDIUM_GRID, 0);
    ASSERT_FLOAT(scene.bounds_max[0], 1001.0f);
    ASSERT_FLOAT(scene.bounds_max[2], 4.0f);
    ck_assert_float_lt(scene.ray_reach, 10.0f);
    Affine map = ELEMENT(&scene, grids, MediumGrid, 0).grid_from_world;
    Vec3 center = affine_point(map, vec3(0.0f, 0.5f, 2.0f));
    ck_assert_float_lt(float_abs(center.x - 1.0f), 1.01f); /* the sphere's middle is about the origin */
    scene_destroy(&scene);
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
    ck_assert_uint_eq(ELEMENT(&scene, light_details, LightDetail, 0).medium, 2);
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
        ck_assert_uint_eq(scene_light_detail(&scene, light)->medium, i == 0 ? 1 : 0);
        ASSERT_FLOAT(light->emission.x, i == 0 ? 0.0f : 1.0f);
        scene_destroy(&scene);
    }
}
END_TEST

/* A grid ends, so light from infinity reaches a scene in one. */
START_TEST(grid_around)
{
    Scene scene;
    Error error = {0};
    import_text("MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float density\" 1 MediumInterface \"m\"\n"
                "Camera \"perspective\" WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]",
                &scene);
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    const Light *light = &ELEMENT(&scene, lights, Light, 0);
    ck_assert_uint_eq(scene_light_detail(&scene, light)->medium, 1);
    ASSERT_FLOAT(light->emission.x, 1.0f);
    ck_assert_float_lt(scene.ray_reach, 10.0f);
    scene_destroy(&scene);
}
END_TEST

TCase *import_media_case(void)
{
    TCase *tcase = tcase_create("media");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, coefficients);
    tcase_add_test(tcase, presets);
    tcase_add_test(tcase, uniform_grid);
    tcase_add_test(tcase, rgb_grid);
    tcase_add_test(tcase, grid_emission_read);
    tcase_add_test(tcase, cloud);
    tcase_add_test(tcase, grid_bounds);
    tcase_add_test(tcase, interfaces);
    tcase_add_test(tcase, features);
    tcase_add_test(tcase, medium_around);
    tcase_add_test(tcase, grid_around);
    return tcase;
}
