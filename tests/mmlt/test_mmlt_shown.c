/* Path tracing and chains agree on the partition: what path tracing shows of a path, and what chains therefore show of
 * the rest, is the same function of the path, whatever strategy makes it, wherever on the film it starts, and however
 * many lights contribute to it. */
#include "support/bidirectional.h"

#include "mmlt/combination.h"

/* A sun that covers a hundredth of all directions, over a pane of glass: paths that hit it are sometimes above path
 * tracing's clamping threshold, so that path tracing shows part of them and leaves the rest to chains. */
#define SUN(scale)                                                                                                     \
    "AttributeBegin Rotate -90 1 0 0 LightSource \"infinite\" \"string filename\" \"$FILES/wide_sun.pfm\" "            \
    "\"float scale\" " scale " AttributeEnd\n"
#define PANE(y, side)                                                                                                  \
    "Material \"thindielectric\" \"float eta\" 1.5 Shape \"bilinearmesh\" \"point3 P\" [ -" side " " y " -" side       \
    "  " side " " y " -" side "  -" side " " y " " side "  " side " " y " " side " ]\n"

/* The estimators, and path tracing with its own rare light, which needs no chains. */
#define SHOWN_COUNT (ESTIMATOR_COUNT + 1)

/* One estimator alone plus what it leaves to chains, or all of them (-1), against path tracing. */
static void estimator_compare(const char *name, const BidirectionalScene *scene, int estimator,
                              unsigned expected_samples, unsigned samples, unsigned reconstruction)
{
    PictureGroups expected, got;
    char line[128];
    GroupSetup setup = {
        .groups = 16,
        .render = {
            .text = bidirectional_text(scene), .samples = expected_samples, .max_depth = scene->depth, .threads = 1}};
    groups_render(&setup, &expected);
    setup.render.samples = samples;
    setup.render.seed = 11000;
    setup.render.integrator = integrator_mmlt();
    setup.render.chains = (ChainOptions){.chains = 256, .steps = 16, .shown = 1 + estimator};
    setup.render.reconstruction = reconstruction;
    groups_render(&setup, &got);
    snprintf(line, sizeof line, "%s, estimator %d", name, estimator);
    groups_compare(line, &got, &expected, 2, false);
    groups_destroy(&got);
    groups_destroy(&expected);
}

/* At effort 1 only path tracing; all of them in make check-long. */
static bool estimator_left_out(int estimator)
{
    return test_effort() == 1 && estimator < ESTIMATOR_PATHS;
}

/* ---- filters ----------------------------------------------------------------------------------------------------- */

/* Large pixels in a small scene, so that light tracing (t = 1) contributes much of the image, and a small crop window,
 * so that filters extend far beyond it. With every other filter splats are spread; with one of these the pool is shown
 * at effort 1, too. */
START_TEST(test_shown_filters)
{
    const int estimator = _i % SHOWN_COUNT, filter = _i / SHOWN_COUNT;
    const unsigned reconstruction = filter % 2 == 1 ? RECONSTRUCTION_SPLAT : RECONSTRUCTION_SAMPLE;
    char text[2048];
    if (estimator_left_out(estimator) && !(estimator == ESTIMATOR_POOL && filter == 3))
        return;
    snprintf(text, sizeof text,
             "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 \"integer pixelbounds\" [ 2 5 3 6 ]\n"
             "PixelFilter %s\nLookAt 0 0.4 0  0 -1 0  0 0 1\n"
             "Camera \"orthographic\" \"float screenwindow\" [ -2 2 -2 2 ]\nWorldBegin\n" SUN("1") BD_GREY
             "Shape \"bilinearmesh\" \"point3 P\" [ -2 -1 -2  2 -1 -2  -2 -1 2  2 -1 2 ]\n" PANE("0.5", "3"),
             BIDIRECTIONAL_FILTERS[filter]);
    const BidirectionalScene scene = {"sun", text, SUPPORT_SUM_ONLY, 5, 2};
    estimator_compare(BIDIRECTIONAL_FILTERS[filter], &scene, estimator, 1024, 1024, reconstruction);
}
END_TEST

/* ---- several infinite lights ------------------------------------------------------------------------------------- */

#define UNDER_PANE                                                                                                     \
    BD_BEGIN BD_GREY                                                                                                   \
        "Shape \"bilinearmesh\" \"point3 P\" [ -40 -1 -40  40 -1 -40  -40 -1 40  40 -1 40 ]\n" PANE("1.5", "40")

/* A floor under a pane in the sun: a path that leaves the scene gathers all infinite lights at once. */
static const BidirectionalScene SUNS[] = {
    {"one sun", UNDER_PANE SUN("1"), SUPPORT_SUM_ONLY, 4, 2},
    {"two suns", UNDER_PANE SUN("0.75") SUN("0.25"), SUPPORT_SUM_ONLY, 4, 2},
    {"four suns", UNDER_PANE SUN("0.25") SUN("0.25") SUN("0.25") SUN("0.25"), SUPPORT_SUM_ONLY, 4, 2},
};
#define SUNS_COUNT (int)(sizeof SUNS / sizeof SUNS[0])

