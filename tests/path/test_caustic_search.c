/* The search for caustic photons: how many are found, by what it aims at, and how evenly. */
#include "path/test_caustic.h"

#include "support/bidirectional.h"
#include "support/test_util.h"

#include "backend_cpu.h"
#include "mmlt/paths_estimator.h"
#include "path/photon.h"
#include "render/photon_map.h"
#include "render/photon_worth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDE_FLOOR "Shape \"bilinearmesh\" \"point3 P\" [ -300 -2 -300  300 -2 -300  -300 -2 300  300 -2 300 ]\n"

/* Tiny beads, so many that the spheres of light/aim.h hold several each, which are far apart: the search aims at every
 * bead by itself. */
START_TEST(test_found_among_many)
{
    enum { COUNT = 64 };
    char text[16384] = BD_BEGIN BD_GREY BD_FLOOR "LightSource \"point\" \"point3 from\" [ 0 1 0 ]\n" SMOOTH_GLASS;
    size_t used = strlen(text);
    for (int i = 0; i < COUNT; ++i)
        used +=
            (size_t)snprintf(text + used, sizeof text - used,
                             "AttributeBegin Translate %g %g %g Shape \"sphere\" \"float radius\" 0.002 AttributeEnd\n",
                             0.4 * (i % 8) - 1.4, 0.1 * (i * 3 % 7) - 0.3, 0.4 * (i / 8) - 1.4);
    const RenderSetup setup = {.text = text, .samples = 1, .threads = 1, .photons = 32768};
    RenderedImage image;
    fixture_render(&setup, &image);
    printf("many beads: %u photons\n", image.result.photons);
    ck_assert_uint_gt(image.result.photons, setup.photons / 4);
    fixture_destroy(&image);
}
END_TEST

/* A rendering makes least ... most photons. number: of the case. */
static void photons_check(const RenderSetup *setup, size_t number, unsigned least, unsigned most)
{
    RenderedImage image;
    fixture_render(setup, &image);
    printf("case %zu: %u photons\n", number, image.result.photons);
    ck_assert_uint_ge(image.result.photons, least);
    ck_assert_uint_le(image.result.photons, most);
    fixture_destroy(&image);
}

/* More photons are made only where they predict better: of a bead's caustic those of a small lamp do, those of a large
 * one hit it anyway. */
START_TEST(test_found_more)
{
    static const struct {
        const char *lamp;
        unsigned least, most;
    } cases[] = {{BALL_LAMP("0.8", "4"), 1, 100000}, {BALL_LAMP("0.003", "300000"), 200000, 262144}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[4096];
        snprintf(text, sizeof text, BD_BEGIN BD_GREY BD_FLOOR "%s" SMOOTH_GLASS LITTLE_BEAD, cases[i].lamp);
        const RenderSetup setup = {.text = text, .samples = 1, .threads = 2, .photons = 262144};
        photons_check(&setup, i, cases[i].least, cases[i].most);
    }
}
END_TEST

/* A scene whose photons are made, by a seed. */
typedef struct PhotonScene {
    Scene scene;
    RenderOptions options;
    Film film;
    RenderRun run;
} PhotonScene;

static void photon_scene_open(PhotonScene *opened, const char *text)
{
    const RenderSetup setup = {.text = text, .threads = 2};
    Error error = {0};
    *opened = (PhotonScene){.options = {.samples = 1, .max_depth = 5, .seed = 3}, .film = {.threads = 2}};
    fixture_scene(&setup, &opened->scene);
    opened->run = (RenderRun){.interface = backend_cpu(),
                              .backend = fixture_open(&setup, &opened->scene, &error),
                              .options = &opened->options,
                              .film = &opened->film};
    ck_assert(opened->run.backend != NULL);
    render_frame(integrator_pt(), &opened->scene, &opened->options, &opened->run.frame);
}

static void photon_scene_close(PhotonScene *opened)
{
    opened->run.interface->close(opened->run.backend);
    scene_destroy(&opened->scene);
}

/* The photons of a scene. */
static void photons_make(const char *text, uint count, PhotonLimit limit, void *context, PhotonMap *map)
{
    PhotonScene opened;
    Error error = {0};
    photon_scene_open(&opened, text);
    bool made = photon_map_make(&opened.run, &opened.scene, count, limit, context, map, &error);
    ck_assert_msg(made, "%s", error.message);
    photon_scene_close(&opened);
}

/* A PhotonLimit of 100000; *context: how often it was asked for. */
static bool limit_set(void *context, uint *most, Error *error)
{
    (void)error;
    ++*(int *)context;
    *most = 100000;
    return true;
}

/* What the first few photons bring is asked for once, before there are more, and limits them; not where they are all
 * that there may be, or enough. */
