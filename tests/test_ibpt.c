/* Three strategies with running products against all stored densities: the same random numbers make the same paths, so
 * pictures may differ by rounding alone. */
#include "render_fixture.h"
#include "test_util.h"

#include <math.h>
#include <string.h>

#define HEAD                                                                                                           \
    "LookAt 0 1.2 4  0 0.8 0  0 1 0\n"                                                                                 \
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 20\n"                                             \
    "Camera \"perspective\" \"float fov\" 50 LENS\nWorldBegin\n"
#define FLOOR                                                                                                          \
    "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.4 ]\n"                                                       \
    "Shape \"bilinearmesh\" \"point3 P\" [ -5 0 -5  5 0 -5  -5 0 5  5 0 5 ]\n"
#define LAMP(shape)                                                                                                    \
    "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 9 8 7 ]\nTranslate 0.3 2.5 0\nRotate 90 1 0 0\n" shape    \
    "AttributeEnd\n"
#define BALL(material)                                                                                                 \
    material "AttributeBegin\nTranslate 0 0.7 0\nShape \"sphere\" \"float radius\" 0.7\nAttributeEnd\n"

/* Every light, delta and rough materials, shading normals by bump, a lens. */
static const char *const SCENES[] = {
    LAMP("Shape \"disk\" \"float radius\" 0.5\n")
        FLOOR BALL("Material \"diffuse\" \"rgb reflectance\" [ 0.3 0.6 0.6 ]\n"),
    LAMP("Shape \"sphere\" \"float radius\" 0.3\n") FLOOR BALL("Material \"dielectric\"\n"),
    LAMP("Shape \"sphere\" \"float radius\" 0.3\n") FLOOR BALL("Material \"dielectric\" \"float roughness\" 0.2\n"),
    "LightSource \"infinite\" \"rgb L\" [ 0.6 0.8 1 ]\n" FLOOR BALL(
        "Material \"conductor\" \"float roughness\" 0.15\n"),
    "LightSource \"distant\" \"point3 from\" [ 1 3 1 ] \"rgb L\" [ 3 3 3 ]\n" FLOOR BALL(
        "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.2 0.3 0.7 ]\n"),
    "LightSource \"spot\" \"point3 from\" [ 1 3 1 ] \"point3 to\" [ 0 0.5 0 ] \"rgb I\" [ 30 30 30 ]\n"
    "LightSource \"point\" \"point3 from\" [ -2 2 1 ] \"rgb I\" [ 5 5 5 ]\n" FLOOR BALL("Material \"dielectric\"\n"),
};

#define SCENE_COUNT (int)(sizeof SCENES / sizeof SCENES[0])

static void picture(const char *scene, const Integrator *integrator, bool balance, RenderedImage *image)
{
    char text[4096];
    snprintf(text, sizeof text, "%s%s", HEAD, scene);
    char *lens = strstr(text, "LENS");
    memcpy(lens, "    ", 4);
    RenderSetup setup = {.text = text,
                         .samples = 24,
                         .max_depth = 7,
                         .seed = 5,
                         .integrator = integrator,
                         .strategies = STRATEGIES_IBPT,
                         .balance = balance};
    fixture_render(&setup, image);
}

/* Single paths may part where roundings decide a hit, so a few pixels in a thousand may differ by more. */
START_TEST(test_running_products)
{
    RenderedImage a, b;
    bool balance = _i >= SCENE_COUNT;
    picture(SCENES[_i % SCENE_COUNT], integrator_ibpt(), balance, &a);
    picture(SCENES[_i % SCENE_COUNT], integrator_bdpt(), balance, &b);
    int pixels = a.width * a.height, different = 0;
    double mean = fixture_mean(&b);
    ck_assert(mean > 0.01);
    for (int i = 0; i < 3 * pixels; ++i)
        different += !(fabs((double)a.rgb[i] - (double)b.rgb[i]) <= 1e-4 * ((double)b.rgb[i] + mean));
    ck_assert_msg(different * 500 <= 3 * pixels, "scene %d: %d of %d values differ", _i, different, 3 * pixels);
    ck_assert_double_eq_tol(fixture_mean(&a) / mean, 1.0, 1e-5);
    fixture_destroy(&a);
    fixture_destroy(&b);
}
END_TEST

/* Bytes of a path's state do not depend on how long it may become. */
START_TEST(test_state_independent_of_depth)
{
    FrameParams frame = {.max_depth = 2};
    StepList list;
    Error error = {0};
    uint words[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        frame.max_depth = i == 0 ? 2 : 60;
        ck_assert(integrator_ibpt()->list(&frame, &list, &error));
        for (int id = 0; id < BUFFER_COUNT; ++id)
            words[i] += list.words_per_item[id];
        step_list_destroy(&list);
    }
    ck_assert_uint_eq(words[0], words[1]);
    ck_assert_uint_lt(words[0], 100);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("ibpt");
    TCase *tcase = tcase_create("ibpt");
    tcase_set_timeout(tcase, 60.0);
    tcase_add_loop_test(tcase, test_running_products, 0, 2 * SCENE_COUNT);
    tcase_add_test(tcase, test_state_independent_of_depth);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
