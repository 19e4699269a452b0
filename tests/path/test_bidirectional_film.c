/* Film positions of splats: crop windows, filters, borders; energy conservation through glass in both directions; scene
 * scale; the narrow corner. */
#include "support/bidirectional.h"

#include "base/sample_statistics.h"

/* Integrators whose splats are spread against path tracing whose samples go to one pixel. */
static void spread_agrees(const char *name, const char *text, int depth, unsigned samples)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_ibpt()};
    PictureGroups expected, got;
    GroupSetup setup = {.groups = 16,
                        .render = {.text = text, .samples = 2 * samples, .max_depth = depth, .threads = 1}};
    groups_render(&setup, &expected);
    setup.render.samples = samples;
    setup.render.seed = 1000;
    setup.render.reconstruction = RECONSTRUCTION_SPLAT;
    for (int i = 0; i < 2; ++i) {
        setup.render.integrator = integrators[i];
        groups_render(&setup, &got);
        groups_compare(name, &got, &expected, 3, true);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
}

/* BDPT and light tracing (t = 1) against path tracing. reconstruction: of the former. */
static void pictures_agree(const char *name, const char *text, int depth, unsigned samples, const unsigned strategy[2],
                           unsigned reconstruction)
{
    PictureGroups expected, got;
    GroupSetup setup = {.groups = 16,
                        .at_depth = strategy != NULL,
                        .render = {.text = text, .samples = 2 * samples, .max_depth = depth, .threads = 1}};
    groups_render(&setup, &expected);
    setup.at_depth = false;
    setup.render.integrator = integrator_bdpt();
    setup.render.samples = samples;
    setup.render.seed = 1000;
    setup.render.reconstruction = reconstruction;
    if (strategy) {
        setup.render.only_strategy = setup.render.unweighted = true;
        setup.render.strategy[0] = strategy[0];
        setup.render.strategy[1] = strategy[1];
    }
    groups_render(&setup, &got);
    groups_compare(name, &got, &expected, 3, true);
    groups_destroy(&got);
    groups_destroy(&expected);
}

/* ---- crop, filter, borders --------------------------------------------------------------------------------------- */

#define LIT_FROM_ALL_SIDES                                                                                             \
    "LookAt 0 1.2 -6  0 -0.2 0  0 1 0\nCamera \"perspective\" \"float fov\" 38 \"float lensradius\" 0.1 "              \
    "\"float focaldistance\" 5\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n" BD_LAMP BD_GREY BD_FLOOR   \
        BD_BALL

/* Border pixels get as much as inner ones; paths of two segments, by light tracing alone. Half of the light paths are
 * the sky's: with few, its splats are too rare for Student's test. */
START_TEST(test_filters)
{
    static const unsigned LIGHT_TRACING[2] = {2, 1};
    static const char *const CROPS[] = {"", "\"integer pixelbounds\" [ 3 9 5 8 ]"};
    const char *filter = BIDIRECTIONAL_FILTERS[_i / 4];
    const unsigned reconstruction = _i / 2 % 2 == 0 ? RECONSTRUCTION_SAMPLE : RECONSTRUCTION_SPLAT;
    char text[4096];
    if (test_effort() == 1 && _i % 2 != (_i / 2 + _i / 4) % 2)
        return; /* with the other crop window only in make check-long */
    snprintf(
        text, sizeof text,
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 9 %s\nPixelFilter %s\n" LIT_FROM_ALL_SIDES,
        CROPS[_i % 2], filter);
    pictures_agree(filter, text, 2, 240, LIGHT_TRACING, reconstruction);
    pictures_agree(filter, text, 3, 30, NULL, reconstruction);
    if (reconstruction == RECONSTRUCTION_SPLAT)
        spread_agrees(filter, text, 3, 60);
}
END_TEST

/* ---- glass in both directions ------------------------------------------------------------------------------------ */

/* A small light inside a glass ball over a floor: with 3 segments all light goes lens, floor, glass, light, and light
 * tracing makes all of it (no path of that length misses the floor, since the view holds nothing else). */
START_TEST(test_light_inside_glass)
{
    static const unsigned LIGHT_TRACING[2] = {3, 1};
    pictures_agree(
        "light inside glass (3,1)",
        BD_FILM "LookAt 0 3 -5  0 -1 0  0 1 0\nCamera \"perspective\" \"float fov\" 24\nWorldBegin\n" BD_GREY BD_FLOOR
                "AttributeBegin Translate 0 2.5 1.5\nMaterial \"dielectric\" \"float eta\" 1.5\n"
                "Shape \"sphere\" \"float radius\" 1\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
                "AreaLightSource \"diffuse\" \"rgb L\" [ 40 40 40 ]\nShape \"sphere\" \"float radius\" 0.6\n"
                "AttributeEnd\n",
        3, 100, LIGHT_TRACING, RECONSTRUCTION_SAMPLE);
}
END_TEST

