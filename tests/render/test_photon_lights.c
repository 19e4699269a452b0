/* How photons see lights: their middle and extent, and that what a photon predicts is where the middle of its light is
 * seen. */
#include "support/analytic.h"
#include "support/render_fixture.h"
#include "support/test_files.h"
#include "support/test_util.h"

#include "math/warp.h"
#include "path/photon.h"
#include "render/photon_grid.h"
#include "render/photon_map.h"

#include <math.h>
#include <stdlib.h>

#define HEAD                                                                                                           \
    "LookAt 0 1 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n"                                           \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
#define EMITS "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n"
#define MIRROR                                                                                                         \
    "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ] \"float roughness\" 0\n"                               \
    "Shape \"bilinearmesh\" \"point3 P\" [ -9 0 -9  9 0 -9  -9 0 9  9 0 9 ]\n"

/* The lights of a scene: a smooth mirror y = 0, and `text`. */
static void lights_of(const char *text, Scene *scene, PhotonLights *lights)
{
    char all[4096];
    Error error = {0};
    snprintf(all, sizeof all, HEAD "AttributeBegin\n%sAttributeEnd\n" MIRROR, text);
    const RenderSetup setup = {.text = all, .threads = 1};
    fixture_scene(&setup, scene);
    ck_assert_msg(photon_lights_init(lights, scene, &error), "%s", error.message);
}

static void lights_end(Scene *scene, PhotonLights *lights)
{
    photon_lights_destroy(lights);
    scene_destroy(scene);
}

/* ---- lamps ------------------------------------------------------------------------------------------------------- */

/* A lamp, and the variances of its points along x, y and z as they are seen from one side; at its own point if that is
 * not its middle. */
static const struct {
    const char *text;
    double center[3], variance[3];
    bool own;
} LAMPS[] = {
    {"Translate 1 2 -1\n" EMITS "Shape \"sphere\" \"float radius\" 0.4\n", {1, 2, -1}, {0.04, 0.04, 0.04}, false},
    {"Translate 1 2 -1\n" EMITS "Shape \"disk\" \"float radius\" 0.4\n", {1, 2, -1}, {0.04, 0.04, 0}, false},
    {EMITS "Shape \"bilinearmesh\" \"point3 P\" [ -1 2 -.5  1 2 -.5  -1 2 .5  1 2 .5 ]\n",
     {0, 2, 0},
     {1.0 / 3.0, 0, 1.0 / 12.0},
     false},
    {EMITS "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  2 1 3 ] \"point3 P\" [ -1 2 -.5  1 2 -.5  -1 2 .5  1 2 "
           ".5 ]\n",
     {0, 2, 0},
     {1.0 / 3.0, 0, 1.0 / 12.0},
     false},
    /* a cube: of its surface each axis has (1 / 3) / 4 + (2 / 3) / 12 */
    {"Translate 0 2 0\n" EMITS
     "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 2 1 3  4 6 5 5 6 7  0 4 1 1 4 5  2 3 6 6 3 7  0 2 4 4 2 6  1 "
     "5 3 3 5 7 ] \"point3 P\" [ -.5 -.5 -.5  .5 -.5 -.5  -.5 .5 -.5  .5 .5 -.5  -.5 -.5 .5  .5 -.5 .5  -.5 .5 .5  .5 "
     ".5 .5 ]\n",
     {0, 2, 0},
     {0.75 * 5.0 / 36.0, 0.75 * 5.0 / 36.0, 0.75 * 5.0 / 36.0},
     false},
    /* two squares far apart: a disc of their area around the ray's own point */
    {EMITS
     "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 2 1 3  4 5 6 6 5 7 ] \"point3 P\" [ -3 2 0  -2 2 0  -3 2 "
     "1  -2 2 1  2 2 0  3 2 0  2 2 1  3 2 1 ]\n",
     {0, 0, 0},
     {0.25 * 2.0 / M_PI, 0.25 * 2.0 / M_PI, 0.25 * 2.0 / M_PI},
     true},
};