START_TEST(test_limit)
{
    static const struct {
        const char *lamp;
        uint count;
        int asked;
        uint least, most;
    } cases[] = {{BALL_LAMP("0.003", "300000"), 262144, 1, 90000, 170000},
                 {BALL_LAMP("0.003", "300000"), 32768, 0, 32000, 32768},
                 {BALL_LAMP("0.8", "4"), 262144, 0, 1, 100000}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[4096];
        int asked = 0;
        PhotonMap map;
        snprintf(text, sizeof text, BD_BEGIN BD_GREY BD_FLOOR "%s" SMOOTH_GLASS LITTLE_BEAD, cases[i].lamp);
        photons_make(text, cases[i].count, limit_set, &asked, &map);
        printf("case %zu: %u photons\n", i, map.params.count);
        ck_assert_int_eq(asked, cases[i].asked);
        ck_assert_uint_ge(map.params.count, cases[i].least);
        ck_assert_uint_le(map.params.count, cases[i].most);
        photon_map_destroy(&map);
    }
    ck_assert_uint_eq(photon_map_most(655360, 0.06), 655360);
    ck_assert_uint_eq(photon_map_most(655360, 0.04), 81920);
}
END_TEST

#define BALL(radius) "AttributeBegin Translate 0 -0.6 0 Shape \"sphere\" \"float radius\" " radius " AttributeEnd\n"
#define LIT BD_BEGIN BD_GREY BD_FLOOR BALL_LAMP("0.05", "1000")

/* Whether path tracing beside chains draws by the scene's photons at all receivers, if those that no light subpath can
 * serve bring `part` of the light. */
static bool draws_everywhere(PhotonScene *opened, double part, uint depth_kinds)
{
    Film film = {.depth_kinds = depth_kinds};
    PathsEstimator paths;
    Error error = {0};
    opened->run.photons_part = part;
    opened->run.frame.photons = opened->run.photons.params;
    ck_assert(paths_estimator_init(&paths, &opened->run, &film, false, false, NULL, &error));
    paths_estimator_destroy(&paths);
    return paths.frame.photons.everywhere != 0;
}

/* What photons bring at all receivers, and where no light subpath can make the path: of the caustic of a ball of
 * glass only what is seen through the ball, of clay in the ball all, and of a lamp in glass most of the light, but
 * nothing that a light subpath cannot bring. Path tracing beside chains draws by them at all receivers where the second
 * is much of the light, or not little of it and of the first; not with layers by depth. */
START_TEST(test_part)
{
    static const char *const texts[] = {
        LIT SMOOTH_GLASS BALL("0.35"), LIT BALL("0.25") SMOOTH_GLASS BALL("0.35"),
        LIT SMOOTH_GLASS "AttributeBegin Translate 1 2 -1 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n"};
    double part[3], all[3];
    for (int i = 0; i < 3; ++i) {
        PhotonScene opened;
        Error error = {0};
        photon_scene_open(&opened, texts[i]);
        ck_assert(photon_map_make(&opened.run, &opened.scene, 8192, NULL, NULL, &opened.run.photons, &error));
        ck_assert(draws_everywhere(&opened, 0.02, 0) == (i != 2));
        ck_assert(draws_everywhere(&opened, 0.06, 0));
        ck_assert(!draws_everywhere(&opened, 0.06, 1));
        ck_assert(!draws_everywhere(&opened, 0.005, 0));
        ck_assert(photon_map_part(&opened.run, false, &part[i], &error));
        ck_assert(photon_map_part(&opened.run, true, &all[i], &error));
        printf("scene %d: photons bring %.5f, %.5f at all receivers\n", i, part[i], all[i]);
        photon_map_destroy(&opened.run.photons);
        photon_scene_close(&opened);
    }
    ck_assert_double_lt(part[0], 0.001);
    ck_assert_double_gt(all[0], 0.002);
    ck_assert_double_gt(part[1], 0.5 * all[1]);
    ck_assert_double_lt(part[2], 0.01 * all[2]);
    ck_assert_double_gt(all[2], 0.2);
    ck_assert(paths_draw_everywhere(0.06, 1.0));
    ck_assert(paths_draw_everywhere(0.02, 0.06));
    ck_assert(!paths_draw_everywhere(0.02, 0.1));
    ck_assert(!paths_draw_everywhere(0.005, 0.005));
}
END_TEST

/* By default mmlt limits them so: its 147456 photons for so many samples are too many for a bead of which little is
 * seen; not if they are asked for. */
START_TEST(test_default_limit)
{
    static const char text[] =
        BD_BEGIN BD_GREY BD_FLOOR "LightSource \"point\" \"point3 from\" [ 1 2 -1 ]\n" SMOOTH_GLASS LITTLE_BEAD;
    static const struct {
        unsigned photons, least, most;
    } cases[] = {{PHOTONS_DEFAULT, 1, 100000}, {147456, 130000, 147456}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const RenderSetup setup = {.text = text,
                                   .samples = 256,
                                   .max_depth = 4,
                                   .threads = 2,
                                   .width = 96,
                                   .height = 96,
                                   .photons = cases[i].photons,
                                   .integrator = integrator_mmlt()};
        photons_check(&setup, i, cases[i].least, cases[i].most);
    }
}
END_TEST