/* A diffuse ball inside a rough glass ball, with the lamp outside: light passes in and out, and a camera inside glass
 * looks out. All strategies. */
START_TEST(test_glass_both_ways)
{
    pictures_agree("ball inside rough glass",
                   BD_ROOM
                   "Material \"dielectric\" \"float eta\" 1.5 \"float roughness\" 0.4 \"bool remaproughness\" false\n"
                   "Shape \"sphere\" \"float radius\" 1\nMaterial \"diffuse\"\nShape \"sphere\" \"float radius\" 0.6\n",
                   6, 16, NULL, RECONSTRUCTION_SAMPLE);
    pictures_agree("camera inside glass",
                   BD_ROOM "Material \"diffuse\"\n" BD_BALL
                           "Translate 0 1.2 -6 Material \"dielectric\" \"float eta\" 1.5\n"
                           "Shape \"sphere\" \"float radius\" 1\n",
                   5, 16, NULL, RECONSTRUCTION_SAMPLE);
}
END_TEST

/* ---- scale ------------------------------------------------------------------------------------------------------- */

/* A scaled scene has the same image. */
START_TEST(test_scale)
{
    static const double SCALES[] = {1e-3, 1e4};
    char text[2048], name[32];
    double scale = SCALES[_i];
    PictureGroups expected, got;
    GroupSetup setup = {.groups = 16, .render = {.samples = 16, .max_depth = 4, .threads = 1}};
    setup.render.text = BD_ROOM BD_BALL;
    groups_render(&setup, &expected);
    snprintf(
        text, sizeof text,
        BD_FILM
        "LookAt 0 %g %g  0 %g 0  0 1 0\nCamera \"perspective\" \"float fov\" 38\nWorldBegin\nScale %g %g %g\n" BD_LAMP
            BD_GREY BD_FLOOR BD_BALL,
        1.2 * scale, -6.0 * scale, -0.2 * scale, scale, scale, scale);
    setup.render.text = text;
    setup.render.integrator = integrator_bdpt();
    setup.render.seed = 1000;
    groups_render(&setup, &got);
    snprintf(name, sizeof name, "scale %g", scale);
    groups_compare(name, &got, &expected, 4, true);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* ---- the corner of one degree ------------------------------------------------------------------------------------ */

/* Two planes that meet at one degree, lit from the open side: connections deep inside are arbitrarily short. No pixel
 * is brighter than 100 times the median, over images of 16 samples. */
START_TEST(test_corner)
{
    enum { PIXELS = 16 * 16 };
    PictureGroups picture;
    GroupSetup setup = {.groups = 32,
                        .render = {.text = BD_FILM
                                   "LookAt 8 1.5 0  4 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n"
                                   "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0.8 0.8 0.8 ]\n"
                                   "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 -4  9 0 -4  0 0 4  9 0 4 ]\n"
                                   "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 -4  6 0.104731 -4  0 0 4  6 "
                                   "0.104731 4 ]\n"
                                   "AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ] \"bool twosided\" true\n"
                                   "Shape \"bilinearmesh\" \"point3 P\" [ 9 0.5 -3  9 3 -3  9 0.5 3  9 3 3 ]\n",
                                   .samples = 16,
                                   .max_depth = 6,
                                   .threads = 1,
                                   .balance = _i == 1,
                                   .integrator = integrator_bdpt()}};
    groups_render(&setup, &picture);
    ck_assert(picture.sound);
    double worst = 0.0;
    for (int g = 0; g < setup.groups; ++g) {
        double *values = picture.values + g * PIXELS;
        sample_sort(values, PIXELS);
        ck_assert(values[PIXELS / 2] > 0.0);
        worst = fmax(worst, values[PIXELS - 1] / values[PIXELS / 2]);
    }
    printf("corner of one degree, %s: brightest pixel %.3g medians\n", _i ? "balance" : "power", worst);
    ck_assert_double_lt(worst, 100.0);
    groups_destroy(&picture);
}
END_TEST

TCase *bidirectional_film_case(void)
{
    TCase *tcase = tcase_create("film");
    tcase_set_timeout(tcase, 600);
    tcase_add_loop_test(tcase, test_filters, 0, 4 * BIDIRECTIONAL_FILTER_COUNT);
    return tcase;
}

TCase *bidirectional_hard_case(void)
{
    TCase *tcase = tcase_create("hard");
    tcase_set_timeout(tcase, 600);
    tcase_add_test(tcase, test_light_inside_glass);
    tcase_add_test(tcase, test_glass_both_ways);
    tcase_add_loop_test(tcase, test_scale, 0, 2);
    tcase_add_loop_test(tcase, test_corner, 0, 2);
    return tcase;
}
