/* Normals that are not the surface's: bump maps, normal maps and vertices' normals under a slanting light. */
#include "analytic.h"
#include "test_files.h"

enum { MAP_WIDTH = 4, MAP_HEIGHT = 3 };

/* Grey heights in 0 ... 0.9. */
static float map[3 * MAP_WIDTH * MAP_HEIGHT];

static void setup(void)
{
    unsigned state = 9;
    test_folder_make();
    for (int i = 0; i < MAP_WIDTH * MAP_HEIGHT; ++i)
        map[3 * i] = map[3 * i + 1] = map[3 * i + 2] = (float)(0.9 * test_random_unit(&state));
    analytic_write_pfm(test_path("grey.pfm"), MAP_WIDTH, MAP_HEIGHT, map);
}

static void teardown(void)
{
    test_folder_remove();
}

static double height(double u, double v)
{
    return analytic_bilinear(map, MAP_WIDTH, MAP_HEIGHT, u, v, 0, "repeat");
}

/* A slanting light L = pi from the direction (0.48, 0.6, 0.64). */
#define SLANTING                                                                                                       \
    "LightSource \"distant\" \"rgb L\" [ 3.14159265 3.14159265 3.14159265 ] \"point3 from\" [ 0.48 0.6 0.64 ] "        \
    "\"point3 to\" [ 0 0 0 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] "

static double lit(double x, double y, double z)
{
    return fmax(0.0, (0.48 * x + 0.6 * y + 0.64 * z) / sqrt(x * x + y * y + z * z));
}

/* The height 0.2 map(u, v) over the square: normal (-dh/dx, -dh/dy, 1). Under ReverseOrientation the heights go down,
 * as in pbrt. Differences in double. */
START_TEST(test_bump)
{
    enum { N = 16 };
    RenderedImage image;
    double u, v;
    const double step = 1e-6, sign = _i ? 1.0 : -1.0;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE
                     "Texture \"grey\" \"float\" \"imagemap\" \"string filename\" \"%s\" \"float scale\" 0.2\n" SLANTING
                     "\"texture displacement\" \"grey\"\n%s " ANALYTIC_SQUARE,
                     N, N, test_path("grey.pfm"), _i ? "ReverseOrientation" : "");
    for (int y = 0; y < N; ++y)
        for (int x = 0; x < N; ++x) {
            analytic_middle(x, y, N, &u, &v);
            double du = 0.1 / step * (height(u + step, v) - height(u - step, v));
            double dv = 0.1 / step * (height(u, v + step) - height(u, v - step));
            TEST_NEAR(analytic_pixel(&image, x, y, 0), lit(sign * du, sign * dv, 1.0), 1e-3);
        }
    fixture_destroy(&image);
}
END_TEST

/* The normal that vertices give, interpolated and normalised, on either side. */
START_TEST(test_vertex_normals)
{
    enum { N = 8 };
    RenderedImage image;
    double u, v;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE SLANTING
                     "%s Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] "
                     "\"normal N\" [ .5 0 1  -.5 0 1  .5 .4 1  -.5 .4 1 ]\n",
                     N, N, _i ? "ReverseOrientation" : "");
    for (int y = 0; y < N; ++y)
        for (int x = 0; x < N; ++x) {
            analytic_middle(x, y, N, &u, &v);
            /* The vertices' normals are made unit first. */
            double low = 1.0 / sqrt(1.25), high = 1.0 / sqrt(1.41), z = (1.0 - v) * low + v * high;
            TEST_NEAR(analytic_pixel(&image, x, y, 0), lit(0.5 * (1.0 - 2.0 * u) * z, v * 0.4 * high, z), 1e-4);
        }
    fixture_destroy(&image);
}
END_TEST

/* Texels (n + 1) / 2 in the frame of dp/du, n x dp/du and n. */
START_TEST(test_normal_map)
{
    RenderedImage image;
    float normals[3 * MAP_WIDTH * MAP_HEIGHT];
    for (int i = 0; i < MAP_WIDTH * MAP_HEIGHT; ++i) {
        normals[3 * i] = 0.2f + 0.6f * map[3 * i];
        normals[3 * i + 1] = 0.8f - 0.6f * map[3 * ((5 * i + 1) % (MAP_WIDTH * MAP_HEIGHT))];
        normals[3 * i + 2] = 1.0f;
    }
    analytic_write_pfm(test_path("normals.pfm"), MAP_WIDTH, MAP_HEIGHT, normals);
    analytic_picture(&image, 1, 2, ANALYTIC_FROM_ABOVE SLANTING "\"string normalmap\" \"%s\"\n%s " ANALYTIC_SQUARE,
                     MAP_WIDTH * 3, MAP_HEIGHT * 3, test_path("normals.pfm"), _i ? "ReverseOrientation" : "");
    for (int y = 0; y < MAP_HEIGHT; ++y)
        for (int x = 0; x < MAP_WIDTH; ++x) {
            const float *n = normals + 3 * (y * MAP_WIDTH + x);
            double local[3];
            for (int c = 0; c < 3; ++c)
                local[c] = 2.0 * (double)n[c] - 1.0;
            /* With n = -z the frame is x, -y, -z, and its back is lit. */
            TEST_NEAR(analytic_pixel(&image, 3 * x + 1, 3 * y + 1, 0),
                      lit(_i ? -local[0] : local[0], local[1], local[2]), 1e-4);
        }
    fixture_destroy(&image);
}
END_TEST

/* ---- alpha --------------------------------------------------------------------------------------------------------- */

TCase *analytic_bumps_case(void)
{
    TCase *tcase = tcase_create("bumps");
    tcase_set_timeout(tcase, 120);
    tcase_add_checked_fixture(tcase, setup, teardown);
    tcase_add_loop_test(tcase, test_bump, 0, 2);
    tcase_add_loop_test(tcase, test_vertex_normals, 0, 2);
    tcase_add_loop_test(tcase, test_normal_map, 0, 2);
    return tcase;
}