START_TEST(test_shown_lights)
{
    const int estimator = _i % SHOWN_COUNT;
    const BidirectionalScene *scene = &SUNS[_i / SHOWN_COUNT];
    if (!estimator_left_out(estimator))
        estimator_compare(scene->name, scene, estimator, 64, 128, RECONSTRUCTION_SAMPLE);
}
END_TEST

/* ---- media that emit --------------------------------------------------------------------------------------------- */

/* Fire and glowing fog beside a lamp. Path tracing shows what they emit along all segments, in whatever way the other
 * light is shown. */
static const BidirectionalScene FIRE = {
    "fire",
    "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 1.5 2 ] \"float sigma_s\" 0\n"
    "\"rgb Le\" [ 3 2 1 ]\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.05 0.05 0.05 ]\n"
    "\"rgb sigma_s\" [ 0.3 0.2 0.4 ] \"float g\" 0.3 \"rgb Le\" [ 0.5 1 1 ]\n"
    "MediumInterface \"fog\"\n" BD_ROOM "AttributeBegin MediumInterface \"fire\" \"fog\" Translate 1 0 0\n"
    "Material \"interface\"\n" BD_BALL "AttributeEnd\n"
    "AttributeBegin Translate -1 0 0 Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ]\n" BD_BALL
    "AttributeEnd\n",
    SUPPORT_SUM_ONLY, 5, 2};

START_TEST(test_shown_emission)
{
    if (_i < 0 || !estimator_left_out(_i))
        estimator_compare(FIRE.name, &FIRE, _i, 128, 128, RECONSTRUCTION_SAMPLE);
}
END_TEST

/* ---- signs ------------------------------------------------------------------------------------------------------- */

/* A sky and reflectances that a scene file makes negative: by an image, by a factor of -1, by a mix with an amount
 * outside 0 ... 1. */
static const char SIGNS[] = BD_BEGIN BD_LAMP
    "AttributeBegin LightSource \"infinite\" \"string filename\" \"$FILES/signs.pfm\" AttributeEnd\n"
    "Texture \"image\" \"spectrum\" \"imagemap\" \"string filename\" \"$FILES/signs.pfm\"\n"
    "Texture \"factor\" \"spectrum\" \"scale\" \"texture tex\" \"image\" \"float scale\" -1\n"
    "Texture \"mix\" \"spectrum\" \"mix\" \"rgb tex1\" [ 0.5 0.2 0.9 ] \"texture tex2\" \"factor\" "
    "\"float amount\" 2\n"
    "Material \"diffuse\" \"texture reflectance\" \"mix\"\n" BD_FLOOR
    "Material \"conductor\" \"texture eta\" \"mix\" \"texture k\" \"factor\" \"float roughness\" 0.3\n"
    "AttributeBegin Translate -1 0 0 " BD_BALL "AttributeEnd\n"
    "Material \"diffusetransmission\" \"texture reflectance\" \"factor\" \"texture transmittance\" \"mix\"\n"
    "AttributeBegin Translate 1 0 0 " BD_BALL "AttributeEnd\n";

/* Chains follow luminance, so they cannot show paths without positive luminance, though pools and path tracing could.
 * No path has such a contribution: lights and reflectances are clamped to be non-negative. */
START_TEST(test_signs)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt(), integrator_mmlt()};
    const BidirectionalScene scene = {"signs", SIGNS, SUPPORT_SUM_ONLY, 5, 2};
    for (int i = 0; i < 3; ++i) {
        RenderedImage image;
        const RenderSetup setup = {
            .text = bidirectional_text(&scene), .samples = 4, .max_depth = 5, .integrator = integrators[i]};
        double sum = 0.0;
        fixture_render(&setup, &image);
        for (int k = 0; k < 3 * 16 * 16; ++k) {
            ck_assert_msg(image.rgb[k] >= 0.0f, "%s: value %d is %g", integrators[i]->name, k, (double)image.rgb[k]);
            sum += (double)image.rgb[k];
        }
        ck_assert_double_gt(sum, 0.0);
        ck_assert_uint_eq(image.film.not_finite, 0);
        fixture_destroy(&image);
    }
}
END_TEST

TCase *mmlt_shown_case(void)
{
    TCase *tcase = tcase_create("shown");
    tcase_set_timeout(tcase, 3000);
    tcase_add_unchecked_fixture(tcase, bidirectional_files_make, bidirectional_files_remove);
    tcase_add_loop_test(tcase, test_shown_filters, 0, BIDIRECTIONAL_FILTER_COUNT * SHOWN_COUNT);
    tcase_add_loop_test(tcase, test_shown_lights, 0, SUNS_COUNT * SHOWN_COUNT);
    tcase_add_loop_test(tcase, test_shown_emission, -1, SHOWN_COUNT);
    tcase_add_test(tcase, test_signs);
    return tcase;
}
