/* Tiny lights, point lights, paths that no strategy can make, and paths that are very rarely found. */
#include "support/numerics.h"

#include <string.h>

/* ---- tiny lights ------------------------------------------------------------------------------------------------- */

/* A sphere of radius r and radiance 1 / r^2 gives the floor below it an irradiance of pi (r / d)^2 cos, whatever r: by
 * light sampling, by light tracing and by all strategies together. */
START_TEST(test_tiny_lights)
{
    static const double RADII[] = {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
    static const struct {
        const char *name;
        bool alone;
        unsigned strategy[2], samples;
    } WAYS[] = {
        {"drawn (1,2)", true, {1, 2}, 16}, {"light tracing (2,1)", true, {2, 1}, 64}, {"all", false, {0, 0}, 16}};
    char text[1024], name[64];
    for (int way = 0; way < 3; ++way) {
        PictureGroups expected, got;
        for (int i = 0; i < 7; ++i) {
            double l = 1.0 / (RADII[i] * RADII[i]);
            GroupSetup setup = {.groups = 16,
                                .render = {.text = text,
                                           .samples = WAYS[way].samples,
                                           .max_depth = 2,
                                           .threads = 1,
                                           .seed = 100u * (unsigned)i,
                                           .integrator = integrator_bdpt(),
                                           .only_strategy = WAYS[way].alone,
                                           .unweighted = WAYS[way].alone,
                                           .strategy = {WAYS[way].strategy[0], WAYS[way].strategy[1]}}};
            snprintf(
                text, sizeof text,
                BD_FILM
                "LookAt 0 3 -6  0 -1 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nWorldBegin\n" BD_GREY BD_FLOOR
                "Translate 0.2 3 0.1 AreaLightSource \"diffuse\" \"rgb L\" [ %.9g %.9g %.9g ]\n"
                "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
                "Shape \"sphere\" \"float radius\" %g\n",
                l, l, l, RADII[i]);
            groups_render(&setup, i == 0 ? &expected : &got);
            if (i == 0)
                continue;
            snprintf(name, sizeof name, "%s, radius %g", WAYS[way].name, RADII[i]);
            groups_compare(name, &got, &expected, 2, false);
            groups_destroy(&got);
        }
        groups_destroy(&expected);
    }
}
END_TEST

/* ---- paths that cannot be made ----------------------------------------------------------------------------------- */

#define POOL_UNDER_SUN                                                                                                 \
    BD_FILM "LookAt 0 4 -3  0 -1 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nWorldBegin\n"                      \
            "LightSource \"distant\" \"rgb L\" [ 3 3 3 ] \"point3 from\" [ 1 2 0 ] \"point3 to\" [ 0 0 0 ]\n" BD_GREY  \
                BD_FLOOR "Material \"dielectric\" \"float eta\" 1.33\n"                                                \
            "Shape \"bilinearmesh\" \"point3 P\" [ -40 0 -40  40 0 -40  -40 0 40  40 0 40 ]\n"

/* The floor of a pool under a point-like sun: no strategy can connect through the water, and no path can hit the sun.
 * The image is exactly black, without NaN. The warning in the log is tested by command/test_cli.sh. */
START_TEST(test_nothing_can_make)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_ibpt(), integrator_bdpt(), integrator_mmlt()};
    RenderedImage image;
    RenderSetup setup = {.text = POOL_UNDER_SUN, .samples = 32, .max_depth = 8, .integrator = integrators[_i]};
    fixture_render(&setup, &image);
    for (size_t i = 0; i < 3 * film_pixels(&image.film); ++i) {
        ck_assert_int_eq(image.film.sums[i], 0);
        ck_assert(!image.film.light_sums || image.film.light_sums[i] == 0);
    }
    ck_assert_uint_eq(image.film.not_finite, 0);
    fixture_destroy(&image);
}
END_TEST

/* ---- paths that are rarely found --------------------------------------------------------------------------------- */

/* A lamp faces away from a wall; a part `probability` of its light hits a small mirror, which reflects a spot onto the
 * wall as bright as the sky's light there. The lamp is 3.5 from the mirror, the wall 4.77, of which 2.6 downward. */
static void rare_text(char *text, size_t size, double probability)
{
    const double across = 0.5446, along = 1.8387, length = hypot(across, along); /* normal: down and forward */
    double h = 0.5 * sqrt(probability * M_PI * 12.25 / 0.959), l = M_PI / (1.4 * probability);
    double up = h * along / length, back = h * across / length;
    snprintf(text, size,
             BD_FILM "LookAt 0 0 -6  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\n"
                     "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
                     "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"
                     "Shape \"bilinearmesh\" \"point3 P\" [ -3 -3 1  3 -3 1  -3 3 1  3 3 1 ]\n"
                     "Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0\n"
                     "Shape \"bilinearmesh\" \"point3 P\" [ %.9g %.9g %.9g  %.9g %.9g %.9g  %.9g %.9g %.9g  %.9g %.9g "
                     "%.9g ]\nAreaLightSource \"diffuse\" \"rgb L\" [ %.9g %.9g %.9g ]\n"
                     "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nReverseOrientation\n"
                     "Shape \"bilinearmesh\" \"point3 P\" [ -0.25 2.35 0.5  0.25 2.35 0.5  -0.25 2.85 0.5  0.25 2.85 "
                     "0.5 ]\n",
             -h, 2.6 - up, -3.0 - back, h, 2.6 - up, -3.0 - back, -h, 2.6 + up, -3.0 + back, h, 2.6 + up, -3.0 + back,
             l, l, l);
}

/* A chain that has found the mirror can hardly leave it, since almost every step misses it. Generations limit its life,
 * so that the mean is right and no pixel keeps what a stuck chain has accumulated. Light subpaths are aimed at the
 * mirror (light/aim.h), however small it is. */
START_TEST(test_rare)
{
    char text[2048], name[48];
    PictureGroups expected, got;
    double probability = test_effort() > 1 ? 1e-6 : 1e-4, worst[2] = {0.0, 0.0};
    rare_text(text, sizeof text, probability);
    GroupSetup setup = {
        .groups = 16,
        .render = {.text = text, .samples = 500, .max_depth = 3, .threads = 2, .integrator = integrator_bdpt()}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    setup.render.seed = 1000;
    groups_render(&setup, &got);
    for (int i = 0; i < got.groups * got.width * got.height; ++i) {
        worst[0] = fmax(worst[0], expected.values[i]);
        worst[1] = fmax(worst[1], got.values[i]);
    }
    printf("light of probability %g: brightest pixel of %d pictures %.3g by bdpt, %.3g by mmlt\n", probability,
           got.groups, worst[0], worst[1]);
    snprintf(name, sizeof name, "probability %g", probability);
    groups_compare(name, &got, &expected, 4, false);
    ck_assert_double_lt(worst[1], 4.0 * groups_mean(&expected));
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

TCase *numerics_lights_case(void)
{
    TCase *tcase = tcase_create("lights");
    tcase_set_timeout(tcase, 300);
    tcase_add_test(tcase, test_tiny_lights);
    tcase_add_loop_test(tcase, test_nothing_can_make, 0, 4);
    tcase_add_test(tcase, test_rare);
    return tcase;
}
