/* Shading normals: bump maps, normal maps and vertex normals under an oblique light. */
#include "support/analytic.h"
#include "support/test_files.h"

static void map_make(void)
{
    test_folder_make();
    analytic_map_make(test_path("grey.pfm"), true);
}

static double height(double u, double v)
{
    return analytic_map_at(u, v, 0, "repeat");
}

/* An oblique light, L = pi from the direction (0.48, 0.6, 0.64). */
#define SLANTING                                                                                                       \
    "LightSource \"distant\" \"rgb L\" [ 3.14159265 3.14159265 3.14159265 ] \"point3 from\" [ 0.48 0.6 0.64 ] "        \
    "\"point3 to\" [ 0 0 0 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] "

static double lit(double x, double y, double z)
{
    return fmax(0.0, (0.48 * x + 0.6 * y + 0.64 * z) / sqrt(x * x + y * y + z * z));
}

/* Finite differences in double of the height 0.2 map(u, v); `context`: the sign of the heights. */
static double bump_radiance(const void *context, double u, double v, int channel)
{
    (void)channel;
    const double step = 1e-6, scale = *(const double *)context * 0.1 / step;
    return lit(scale * (height(u - step, v) - height(u + step, v)), scale * (height(u, v - step) - height(u, v + step)),
               1.0);
}

/* The height 0.2 map(u, v) over the square: normal (-dh/dx, -dh/dy, 1). ReverseOrientation negates the heights, as in
 * pbrt. */
START_TEST(test_bump)
{
    RenderedImage image;
    const double sign = _i ? -1.0 : 1.0;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE
                     "Texture \"grey\" \"float\" \"imagemap\" \"string filename\" \"%s\" \"float scale\" 0.2\n" SLANTING
                     "\"texture displacement\" \"grey\"\n%s " ANALYTIC_SQUARE,
                     16, 16, test_path("grey.pfm"), _i ? "ReverseOrientation" : "");
    analytic_compare(&image, bump_radiance, &sign, 1e-3);
    fixture_destroy(&image);
}
END_TEST

/* For the vertex normals below, which are normalised first. */
static double vertex_radiance(const void *context, double u, double v, int channel)
{
    (void)context;
    (void)channel;
    double low = 1.0 / sqrt(1.25), high = 1.0 / sqrt(1.41), z = (1.0 - v) * low + v * high;
    return lit(0.5 * (1.0 - 2.0 * u) * z, v * 0.4 * high, z);
}

/* The interpolated and normalised vertex normal, on either side. */
START_TEST(test_vertex_normals)
{
    RenderedImage image;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE SLANTING
                     "%s Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] "
                     "\"normal N\" [ .5 0 1  -.5 0 1  .5 .4 1  -.5 .4 1 ]\n",
                     8, 8, _i ? "ReverseOrientation" : "");
    analytic_compare(&image, vertex_radiance, NULL, 1e-4);
    fixture_destroy(&image);
}
END_TEST

/* Texels (n + 1) / 2 in the frame of dp/du, n x dp/du and n. */
START_TEST(test_normal_map)
{
    RenderedImage image;
    float normals[3 * ANALYTIC_MAP_TEXELS];
    for (int i = 0; i < ANALYTIC_MAP_TEXELS; ++i) {
        normals[3 * i] = 0.2f + 0.6f * analytic_map[3 * i];
        normals[3 * i + 1] = 0.8f - 0.6f * analytic_map[3 * ((5 * i + 1) % ANALYTIC_MAP_TEXELS)];
        normals[3 * i + 2] = 1.0f;
    }
    analytic_write_pfm(test_path("normals.pfm"), ANALYTIC_MAP_WIDTH, ANALYTIC_MAP_HEIGHT, normals);
    analytic_picture(&image, 1, 2, ANALYTIC_FROM_ABOVE SLANTING "\"string normalmap\" \"%s\"\n%s " ANALYTIC_SQUARE,
                     ANALYTIC_MAP_WIDTH * 3, ANALYTIC_MAP_HEIGHT * 3, test_path("normals.pfm"),
                     _i ? "ReverseOrientation" : "");
    for (int y = 0; y < ANALYTIC_MAP_HEIGHT; ++y)
        for (int x = 0; x < ANALYTIC_MAP_WIDTH; ++x) {
            const float *n = normals + 3 * (y * ANALYTIC_MAP_WIDTH + x);
            double local[3];
            for (int c = 0; c < 3; ++c)
                local[c] = 2.0 * (double)n[c] - 1.0;
            /* With n = -z the frame is x, -y, -z, and the back side is lit. */
            TEST_NEAR(analytic_pixel(&image, 3 * x + 1, 3 * y + 1, 0),
                      lit(_i ? -local[0] : local[0], local[1], local[2]), 1e-4);
        }
    fixture_destroy(&image);
}
END_TEST

TCase *analytic_bumps_case(void)
{
    TCase *tcase = tcase_create("bumps");
    tcase_set_timeout(tcase, 120);
    tcase_add_checked_fixture(tcase, map_make, test_folder_remove);
    tcase_add_loop_test(tcase, test_bump, 0, 2);
    tcase_add_loop_test(tcase, test_vertex_normals, 0, 2);
    tcase_add_loop_test(tcase, test_normal_map, 0, 2);
    return tcase;
}