static double along(const double variance[3], Vec3 a, Vec3 b)
{
    return variance[0] * (double)(a.x * b.x) + variance[1] * (double)(a.y * b.y) + variance[2] * (double)(a.z * b.z);
}

START_TEST(test_lamp)
{
    static const Vec3 RAYS[] = {{0.0f, -1.0f, 0.0f}, {0.6f, -0.8f, 0.0f}, {-0.48f, -0.6f, 0.64f}};
    const double *variance = LAMPS[_i].variance, *center = LAMPS[_i].center;
    const Vec3 own = vec3(0.3f, 2.0f, 0.1f);
    Scene scene;
    PhotonLights lights;
    lights_of(LAMPS[_i].text, &scene, &lights);
    for (size_t k = 0; k < sizeof RAYS / sizeof RAYS[0]; ++k) {
        const Frame frame = frame_from_normal(RAYS[k]);
        const Vec3 axes[2] = {frame.t, frame.b};
        const LightLook look = photon_light_look(&lights, 0, own, axes);
        const double most = fmax(variance[0], variance[1]),
                     expected[3] = {along(variance, axes[0], axes[0]), along(variance, axes[0], axes[1]),
                                    along(variance, axes[1], axes[1])};
        for (int i = 0; i < 3; ++i)
            TEST_NEAR(look.covariance[i], expected[i], 0.08 * most);
        TEST_NEAR(look.center.x, LAMPS[_i].own ? (double)own.x : center[0], 0.02);
        TEST_NEAR(look.center.y, LAMPS[_i].own ? (double)own.y : center[1], 0.02);
        TEST_NEAR(look.center.z, LAMPS[_i].own ? (double)own.z : center[2], 0.02);
    }
    lights_end(&scene, &lights);
}
END_TEST

/* ---- suns -------------------------------------------------------------------------------------------------------- */

/* Writes an image with discs of these radii, in radians, around +z and +x on a dark sky. */
static void suns_write(const char *name, double around_z, double around_x)
{
    enum { SIDE = 256 };
    float *rgb = calloc((size_t)3 * SIDE * SIDE, sizeof *rgb);
    ck_assert_ptr_nonnull(rgb);
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const int x = i % SIDE, y = i / SIDE;
        Vec3 d = octahedral_to_sphere(vec2(((float)x + 0.5f) / (float)SIDE, ((float)y + 0.5f) / (float)SIDE));
        const float light = (double)d.z > cos(around_z) ? 5000.0f : (double)d.x > cos(around_x) ? 200.0f : 0.1f;
        for (int c = 0; c < 3; ++c)
            rgb[3 * i + c] = light;
    }
    analytic_write_pfm(test_path(name), SIDE, SIDE, rgb);
    free(rgb);
}

/* A ray from anywhere in a sun is of its middle, and so large; not one of the sky, nor of a sun too large to be a
 * spot. */
START_TEST(test_sun)
{
    const double radii[2] = {0.04, 0.3};
    char text[512];
    Scene scene;
    PhotonLights lights;
    test_folder_make();
    suns_write("suns.pfm", radii[0], radii[1]);
    snprintf(text, sizeof text, "LightSource \"infinite\" \"string filename\" \"%s\"\n", test_path("suns.pfm"));
    lights_of(text, &scene, &lights);
    test_folder_remove();
    ck_assert_uint_eq(lights.spot_count, 1);
    const Vec3 middle = lights.spots[0].direction; /* pbrt's sky, seen from outside: an axis of the world */
    TEST_NEAR(fmax(fmax(fabs((double)middle.x), fabs((double)middle.y)), fabs((double)middle.z)), 1.0, 1e-4);
    const Frame frame = frame_from_normal(middle);
    const Vec3 axes[2] = {frame.t, frame.b};
    for (int k = 0; k < 8; ++k) {
        const double angle = k * M_PI / 4.0, off = k % 2 == 0 ? 0.5 * radii[0] : 0.9 * radii[0];
        const Vec3 step =
            vec3_add(vec3_scale(frame.t, (float)(off * cos(angle))), vec3_scale(frame.b, (float)(off * sin(angle))));
        const LightLook look = photon_light_look(&lights, 0, vec3_normalize(vec3_add(middle, step)), axes);
        TEST_NEAR(vec3_length(vec3_sub(look.center, middle)), 0.0, 1e-6);
        TEST_NEAR(look.covariance[0], 0.25 * radii[0] * radii[0], 0.1 * 0.25 * radii[0] * radii[0]);
        TEST_NEAR(look.covariance[1], 0.0, 1e-9);
        TEST_NEAR(look.covariance[2], look.covariance[0], 1e-9);
        const Vec3 sky = vec3_normalize(vec3_add(middle, vec3_scale(step, 3.0f)));
        TEST_NEAR(vec3_length(vec3_sub(photon_light_look(&lights, 0, sky, axes).center, sky)), 0.0, 1e-6);
    }
    lights_end(&scene, &lights);
}
END_TEST

