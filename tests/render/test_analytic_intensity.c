/* Goniometric and projection lights: where the texels of their images go, what is beside the image, and "power". */
#include "support/analytic.h"
#include "support/test_files.h"

#define UNIT 0.5 / M_PI /* radiance of the plane per irradiance */

/* Writes a grey image to the folder of the tests; `path` gets its name. */
static void image_write(char path[300], int width, int height, const float *values)
{
    float rgb[3 * 64];
    for (int i = 0; i < 3 * width * height; ++i)
        rgb[i] = values[i / 3];
    snprintf(path, 300, "%s/intensity.pfm", test_folder);
    analytic_write_pfm(path, width, height, rgb);
}

/* Irradiance of the origin's plane from a light 2 above it, moved by (x, y) and turned downwards, with its y axis along
 * the world's -y. */
static double below(double x, double y, const char *light, const char *path)
{
    return analytic_mean(4, 2,
                         ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
                         "Translate %.9g %.9g 2 Rotate 180 1 0 0 LightSource %s \"string filename\" \"%s\"\n",
                         x, y, light, path) /
           (UNIT);
}

/* Intensity 1 times the cosine over the squared distance. */
static double geometry(double x, double y)
{
    double distance2 = 4.0 + x * x + y * y;
    return 2.0 / (distance2 * sqrt(distance2));
}

/* Row 0 is at the light's +y, column 0 at its -x. */
START_TEST(test_projection_image)
{
    static const float VALUES[4] = {1.0f, 2.0f, 3.0f, 4.0f};
    static const double X[4] = {0.5, -0.5, 0.5, -0.5}, Y[4] = {0.5, 0.5, -0.5, -0.5};
    char path[300];
    image_write(path, 2, 2, VALUES);
    for (int i = 0; i < 4; ++i)
        analytic_check("projection of 2 x 2 texels",
                       below(X[i], Y[i], "\"projection\" \"float scale\" 3", path) / geometry(X[i], Y[i]),
                       3.0 * (double)VALUES[i], 1e-3);
    analytic_check("just inside the image", below(1.99, 0.0, "\"projection\"", path) > 0.0, 1.0, 0.0);
    analytic_check("just outside", below(2.01, 0.0, "\"projection\"", path), 0.0, 0.0);
    analytic_check("just outside above", below(0.0, -2.01, "\"projection\"", path), 0.0, 0.0);
}
END_TEST

/* fov is that of the shorter side. */
START_TEST(test_projection_sides)
{
    static const float VALUES[8] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
    const double half = 2.0 * tan(M_PI / 6.0);
    char path[300];
    for (int wide = 0; wide < 2; ++wide) {
        image_write(path, wide ? 4 : 2, wide ? 2 : 4, VALUES);
        const double x = wide ? 2.0 * half : half, y = wide ? half : 2.0 * half;
        analytic_check("inside the longer side", below(0.99 * x, 0.0, "\"projection\" \"float fov\" 60", path),
                       geometry(0.99 * x, 0.0), 1e-3);
        analytic_check("outside", below(1.01 * x, 0.0, "\"projection\" \"float fov\" 60", path), 0.0, 0.0);
        analytic_check("inside the other side", below(0.0, 0.99 * y, "\"projection\" \"float fov\" 60", path),
                       geometry(0.0, 0.99 * y), 1e-3);
        analytic_check("outside", below(0.0, 1.01 * y, "\"projection\" \"float fov\" 60", path), 0.0, 0.0);
    }
}
END_TEST

/* The solid angle of a square pyramid of full angle a is 4 asin(sin(a/2)^2). */
START_TEST(test_power)
{
    static const float VALUES[16] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 2.0f, 2.0f, 1.0f,
                                     1.0f, 2.0f, 2.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f},
                       ONE[1] = {1.0f};
    char path[300];
    image_write(path, 4, 4, VALUES);
    analytic_check("power of a goniometric light", below(0.0, 0.0, "\"goniometric\" \"float power\" 10", path),
                   10.0 / (4.0 * M_PI * 1.25) * geometry(0.0, 0.0), 2e-3);
    image_write(path, 1, 1, ONE);
    analytic_check("power of a narrow projection",
                   below(0.0, 0.0, "\"projection\" \"float fov\" 2 \"float power\" 10", path),
                   10.0 / (4.0 * asin(pow(sin(M_PI / 180.0), 2.0))) * geometry(0.0, 0.0), 2e-3);
}
END_TEST

/* The middle of the map is the light's +y, its corners -y; u goes along x, v along z. */
START_TEST(test_goniometric_image)
{
    static const float VALUES[16] = {5.0f, 1.0f, 1.0f, 5.0f, 3.0f, 2.0f, 2.0f, 4.0f,
                                     3.0f, 2.0f, 2.0f, 4.0f, 5.0f, 6.0f, 6.0f, 5.0f};
    static const struct {
        const char *turn;
        double expected;
    } CASES[] = {
        {"Rotate -89 1 0 0", 2.0}, /* +y to -z */
        {"Rotate 91 1 0 0", 5.0}, /* -y to -z */
        {"Rotate 88 0 1 0", 4.0}, /* +x to -z */
        {"Rotate -92 0 1 0", 3.0}, /* -x to -z */
        {"Rotate 178 1 0 0", 6.0}, /* +z to -z */
        {"Rotate 2 1 0 0", 1.0}, /* -z */
    };
    char path[300];
    image_write(path, 4, 4, VALUES);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i)
        analytic_check(
            CASES[i].turn,
            analytic_mean(4, 2,
                          ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
                          "Translate 0 0 2 %s Rotate 3 0 0 1 LightSource \"goniometric\" \"rgb I\" [ 3 3 3 ] "
                          "\"string filename\" \"%s\"\n",
                          CASES[i].turn, path) /
                (3.0 * geometry(0.0, 0.0) * (UNIT)),
            CASES[i].expected, 1e-3);
}
END_TEST

TCase *analytic_intensity_case(void)
{
    TCase *tcase = tcase_create("intensity images");
    tcase_set_timeout(tcase, 120);
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_projection_image);
    tcase_add_test(tcase, test_projection_sides);
    tcase_add_test(tcase, test_power);
    tcase_add_test(tcase, test_goniometric_image);
    return tcase;
}
