/* Caustics by photons: any photons leave the picture what it is, wherever other strategies find its light, and show it
 * where no other does. */
#include "path/test_caustic.h"

#include "support/bidirectional.h"
#include "support/test_files.h"

#include "mmlt/combination.h"

#include <math.h>
#include <stdlib.h>

#define PHOTONS 4096u

/* ---- the same picture with and without --------------------------------------------------------------------------- */

#define BEADS                                                                                                          \
    SMOOTH_GLASS "AttributeBegin Translate -1 -0.4 0.2 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"           \
                 "AttributeBegin Translate 0.9 -0.5 -0.6 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n"        \
                 "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.8 0.6 ] \"float roughness\" 0\n"                  \
                 "AttributeBegin Translate 0 -0.3 1.2 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd\n"
#define WALL "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 2  4 -1 2  -4 3 2  4 3 2 ]\n"
#define WATER SMOOTH_GLASS "Shape \"bilinearmesh\" \"point3 P\" [ -9 0.9 -9  9 0.9 -9  -9 0.8 9  9 0.8 9 ]\n"
#define WIDE_SUN                                                                                                       \
    "AttributeBegin Rotate -60 1 0 0 LightSource \"infinite\" \"string filename\" \"$FILES/wide_sun.pfm\" "            \
    "AttributeEnd\n"
#define COATED "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.8 0.5 0.3 ] \"float roughness\" 0\n"

/* Lamps of every kind over smooth surfaces of every kind. Under water the caustic has as many segments as a path
 * may. */
static const BidirectionalScene SCENES[] = {
    {"quad lamp", BD_ROOM BEADS, SUPPORT_SUM_ONLY, 6, 2},
    {"ball lamp", BD_BEGIN BD_GREY BD_FLOOR BALL_LAMP("0.6", "12") BEADS, SUPPORT_SUM_ONLY, 6, 2},
    {"two-sided lamp, coated floor",
     BD_BEGIN COATED BD_FLOOR
     "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ] \"bool twosided\" true Material \"diffuse\" \"rgb "
     "reflectance\" [ 0 0 0 ]\nShape \"bilinearmesh\" \"point3 P\" [ -1 0.8 1  1 1.5 1  -1 0.8 1.5  1 1.5 1.6 ] "
     "AttributeEnd\n" SMOOTH_GLASS BD_BALL,
     SUPPORT_SUM_ONLY, 6, 2},
    {"sun in the sky", BD_BEGIN BD_GREY BD_FLOOR WIDE_SUN "LightSource \"infinite\" \"rgb L\" [ 0.2 0.2 0.2 ]\n" BEADS,
     SUPPORT_SUM_ONLY, 6, 2},
    {"under water", BD_BEGIN BD_GREY BD_FLOOR BALL_LAMP("0.4", "30") WALL WATER, SUPPORT_SUM_ONLY, 4, 2},
    {"rough and smooth",
     BD_ROOM SMOOTH_GLASS BD_BALL
     "Material \"conductor\" \"rgb reflectance\" [ 0.8 0.8 0.8 ] \"float roughness\" 0.3\nAttributeBegin "
     "Translate 1.6 -0.4 0 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n",
     SUPPORT_SUM_ONLY, 6, 2},
};
#define SCENE_COUNT (int)(sizeof SCENES / sizeof SCENES[0])

/* Path tracing; the default; each estimator alone plus what it leaves to chains. The default and path tracing, with
 * what it leaves to chains or with its own rare light, if it draws by photons at all receivers. */
enum {
    WAY_PATHS,
    WAY_ALL,
    WAY_ESTIMATORS,
    WAY_EVERYWHERE = WAY_ESTIMATORS + ESTIMATOR_COUNT,
    WAY_EVERYWHERE_PATHS,
    WAY_EVERYWHERE_ALONE,
    WAY_COUNT
};

static ChainOptions way_options(int way)
{
    ChainOptions options = {.chains = 256, .steps = 16, .photons_everywhere = way >= WAY_EVERYWHERE};
    if (way >= WAY_ESTIMATORS && way < WAY_EVERYWHERE)
        options.shown = 1 + way - WAY_ESTIMATORS;
    else if (way == WAY_EVERYWHERE_PATHS)
        options.shown = 1 + ESTIMATOR_PATHS;
    else if (way == WAY_EVERYWHERE_ALONE)
        options.shown = SHOWN_PATHS_ALONE;
    return options;
}