/* A sun of four texels is one spot, whatever its corners are. */
START_TEST(test_square_sun)
{
    char text[512];
    Scene scene;
    PhotonLights lights;
    test_folder_make();
    suns_write("square.pfm", 0.013, 0.0);
    snprintf(text, sizeof text, "LightSource \"infinite\" \"string filename\" \"%s\"\n", test_path("square.pfm"));
    lights_of(text, &scene, &lights);
    test_folder_remove();
    ck_assert_uint_eq(lights.spot_count, 1);
    const Vec3 middle = lights.spots[0].direction;
    TEST_NEAR(fmax(fmax(fabs((double)middle.x), fabs((double)middle.y)), fabs((double)middle.z)), 1.0, 1e-5);
    lights_end(&scene, &lights);
}
END_TEST

/* ---- what photons predict ---------------------------------------------------------------------------------------- */

/* Follows a subpath by way of the mirror y = 0 to the plane y = 3. */
static PhotonPath reflected(PhotonPath path)
{
    Vec3 d = path.first, at = vec3_mad(path.origin, -path.origin.y / d.y, d);
    path.last = vec3(d.x, -d.y, d.z);
    path.point = vec3_mad(at, 3.0f / path.last.y, path.last);
    path.vertices = 1;
    return path;
}

/* The photon of a lamp's point predicts the direction towards the image of its middle, for places around it, too, and
 * how far the lamp's points are from that. */
START_TEST(test_predicted)
{
    static const char *const SHAPES[] = {
        "Shape \"sphere\" \"float radius\" 0.2\n",
        "Shape \"bilinearmesh\" \"point3 P\" [ -.2 0 -.1  -.2 0 .1  .2 0 -.1  .2 0 .1 ]\n"};
    /* frame_from_normal turns where z changes its sign, as the second direction's does */
    static const Vec3 FIRST[] = {{0.3f, -1.0f, 0.2f}, {0.3f, -1.0f, 0.001f}};
    const Vec3 image = vec3(0.5f, -2.0f, -1.0f);
    char text[512];
    Scene scene;
    PhotonLights lights;
    snprintf(text, sizeof text, "Translate 0.5 2 -1\n" EMITS "%s", SHAPES[_i]);
    lights_of(text, &scene, &lights);
    for (int k = 0; k < 16; ++k) {
        const float angle = (float)(k * M_PI / 4.0);
        const Vec3 first = vec3_normalize(FIRST[k / 8]);
        const Vec3 moved = vec3(0.15f * cosf(angle), _i == 0 ? -0.1f : 0.0f, 0.08f * sinf(angle));
        const PhotonPath path =
            reflected((PhotonPath){.origin = vec3_add(vec3(0.5f, 2.0f, -1.0f), moved), .first = first});
        PhotonPath neighbours[PHOTON_NEIGHBOURS];
        PhotonRecord record;
        for (uint n = 0; n < PHOTON_NEIGHBOURS; ++n)
            neighbours[n] = reflected(photon_neighbour(&lights, &path, n));
        ck_assert(photon_differences(&lights, &path, neighbours, &record));
        const Vec3 to_image = vec3_sub(image, record.point);
        const double distance = (double)vec3_length(to_image), none[2] = {0.0, 0.0};
        double slopes[2], seen[2];
        /* to first order: the lamp is 0.17 / 5 wide seen from there */
        TEST_NEAR(vec3_length(vec3_sub(record.direction, vec3_normalize(to_image))), 0.0, 2e-3);
        const Vec3 place = vec3_add(record.point, vec3(0.2f, 0.0f, -0.1f));
        photon_predict(&record, place, none, slopes);
        ck_assert(photon_slopes(record.direction, vec3_normalize(vec3_sub(image, place)), seen));
        TEST_NEAR(hypot(slopes[0] - seen[0], slopes[1] - seen[1]), 0.0, 4e-3);
        /* the light's points move the direction by 1 / distance, in any frame */
        const double *m = record.by_light;
        TEST_NEAR(fabs(m[0] * m[3] - m[1] * m[2]) * distance * distance, 1.0, 0.1);
        TEST_NEAR(m[0] * m[0] + m[2] * m[2], m[1] * m[1] + m[3] * m[3], 0.1 / (distance * distance));
    }
    lights_end(&scene, &lights);
}
END_TEST