static int floats_compare(const void *a, const void *b)
{
    const float *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* The median spread of the photons that are less than a distance from the origin. */
static double spread_near(const PhotonMap *map, float distance)
{
    const uint count = map->params.count;
    float *spreads = malloc(count * sizeof *spreads);
    size_t near = 0;
    for (uint i = 0; i < count; ++i) {
        const uint *record = photon_record(map->words, count, i);
        if (vec3_length(photon_vector(record, PHOTON_POINT)) < distance)
            spreads[near++] = word_float(record + PHOTON_SPREAD);
    }
    qsort(spreads, near, sizeof *spreads, floats_compare);
    const double median = near > 0 ? (double)spreads[near / 2] : HUGE_VAL;
    free(spreads);
    return median;
}

/* Most subpaths that arrive become photons, however wide the world or distant the lamp: those of the sun begin far
 * outside, and neighbours in other directions must still meet the bead. Photons close to it predict as well in a
 * wide world, since the grid has small cells there. */
START_TEST(test_wide_world)
{
    static const struct {
        const char *light, *world;
    } cases[] = {
        {"LightSource \"distant\" \"point3 from\" [ 0.3 1 0.2 ]\n", ""},
        {"LightSource \"distant\" \"point3 from\" [ 0.3 1 0.2 ]\n", WIDE_FLOOR},
        {"LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n", ""},
        {"LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n", WIDE_FLOOR},
        {"AttributeBegin Translate 300 1000 200 AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n"
         "Shape \"sphere\" \"float radius\" 3 AttributeEnd\n",
         ""},
    };
    double spreads[sizeof cases / sizeof cases[0]];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[4096];
        PhotonMap map;
        snprintf(text, sizeof text, BD_BEGIN BD_GREY BD_FLOOR "%s%s" SMOOTH_GLASS LITTLE_BEAD, cases[i].light,
                 cases[i].world);
        photons_make(text, 32768, NULL, NULL, &map);
        spreads[i] = spread_near(&map, 4.0f);
        printf("case %zu: %u photons, spread %.5f\n", i, map.params.count, spreads[i]);
        ck_assert_uint_ge(map.params.count, 19000);
        photon_map_destroy(&map);
    }
    ck_assert_double_lt(spreads[1], 1.2 * spreads[0]);
}
END_TEST

/* How many photons are in each cell of the square that is lit through the pane in test_evenly, without its margin. */
static void cells_count(const PhotonMap *map, int side, double *cells)
{
    for (uint i = 0; i < map->params.count; ++i) {
        const uint *point = photon_record(map->words, map->params.count, i) + PHOTON_POINT;
        int x = (int)floor((0.2 + (double)bits_float(point[0])) / 2.4 * side);
        int z = (int)floor((2.2 + (double)bits_float(point[2])) / 2.4 * side);
        if (x >= 0 && x < side && z >= 0 && z < side)
            cells[z * side + x] += 1.0;
    }
}

/* Where light subpaths arrive often enough, photons are independent of each other, without clusters and gaps: of cells
 * beside each other the squares of the differences are the sums, on average. */
START_TEST(test_evenly)
{
    enum { SIDE = 16 };
    static const char text[] =
        BD_BEGIN BD_GREY BD_FLOOR "LightSource \"point\" \"point3 from\" [ 1 2 -1 ]\n" SMOOTH_GLASS
                                  "Shape \"bilinearmesh\" \"point3 P\" [ 0 0.9 -2  2 0.9 -2  0 0.9 0  2 0.9 0 ]\n";
    double cells[SIDE * SIDE] = {0}, squares = 0.0, sum = 0.0;
    PhotonMap map;
    photons_make(text, 32768, NULL, NULL, &map);
    cells_count(&map, SIDE, cells);
    for (int i = 0; i < SIDE * SIDE; i += 2) {
        squares += pow(cells[i] - cells[i + 1], 2.0);
        sum += cells[i] + cells[i + 1];
    }
    printf("%u photons, %.0f in the square, squares of differences %.2f\n", map.params.count, sum, squares / sum);
    ck_assert_double_gt(sum, 20.0 * SIDE * SIDE);
    TEST_NEAR(squares / sum, 1.0, 5.0 * sqrt(2.0 / (SIDE * SIDE / 2)));
    photon_map_destroy(&map);
}
END_TEST

TCase *search_case(void)
{
    TCase *search = tcase_create("search");
    tcase_set_timeout(search, 300);
    tcase_add_test(search, test_found_among_many);
    tcase_add_test(search, test_found_more);
    tcase_add_test(search, test_limit);
    tcase_add_test(search, test_default_limit);
    tcase_add_test(search, test_part);
    tcase_add_test(search, test_wide_world);
    tcase_add_test(search, test_evenly);
    return search;
}
