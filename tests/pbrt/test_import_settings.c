/* Film, PixelFilter, Camera, Integrator, Sampler: pbrt's defaults and explicit settings. */
#include "pbrt/test_import.h"

#include <string.h>

START_TEST(defaults_of_an_empty_scene)
{
    Scene scene;
    import_text("WorldBegin", &scene);
    const SceneSettings *s = &scene.settings;
    ck_assert_int_eq(s->width, 1280);
    ck_assert_int_eq(s->height, 720);
    ck_assert_int_eq(s->crop[2], 1280);
    ck_assert_int_eq(s->crop[3], 720);
    ck_assert_int_eq(s->max_depth, 6);
    ck_assert_int_eq(s->samples, 16);
    ASSERT_FLOAT(s->film_scale, 1.0f);
    ck_assert_uint_eq(scene.camera_settings.kind, CAMERA_PERSPECTIVE);
    ASSERT_FLOAT(scene.camera_settings.fov, 90.0f);
    ck_assert_uint_eq(scene.filter_settings.kind, PIXEL_FILTER_GAUSSIAN);
    ASSERT_FLOAT(scene.filter_settings.radius_x, 1.5f);
    ASSERT_FLOAT(scene.filter_settings.sigma, 0.5f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(film)
{
    Scene scene;
    import_text(
        "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100 \"string filename\" \"a.exr\"\n"
        "\"float cropwindow\" [ 0.25 0.5 1 0 ] \"float iso\" 200 \"float diagonal\" 35 \"bool savefp16\" false\n"
        "Camera \"perspective\" \"float shutteropen\" 0.5 WorldBegin",
        &scene);
    const SceneSettings *s = &scene.settings;
    ck_assert_int_eq(s->width, 200);
    ck_assert_int_eq(s->height, 100);
    ck_assert_str_eq(s->output, "a.exr");
    ck_assert_int_eq(s->crop[0], 50);
    ck_assert_int_eq(s->crop[1], 0);
    ck_assert_int_eq(s->crop[2], 100);
    ck_assert_int_eq(s->crop[3], 100);
    /* pbrt's imaging ratio: shutter open for 1/2, iso 200. */
    ASSERT_FLOAT(s->film_scale, 1.0f);
    scene_destroy(&scene);
}
END_TEST

/* White balance makes light of its temperature white at the same luminance, whatever the kind of light, and leaves that
 * of D65 as it is. Sensors by name count as the default. */
START_TEST(white_balance)
{
    static const char *const LIGHTS[] = {"LightSource \"infinite\" \"spectrum L\" \"stdillum-D50\"",
                                         "LightSource \"point\" \"spectrum I\" \"stdillum-D50\"",
                                         "AreaLightSource \"diffuse\" \"spectrum L\" \"stdillum-D50\" Shape \"disk\""};
    char text[300];
    Scene scene;
    for (size_t i = 0; i < sizeof LIGHTS / sizeof *LIGHTS; ++i) {
        snprintf(text, sizeof text, "Film \"rgb\" \"float whitebalance\" 5003 WorldBegin %s", LIGHTS[i]);
        import_text(text, &scene);
        assert_vec3(ELEMENT(&scene, lights, Light, 0).emission, 1, 1, 1, 0.01f);
        scene_destroy(&scene);
    }
    import_text("Film \"rgb\" \"float whitebalance\" 3000 WorldBegin LightSource \"point\" \"blackbody I\" 3000",
                &scene);
    assert_vec3(ELEMENT(&scene, lights, Light, 0).emission, 1, 1, 1, 1e-5f);
    scene_destroy(&scene);
    import_text("Film \"rgb\" \"float whitebalance\" 6504 WorldBegin LightSource \"point\" \"rgb I\" [ 1 2 3 ]",
                &scene);
    assert_vec3(ELEMENT(&scene, lights, Light, 0).emission, 1, 2, 3, 0.01f);
    scene_destroy(&scene);
    import_text("Film \"rgb\" \"float whitebalance\" 9000 WorldBegin LightSource \"point\" \"rgb I\" [ 1 1 1 ]",
                &scene);
    Vec3 warm = ELEMENT(&scene, lights, Light, 0).emission;
    ck_assert(warm.x > 1.05f && warm.z < 0.9f);
    scene_destroy(&scene);
    import_text("Film \"rgb\" \"float whitebalance\" 20000 WorldBegin LightSource \"point\" \"rgb I\" [ 1 1 1 ]",
                &scene);
    assert_vec3(ELEMENT(&scene, lights, Light, 0).emission, 1.4422930f, 0.9919337f, 0.5485340f, 1e-5f);
    scene_destroy(&scene);
    import_text("Film \"rgb\" \"float whitebalance\" 20000 MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n"
                "\"rgb sigma_a\" [ 1 1 1 ] \"rgb sigma_s\" [ 0 0 0 ] \"rgb Le\" [ 1 1 1 ] WorldBegin",
                &scene);
    assert_vec3(ELEMENT(&scene, media, Medium, 1).emission, 1.4422930f, 0.9919337f, 0.5485340f, 1e-5f);
    scene_destroy(&scene);
    import_text("Film \"rgb\" \"string sensor\" \"nikon_d850\" WorldBegin LightSource \"point\"", &scene);
    assert_vec3(ELEMENT(&scene, lights, Light, 0).emission, 1, 1, 1, 0.0f);
    ck_assert_ptr_nonnull(strstr(import_log(), "warning: the sensor \"nikon_d850\" counts as cie1931"));
    scene_destroy(&scene);
}
END_TEST

START_TEST(pixel_bounds)
{
    Scene scene;
    import_text("Film \"gbuffer\" \"integer pixelbounds\" [ 10 20 700 900 ] \"float exposuretime\" 3 WorldBegin",
                &scene);
    const int wanted[4] = {10, 700, 20, 720};
    ck_assert_mem_eq(scene.settings.crop, wanted, sizeof wanted);
    ASSERT_FLOAT(scene.settings.film_scale, 3.0f);
    const char *log = import_log();
    ck_assert_ptr_nonnull(strstr(log, "\"pixelbounds\" is clipped to the film"));
    ck_assert_ptr_nonnull(strstr(log, "info: the film \"gbuffer\" is written as rgb"));
    scene_destroy(&scene);
}
END_TEST

START_TEST(filters)
{
    static const struct {
        const char *text;
        uint kind;
        float radius_x, radius_y, a, b;
    } cases[] = {{"\"box\"", PIXEL_FILTER_BOX, 0.5f, 0.5f, 0, 0},
                 {"\"triangle\"", PIXEL_FILTER_TRIANGLE, 2, 2, 0, 0},
                 {"\"gaussian\" \"float sigma\" 0.7", PIXEL_FILTER_GAUSSIAN, 1.5f, 1.5f, 0.7f, 0},
                 {"\"mitchell\" \"float B\" 0.5", PIXEL_FILTER_MITCHELL, 2, 2, 0.5f, 1.0f / 3.0f},
                 {"\"sinc\" \"float xradius\" 3", PIXEL_FILTER_SINC, 3, 4, 3, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[128];
        Scene scene;
        snprintf(text, sizeof text, "PixelFilter %s WorldBegin", cases[i].text);
        import_text(text, &scene);
        const FilterSettings *f = &scene.filter_settings;
        ck_assert_uint_eq(f->kind, cases[i].kind);
        ASSERT_FLOAT(f->radius_x, cases[i].radius_x);
        ASSERT_FLOAT(f->radius_y, cases[i].radius_y);
        float a = f->kind == PIXEL_FILTER_GAUSSIAN ? f->sigma : f->kind == PIXEL_FILTER_SINC ? f->tau : f->b;
        ASSERT_FLOAT(a, cases[i].a);
        ASSERT_FLOAT(f->c, cases[i].b);
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(cameras)
{
    Scene scene;
    import_text("Camera \"perspective\" \"float fov\" 35 \"float lensradius\" 0.1 \"float focaldistance\" 5\n"
                "\"float frameaspectratio\" 1.5 WorldBegin",
                &scene);
    const CameraSettings *c = &scene.camera_settings;
    ASSERT_FLOAT(c->fov, 35.0f);
    ASSERT_FLOAT(c->lens_radius, 0.1f);
    ASSERT_FLOAT(c->focal_distance, 5.0f);
    ASSERT_FLOAT(c->frame_aspect, 1.5f);
    ck_assert(!c->has_screen_window);
    scene_destroy(&scene);
    import_text("Camera \"orthographic\" \"float screenwindow\" [ -2 2 -1 1 ] WorldBegin", &scene);
    ck_assert_uint_eq(c->kind, CAMERA_ORTHOGRAPHIC);
    ck_assert(c->has_screen_window);
    ASSERT_FLOAT(c->screen_window[0], -2.0f);
    ASSERT_FLOAT(c->screen_window[3], 1.0f);
    ASSERT_FLOAT(c->focal_distance, 1e6f);
    scene_destroy(&scene);
    import_text("Camera \"spherical\" \"float lensradius\" 0.1 WorldBegin", &scene);
    ck_assert_uint_eq(c->kind, CAMERA_EQUAL_AREA);
    ASSERT_FLOAT(c->lens_radius, 0.0f);
    scene_destroy(&scene);
    import_text("Camera \"spherical\" \"string mapping\" \"equirectangular\" WorldBegin", &scene);
    ck_assert_uint_eq(c->kind, CAMERA_EQUIRECTANGULAR);
    scene_destroy(&scene);
}
END_TEST

START_TEST(integrator_and_sampler)
{
    Scene scene;
    import_text("Integrator \"bdpt\" \"integer maxdepth\" 7 \"bool regularize\" true\n"
                "Sampler \"stratified\" \"integer xsamples\" 8 \"bool jitter\" false\n"
                "Accelerator \"kdtree\" \"integer maxprims\" 1\n WorldBegin",
                &scene);
    ck_assert_int_eq(scene.settings.max_depth, 8);
    ck_assert_int_eq(scene.settings.samples, 32);
    const char *log = import_log();
    ck_assert_ptr_nonnull(strstr(log,
                                 "test.pbrt:1:40: info: parameter \"regularize\" of the integrator \"bdpt\" is not "
                                 "used"));
    ck_assert_ptr_nonnull(strstr(log, "info: parameter \"jitter\" of the sampler \"stratified\" is not used"));
    ck_assert_ptr_nonnull(strstr(log, "info: parameter \"maxprims\" of the accelerator \"kdtree\" is not used"));
    scene_destroy(&scene);
    import_text("Integrator \"path\" \"integer maxdepth\" 0 Sampler \"independent\" WorldBegin", &scene);
    ck_assert_int_eq(scene.settings.max_depth, 1);
    ck_assert_int_eq(scene.settings.samples, 4);
    scene_destroy(&scene);
    import_text("Integrator \"path\" \"integer maxdepth\" 2147483647 WorldBegin", &scene);
    ck_assert_int_eq(scene.settings.max_depth, 65536);
    scene_destroy(&scene);
}
END_TEST

START_TEST(options_and_color_space)
{
    Scene scene;
    import_text("Option \"render-coord_sys\" \"world\" Option \"seed\" 3 ColorSpace \"srgb\" WorldBegin", &scene);
    ck_assert_ptr_nonnull(strstr(import_log(), "info: the option \"seed\" is not used"));
    scene_destroy(&scene);
    import_text_in("ColorSpace \"rec2020\" WorldBegin Material \"measured\" \"string filename\" \"m\"", "", true,
                   &scene);
    ck_assert_uint_eq(scene.counts.substitutions, 2);
    scene_destroy(&scene);
}
END_TEST

TCase *import_settings_case(void)
{
    TCase *tcase = tcase_create("settings");
    tcase_add_test(tcase, defaults_of_an_empty_scene);
    tcase_add_test(tcase, film);
    tcase_add_test(tcase, white_balance);
    tcase_add_test(tcase, pixel_bounds);
    tcase_add_test(tcase, filters);
    tcase_add_test(tcase, cameras);
    tcase_add_test(tcase, integrator_and_sampler);
    tcase_add_test(tcase, options_and_color_space);
    return tcase;
}