/* A lobe covers the slopes of the light's points, whatever their derivatives. */
START_TEST(test_spread)
{
    enum { COUNT = 64 };
    static const double by_light[4] = {0.3, -0.1, 0.2, 0.4}, extent[3] = {0.04, 0.01, 0.02};
    PhotonRecord each[COUNT];
    PhotonRecords records = {each, COUNT, 2};
    const PhotonLights lights = {0};
    PhotonMap map = {0};
    Error error = {0};
    double missed, slopes[3] = {0};
    for (int i = 0; i < COUNT; ++i) {
        each[i] = (PhotonRecord){.number = (uint)i,
                                 .light = NONE,
                                 .vertices = 1,
                                 .point = vec3(0.01f * (float)(i % 8), 0.0f, 0.01f * (float)(i >> 3)),
                                 .direction = vec3(0.0f, 1.0f, 0.0f),
                                 .axes = {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}};
        memcpy(each[i].by_light, by_light, sizeof by_light);
        memcpy(each[i].extent, extent, sizeof extent);
    }
    ck_assert_msg(photon_grid_make(&records, &lights, &map, &missed, &error), "%s", error.message);
    TEST_NEAR(missed, 0.0, 1e-3);
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
            double e = i == j ? extent[2 * i] : extent[1];
            slopes[0] += by_light[i] * e * by_light[j];
            slopes[1] += by_light[i] * e * by_light[2 + j];
            slopes[2] += by_light[2 + i] * e * by_light[2 + j];
        }
    const double *spread = each[10].spread, part = spread[0] * spread[0] / slopes[0];
    ck_assert_double_gt(part, 1.0); /* an even disc has the points up to twice their deviation */
    ck_assert_double_lt(part, 4.0);
    TEST_NEAR(spread[0] * spread[1], part * slopes[1], 1e-6);
    TEST_NEAR(spread[1] * spread[1] + spread[2] * spread[2], part * slopes[2], 1e-6);
    photon_map_destroy(&map);
}
END_TEST

/* Two photons that agree by chance are no evidence: of three, two of the same direction, the error is that of the
 * third, whose slope differs. One alone has nothing to agree with. */
START_TEST(test_agreement)
{
    const Vec3 up = vec3(0.0f, 0.0f, 1.0f), aside = vec3_normalize(vec3(0.1f, 0.0f, 1.0f));
    PhotonRecord each[3];
    PhotonRecords records = {each, 3, 1};
    const PhotonLights lights = {0};
    PhotonMap map = {0};
    Error error = {0};
    double missed;
    for (int i = 0; i < 3; ++i)
        each[i] = (PhotonRecord){.number = (uint)i,
                                 .light = 0,
                                 .vertices = 1,
                                 .direction = i == 2 ? aside : up,
                                 .axes = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}};
    ck_assert_msg(photon_grid_make(&records, &lights, &map, &missed, &error), "%s", error.message);
    for (int i = 0; i < 3; ++i)
        TEST_NEAR(each[i].spread[0], 0.1, 1e-3);
    photon_map_destroy(&map);
    records.count = 1;
    ck_assert_msg(photon_grid_make(&records, &lights, &map, &missed, &error), "%s", error.message);
    TEST_NEAR(each[0].spread[0], 1.0, 1e-6);
    photon_map_destroy(&map);
}
END_TEST