/* In make check each scene is rendered in one of the ways of each kind; in make check-long in all. Light under water is
 * shown by bidirectional path tracing alone, beside which path tracing has what photons draw. */
static bool way_due(int way, int scene)
{
    if (test_effort() != 1 || way < WAY_ESTIMATORS)
        return true;
    return way < WAY_EVERYWHERE ? way - WAY_ESTIMATORS == (scene + ESTIMATOR_BIDIRECTIONAL) % ESTIMATOR_COUNT
                                : way - WAY_EVERYWHERE == scene % (WAY_COUNT - WAY_EVERYWHERE);
}

START_TEST(test_same)
{
    const BidirectionalScene *scene = &SCENES[_i];
    PictureGroups expected, got;
    char line[128];
    GroupSetup setup = {
        .groups = 16,
        .render = {.text = bidirectional_text(scene), .samples = 256, .max_depth = scene->depth, .threads = 1}};
    groups_render(&setup, &expected);
    setup.render.seed = 5000;
    setup.render.photons = PHOTONS;
    for (int way = 0; way < WAY_COUNT; ++way) {
        if (!way_due(way, _i))
            continue;
        setup.render.samples = way == WAY_PATHS ? 64 : way == WAY_ESTIMATORS + ESTIMATOR_BIDIRECTIONAL ? 256 : 128;
        setup.render.integrator = way == WAY_PATHS ? integrator_pt() : integrator_mmlt();
        setup.render.chains = way_options(way);
        groups_render(&setup, &got);
        snprintf(line, sizeof line, "%s, way %d", scene->name, way);
        groups_compare(line, &got, &expected, 2, false);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
}
END_TEST

/* All light of a small lamp comes through glass, and photons and connections find it: nearly all of what photons draw is
 * rare light, which chains show, too, so that path tracing with theirs shows it once. */
START_TEST(test_small_lamp)
{
    static const BidirectionalScene scene = {
        "small lamp in glass",
        BD_BEGIN BD_GREY BD_FLOOR BALL_LAMP("0.05", "900") SMOOTH_GLASS
        "AttributeBegin Translate 1 2 -1 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n",
        SUPPORT_SUM_ONLY, 5, 2};
    PictureGroups expected, got;
    GroupSetup setup = {.groups = 32,
                        .render = {.text = bidirectional_text(&scene),
                                   .samples = 256,
                                   .max_depth = scene.depth,
                                   .threads = 1,
                                   .integrator = integrator_bdpt()}};
    groups_render(&setup, &expected);
    setup.render.seed = 5000;
    setup.render.photons = PHOTONS;
    setup.render.integrator = integrator_mmlt();
    setup.render.chains = way_options(WAY_EVERYWHERE_PATHS);
    groups_render(&setup, &got);
    groups_compare(scene.name, &got, &expected, 2, false);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* ---- light that nothing else finds ------------------------------------------------------------------------------- */

/* Glass whose index hardly differs from 1 bends no light, so a floor under a pane of it, seen through the pane, is as
 * bright as without it; but no light can be connected with through it. */
#define PLANE(y) "Shape \"bilinearmesh\" \"point3 P\" [ -9 " y " -9  9 " y " -9  -9 " y " 9  9 " y " 9 ]\n"
#define NEARLY_NOTHING "Material \"dielectric\" \"float eta\" 1.0001\n"
#define PANE NEARLY_NOTHING PLANE("0.9")
#define UNDER_WATER(lights) BD_BEGIN BD_GREY BD_FLOOR lights
#define POINT "LightSource \"point\" \"rgb I\" [ 9 9 9 ] \"point3 from\" [ 1 2.2 -1 ]\n"
#define SPOT                                                                                                           \
    "LightSource \"spot\" \"rgb I\" [ 20 20 20 ] \"point3 from\" [ 1 3 0 ] \"point3 to\" [ 0 -1 0 ] \"float "          \
    "coneangle\" 40 \"float conedeltaangle\" 15\n"
#define GONIOMETRIC                                                                                                    \
    "AttributeBegin Translate 1 2.2 -1 Rotate 40 1 0 0 LightSource \"goniometric\" \"rgb I\" [ 9 9 9 ] "               \
    "\"string filename\" \"$FILES/sky.pfm\" AttributeEnd\n"
#define PROJECTION                                                                                                     \
    "AttributeBegin Translate 1 3 0 Rotate 90 1 0 0 LightSource \"projection\" \"float scale\" 30 \"float fov\" 80 "   \
    "\"string filename\" \"$FILES/sky.pfm\" AttributeEnd\n"
#define DISTANT "LightSource \"distant\" \"rgb L\" [ 2 2 2 ] \"point3 from\" [ 1 3 -1 ] \"point3 to\" [ 0 0 0 ]\n"
#define SPARK BALL_LAMP("0.01", "30000")

/* Ink below the pane, and above it haze, with a ball of mist that scatters in the middle, around the lights. */
#define MURKY                                                                                                          \
    BD_VIEW                                                                                                            \
    "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.05 0.2 0.4 ] \"float sigma_s\" 0\n"   \
    "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.2 0.1 0.05 ] \"float sigma_s\" 0\n"  \
    "MakeNamedMedium \"mist\" \"string type\" \"homogeneous\" \"float sigma_a\" 0.7 \"float sigma_s\" 0.2\n"           \
    "MediumInterface \"\" \"haze\" Camera \"perspective\" \"float fov\" 38\n"                                          \
    "WorldBegin MediumInterface \"\" \"\"\n"
#define MIST                                                                                                           \
    "AttributeBegin Translate 1 2.2 -1 MediumInterface \"mist\" \"haze\" Material \"interface\" Shape \"sphere\" "     \
    "\"float radius\" 0.8 AttributeEnd\n"
#define LIGHTS_IN(medium, lights) "AttributeBegin MediumInterface \"\" \"" medium "\"\n" lights "AttributeEnd\n"
#define CARD "Shape \"bilinearmesh\" \"point3 P\" [ 0.2 1.2 -0.6  0.9 1.2 -0.6  0.2 1.2 0.4  0.9 1.2 0.4 ]\n"
#define SEPARATING(material) "AttributeBegin MediumInterface \"haze\" \"ink\"\n" material PLANE("0.9") "AttributeEnd\n"
#define OPEN SEPARATING("Material \"interface\"\n")
#define INK SEPARATING(NEARLY_NOTHING)

/* Of a distant light, a millionth meets the pane, which is hardly wider than what is seen. */
#define WIDE_WORLD "Shape \"bilinearmesh\" \"point3 P\" [ -9e3 -20 -9e3  9e3 -20 -9e3  -9e3 -20 9e3  9e3 -20 9e3 ]\n"
static const struct {
    const char *name, *begin, *lights, *open, *closed; /* without glass and with it */
} UNSEEN[] = {{"point", BD_BEGIN, POINT, "", PANE},
              {"spot", BD_BEGIN, SPOT, "", PANE},
              {"goniometric", BD_BEGIN, GONIOMETRIC, "", PANE},
              {"projection", BD_BEGIN, PROJECTION, "", PANE},
              {"distant", BD_BEGIN, DISTANT, "", PANE},
              {"small lamp", BD_BEGIN, SPARK, "", PANE},
              {"several", BD_BEGIN, POINT DISTANT SPARK, "", PANE},
              {"distant, wide world", BD_BEGIN, DISTANT WIDE_WORLD, "", PANE},
              {"point, wide world", BD_BEGIN, POINT WIDE_WORLD, "", PANE},
              {"point in mist", MURKY, MIST LIGHTS_IN("mist", POINT), OPEN, INK},
              {"spot, mist and a card on the way", MURKY, MIST CARD LIGHTS_IN("haze", SPOT), OPEN, INK},
              {"projection in haze, goniometric in mist", MURKY,
               MIST LIGHTS_IN("haze", PROJECTION) LIGHTS_IN("mist", GONIOMETRIC), OPEN, INK}};
#define UNSEEN_COUNT (int)(sizeof UNSEEN / sizeof UNSEEN[0])

static const char *unseen_text(int i, bool glass)
{
    static char text[8192];
    snprintf(text, sizeof text, "%s" BD_GREY BD_FLOOR "%s%s", UNSEEN[i].begin, UNSEEN[i].lights,
             glass ? UNSEEN[i].closed : UNSEEN[i].open);
    const BidirectionalScene scene = {UNSEEN[i].name, text, SUPPORT_SUM_ONLY, 6, 2};
    return bidirectional_text(&scene);
}

START_TEST(test_unseen)
{
    PictureGroups expected, got;
    char line[64];
    GroupSetup setup = {.groups = 16,
                        .render = {.text = unseen_text(_i, false), .samples = 64, .max_depth = 6, .threads = 1}};
    groups_render(&setup, &expected);
    setup.render.text = unseen_text(_i, true);
    setup.render.seed = 700;
    setup.render.photons = PHOTONS;
    for (int way = 0; way < 2; ++way) {
        if (test_effort() == 1 && way == 1 && _i % 2 == 0)
            continue; /* only in make check-long */
        setup.render.integrator = way == 0 ? integrator_pt() : integrator_mmlt();
        groups_render(&setup, &got);
        snprintf(line, sizeof line, "%s, %s", UNSEEN[_i].name, way == 0 ? "pt" : "mmlt");
        groups_compare(line, &got, &expected, 2, false);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
}
END_TEST

/* ---- whether photons are worth it -------------------------------------------------------------------------------- */

/* A bead far away whose caustic only its own image shows. */
#define FAR_BEAD SMOOTH_GLASS "AttributeBegin Translate -3 -0.9 3 Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n"

static const struct {
    const char *name, *text;
    unsigned photons;
    bool kept;
} WORTH[] = {
    {"under glass", UNDER_WATER(SPARK) PANE, PHOTONS_DEFAULT, true},
    {"bead", BD_BEGIN BD_GREY BD_FLOOR BALL_LAMP("0.1", "300") FAR_BEAD, PHOTONS_DEFAULT, false},
    {"bead, asked for", BD_BEGIN BD_GREY BD_FLOOR BALL_LAMP("0.1", "300") FAR_BEAD, PHOTONS, true},
    {"bead, point light", BD_BEGIN BD_GREY BD_FLOOR POINT FAR_BEAD, PHOTONS_DEFAULT, true},
};
#define WORTH_COUNT (int)(sizeof WORTH / sizeof WORTH[0])

START_TEST(test_worth)
{
    RenderedImage image;
    const RenderSetup setup = {.text = WORTH[_i].text,
                               .samples = 1,
                               .max_depth = 6,
                               .threads = 1,
                               .width = 96,
                               .height = 96,
                               .photons = WORTH[_i].photons,
                               .integrator = integrator_mmlt()};
    fixture_render(&setup, &image);
    ck_assert_msg((image.result.photons > 0) == WORTH[_i].kept, "%s: %u photons", WORTH[_i].name, image.result.photons);
    fixture_destroy(&image);
}
END_TEST

/* ---- the photons that are found ----------------------------------------------------------------------------------- */

/* A bead that one of some two thousand light subpaths meets has as many photons as are wanted. */
START_TEST(test_found)
{
    static const char *const LIGHTS[] = {POINT, BALL_LAMP("0.1", "300"), DISTANT, WIDE_SUN};
    for (size_t i = 0; i < sizeof LIGHTS / sizeof LIGHTS[0]; ++i) {
        char text[4096];
        snprintf(text, sizeof text, BD_BEGIN BD_GREY BD_FLOOR "%s" SMOOTH_GLASS LITTLE_BEAD, LIGHTS[i]);
        const BidirectionalScene scene = {"bead", text, SUPPORT_SUM_ONLY, 6, 2};
        const RenderSetup setup = {.text = bidirectional_text(&scene), .samples = 1, .threads = 1, .photons = 32768};
        RenderedImage image;
        fixture_render(&setup, &image);
        printf("light %zu: %u photons\n", i, image.result.photons);
        ck_assert_uint_gt(image.result.photons, 28000);
        fixture_destroy(&image);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("caustic");
    suite_add_tcase(suite, photons_case());
    suite_add_tcase(suite, search_case());
    TCase *pictures = tcase_create("pictures");
    tcase_add_unchecked_fixture(pictures, bidirectional_files_make, bidirectional_files_remove);
    tcase_set_timeout(pictures, 300);
    tcase_add_test(pictures, test_found);
    tcase_add_loop_test(pictures, test_worth, 0, WORTH_COUNT);
    tcase_add_loop_test(pictures, test_same, 0, SCENE_COUNT);
    tcase_add_test(pictures, test_small_lamp);
    tcase_set_tags(pictures, "pictures");
    suite_add_tcase(suite, pictures);
    TCase *unseen = tcase_create("unseen");
    tcase_add_unchecked_fixture(unseen, bidirectional_files_make, bidirectional_files_remove);
    tcase_set_timeout(unseen, 300);
    tcase_add_loop_test(unseen, test_unseen, 0, UNSEEN_COUNT);
    tcase_set_tags(unseen, "pictures");
    suite_add_tcase(suite, unseen);
    return test_run(suite);
}