/* The grid is a little larger than the photons' box. Directories find the photons of cells of any level that a
 * search of the whole group finds, of three lights, in no more words than there are photons. */
START_TEST(test_directories)
{
    enum { COUNT = 5000 };
    static PhotonRecord each[COUNT];
    PhotonRecords records = {each, COUNT, 2};
    const PhotonLights lights = {0};
    PhotonMap map = {0};
    Error error = {0};
    double missed;
    unsigned state = 3;
    for (int i = 0; i < COUNT; ++i) {
        const double x = test_random_unit(&state), y = test_random_unit(&state), z = test_random_unit(&state);
        each[i] = (PhotonRecord){.number = (uint)i,
                                 .light = (uint)i % 3, /* of lights without extent all lobes are kept */
                                 .vertices = 1,
                                 .point = vec3((float)(x * x), (float)y, (float)(0.1 * z * z)),
                                 .direction = vec3(0.0f, 0.0f, 1.0f),
                                 .axes = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}};
    }
    ck_assert_msg(photon_grid_make(&records, &lights, &map, &missed, &error), "%s", error.message);
    ck_assert_uint_gt(map.params.directory_level, 1);
    ck_assert_uint_le(map.word_count, (PHOTON_CODE_WORDS + PHOTON_WORDS + 1) * (size_t)COUNT);
    ck_assert_uint_eq(map.params.first[3], COUNT);
    /* The photons' box is about the unit square; rounding puts places on its edge outside. */
    ck_assert(photon_code(map.params, vec3(-1e-4f, -1e-4f, -1e-4f)) != PHOTON_OUTSIDE);
    ck_assert(photon_code(map.params, vec3(1.0001f, 1.0001f, 0.1f)) != PHOTON_OUTSIDE);
    ck_assert(photon_code(map.params, vec3(0.5f, 1.1f, 0.1f)) == PHOTON_OUTSIDE);
    int occupied = 0;
    for (uint i = 0; i < 3000; ++i) {
        const uint group = i % 3, shift = 3 * (i / 3 % (PHOTON_LEVELS + 1));
        const ulong near = photon_code_at(map.words, COUNT * i / 3000), bit = (ulong)1 << i % (3 * PHOTON_LEVELS);
        const ulong codes[] = {near, near ^ bit, near - 1}, code = codes[i / 63 % 3];
        const uint *of_group = map.params.first + group;
        uint first, last, expected_first = of_group[0], number = 0, position = of_group[0];
        for (uint k = of_group[0]; k < of_group[1]; ++k) {
            const ulong other = photon_code_at(map.words, k);
            position += other < code;
            expected_first += other >> shift < code >> shift;
            number += other >> shift == code >> shift;
        }
        photon_cell_find(map.params, map.words, group, code >> shift << shift, shift, &first, &last);
        ck_assert_uint_eq(last - first, number);
        ck_assert(first == expected_first || number == 0);
        occupied += number > 0;
        ck_assert_uint_eq(photon_position(map.params, map.words, group, code), position);
    }
    ck_assert_int_gt(occupied, 1000);
    photon_map_destroy(&map);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("photon lights");
    TCase *lights = tcase_create("lights");
    tcase_add_loop_test(lights, test_lamp, 0, (int)(sizeof LAMPS / sizeof LAMPS[0]));
    tcase_add_test(lights, test_sun);
    tcase_add_test(lights, test_square_sun);
    tcase_add_loop_test(lights, test_predicted, 0, 2);
    tcase_add_test(lights, test_spread);
    tcase_add_test(lights, test_agreement);
    tcase_add_test(lights, test_directories);
    suite_add_tcase(suite, lights);
    return test_run(suite);
}
