/* Textures in rendered images: images, mappings, expressions, encodings and alpha. */
#include "image/png_write.h"
#include "support/analytic.h"
#include "support/test_files.h"

static void map_make(void)
{
    test_folder_make();
    analytic_map_make(test_path("map.pfm"), false);
}

/* ---- images ------------------------------------------------------------------------------------------------------ */

static double texel_at(const void *context, double u, double v, int channel)
{
    (void)context;
    int x = (int)(u * ANALYTIC_MAP_WIDTH), y = (int)((1.0 - v) * ANALYTIC_MAP_HEIGHT);
    return (double)analytic_map[3 * (y * ANALYTIC_MAP_WIDTH + x) + channel];
}

/* Texels appear as in the file, the first row on top (v = 1). */
START_TEST(test_orientation)
{
    RenderedImage image;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE ANALYTIC_OVERHEAD
                     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" "
                     "\"string filter\" \"point\"\n"
                     "Material \"diffuse\" \"texture reflectance\" \"t\"\n" ANALYTIC_SQUARE,
                     12, 12, test_path("map.pfm"));
    analytic_compare(&image, texel_at, NULL, 1e-5);
    fixture_destroy(&image);
}
END_TEST

/* `context`: the wrap mode. */
static double placed_image(const void *context, double u, double v, int channel)
{
    return analytic_map_at(2.3 * u - 0.4, -1.7 * v + 1.1, channel, context);
}

START_TEST(test_bilinear)
{
    static const char *const WRAPS[] = {"repeat", "clamp", "black"};
    RenderedImage image;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE ANALYTIC_OVERHEAD
                     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" \"string wrap\" \"%s\" "
                     "\"float uscale\" 2.3 \"float vscale\" -1.7 \"float udelta\" -0.4 \"float vdelta\" 1.1\n"
                     "Material \"diffuse\" \"texture reflectance\" \"t\"\n" ANALYTIC_SQUARE,
                     40, 40, test_path("map.pfm"), WRAPS[_i]);
    analytic_compare(&image, placed_image, WRAPS[_i], 5e-5);
    fixture_destroy(&image);
}
END_TEST

/* (u, v) are the world's x and y. */
static double planar_image(const void *context, double u, double v, int channel)
{
    (void)context;
    return analytic_map_at(0.1 + 3.0 * (v - 0.5) / 4.0, 0.2 + (u - 0.25) / 2.0, channel, "repeat");
}

/* Planar mapping, in the space in which the texture is defined. */
START_TEST(test_planar)
{
    RenderedImage image;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE ANALYTIC_OVERHEAD
                     "AttributeBegin Translate 0.25 0.5 0 Scale 2 4 1\n"
                     "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" \"string mapping\" \"planar\" "
                     "\"vector3 v1\" [ 0 3 0 ] \"vector3 v2\" [ 1 0 0 ] \"float udelta\" 0.1 \"float vdelta\" 0.2\n"
                     "AttributeEnd Material \"diffuse\" \"texture reflectance\" \"t\"\n" ANALYTIC_SQUARE,
                     16, 16, test_path("map.pfm"));
    analytic_compare(&image, planar_image, NULL, 5e-5);
    fixture_destroy(&image);
}
END_TEST

/* pbrt's checkerboard of 4 x 2 squares: whether (u, v) shows the first texture. */
static bool first_square(double u, double v)
{
    return ((int)floor(4.0 * u) + (int)floor(2.0 * v)) % 2 == 0;
}

static double mixed_image(const void *context, double u, double v, int channel)
{
    (void)context;
    double here = analytic_map_at(u, v, channel, "repeat");
    return 0.7 * 0.6 * here + 0.3 * (1.0 - here) * (first_square(u, v) ? 0.25 : 1.0);
}

/* scale, mix, checkerboard and invert, computed by hand. */
START_TEST(test_expressions)
{
    RenderedImage image;
    analytic_picture(
        &image, 1, 2,
        ANALYTIC_FROM_ABOVE ANALYTIC_OVERHEAD
        "Texture \"image\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" \"float scale\" 0.6\n"
        "Texture \"negative\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" \"bool invert\" true\n"
        "Texture \"squares\" \"float\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 2 "
        "\"float tex1\" 0.25 \"float tex2\" 1\n"
        "Texture \"scaled\" \"spectrum\" \"scale\" \"texture tex\" \"negative\" \"texture scale\" \"squares\"\n"
        "Texture \"mixed\" \"spectrum\" \"mix\" \"texture tex1\" \"image\" \"texture tex2\" \"scaled\" "
        "\"float amount\" 0.3\n"
        "Material \"diffuse\" \"texture reflectance\" \"mixed\"\n" ANALYTIC_SQUARE,
        16, 16, test_path("map.pfm"), test_path("map.pfm"));
    analytic_compare(&image, mixed_image, NULL, 5e-5);
    fixture_destroy(&image);
}
END_TEST

/* IEC 61966-2-1. */
static double srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* A PNG's byte k is decoded as sRGB, as k / 255 unchanged, or by a power. */
START_TEST(test_encodings)
{
    enum { N = 16 };
    static const char *const ENCODINGS[] = {"sRGB", "linear", "gamma 1.8"};
    float levels[3 * N * N];
    Error error = {0};
    for (int i = 0; i < 3 * N * N; ++i)
        levels[i] = (float)srgb_decode(i / 3 / 255.0);
    ck_assert_msg(png_write(test_path("levels.png"), levels, N, N, 0.0f, &error), "%s", error.message);
    for (int e = 0; e < 3; ++e) {
        RenderedImage image;
        analytic_picture(&image, 1, 2,
                         ANALYTIC_FROM_ABOVE ANALYTIC_OVERHEAD
                         "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" "
                         "\"string encoding\" \"%s\" \"string filter\" \"point\"\n"
                         "Material \"diffuse\" \"texture reflectance\" \"t\"\n" ANALYTIC_SQUARE,
                         N, N, test_path("levels.png"), ENCODINGS[e]);
        for (int i = 0; i < N * N; ++i) {
            double k = i / 255.0, expected = e == 0 ? srgb_decode(k) : e == 1 ? k : pow(k, 1.8);
            TEST_NEAR(analytic_pixel(&image, i % N, i / N, 0), expected, 1e-5);
        }
        fixture_destroy(&image);
    }
}
END_TEST

/* ---- parametrisations -------------------------------------------------------------------------------------------- */

/* pbrt's (u, v) of a point on the plane z = 0 or above it, for the shapes and mappings below; returns false off the
 * shape. */
typedef bool Parametrisation(double x, double y, double *u, double *v);

/* phimax 270 degrees, radii 0.1 and 0.5: v is 1 at the inner radius. */
static bool disk_uv(double x, double y, double *u, double *v)
{
    double r = hypot(x, y), phi = atan2(y, x);
    phi = phi < 0.0 ? phi + 2.0 * M_PI : phi;
    *u = phi / (1.5 * M_PI);
    *v = (0.5 - r) / 0.4;
    return r > 0.1 && r < 0.5 && phi < 1.5 * M_PI;
}

/* zmin -0.25, zmax 0.4 of radius 0.5, seen from above: the open cap shows the inside. v increases upward. */
static bool sphere_uv(double x, double y, double *u, double *v)
{
    double r = hypot(x, y), phi = atan2(y, x);
    *u = (phi < 0.0 ? phi + 2.0 * M_PI : phi) / (2.0 * M_PI);
    double z = sqrt(fmax(0.0, 0.25 - r * r)), low = acos(-0.5), high = acos(0.8);
    *v = (acos(z / 0.5) - low) / (high - low);
    return r < 0.5 && z < 0.4;
}

static bool triangle_uv(double x, double y, double *u, double *v)
{
    /* (-0.5, -0.5), (0.5, -0.5), (0.5, 0.5) without uv: (0,0), (1,0), (1,1). */
    *u = x + 0.5;
    *v = y + 0.5;
    return x > y + 1e-3;
}

/* Polar angle and azimuth of (x, y, 0.3). */
static bool spherical_uv(double x, double y, double *u, double *v)
{
    double phi = atan2(y, x);
    *u = acos(0.3 / sqrt(x * x + y * y + 0.09)) / M_PI;
    *v = (phi < 0.0 ? phi + 2.0 * M_PI : phi) / (2.0 * M_PI);
    return true;
}

/* Azimuth from -x, and height, of (0.3, x, -y). */
static bool cylindrical_uv(double x, double y, double *u, double *v)
{
    *u = (M_PI + atan2(x, 0.3)) / (2.0 * M_PI);
    *v = -y;
    return true;
}

static const struct {
    const char *name, *mapping, *shape;
    Parametrisation *uv;
} PARAMETRISATIONS[] = {
    {"disk", "", "Shape \"disk\" \"float radius\" 0.5 \"float innerradius\" 0.1 \"float phimax\" 270", disk_uv},
    {"sphere", "", "Shape \"sphere\" \"float radius\" 0.5 \"float zmin\" -0.25 \"float zmax\" 0.4", sphere_uv},
    {"triangle", "", "Shape \"trianglemesh\" \"point3 P\" [ -0.5 -0.5 0  0.5 -0.5 0  0.5 0.5 0 ]", triangle_uv},
    {"spherical", "Translate 0 0 -0.3", "Shape \"disk\"", spherical_uv},
    /* The world's (x, y, 0) is the texture's (0.3, x, -y). */
    {"cylindrical", "Rotate 90 0 1 0 Rotate 90 1 0 0 Translate -0.3 0 0", "Shape \"disk\"", cylindrical_uv},
};

/* Uniform illumination, so that slopes do not matter: with one bounce in a white environment, radiance equals
 * reflectance, up to noise. */
START_TEST(test_parametrisation)
{
    enum { N = 12 };
    RenderedImage image;
    const char *mapping = PARAMETRISATIONS[_i].mapping, *name = PARAMETRISATIONS[_i].name;
    analytic_picture(&image, 4096, 2,
                     "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\n"
                     "PixelFilter \"box\" \"float xradius\" 1e-4 \"float yradius\" 1e-4\n"
                     "Scale -1 1 1 LookAt 0 0 5  0 0 0  0 1 0\n"
                     "Camera \"orthographic\" \"float screenwindow\" [ -0.5 0.5 -0.5 0.5 ]\nWorldBegin\n"
                     "LightSource \"infinite\" AttributeBegin %s\nTexture \"t\" \"spectrum\" \"imagemap\" "
                     "\"string filename\" \"%s\" %s%s%s AttributeEnd\n"
                     "Material \"diffuse\" \"texture reflectance\" \"t\" %s",
                     mapping, test_path("map.pfm"), *mapping ? "\"string mapping\" \"" : "", *mapping ? name : "",
                     *mapping ? "\"" : "", PARAMETRISATIONS[_i].shape);
    int seen = 0;
    for (int i = 0; i < N * N; ++i) {
        double u, v, x = (i % N + 0.5) / N - 0.5, y = 0.5 - (i / N + 0.5) / N;
        if (!PARAMETRISATIONS[_i].uv(x, y, &u, &v))
            continue;
        ++seen;
        for (int c = 0; c < 3; ++c)
            ck_assert_msg(fabs(analytic_pixel(&image, i % N, i / N, c) - analytic_map_at(u, v, c, "repeat")) < 0.03,
                          "%s at (%g, %g): %g, not %g", name, x, y, analytic_pixel(&image, i % N, i / N, c),
                          analytic_map_at(u, v, c, "repeat"));
    }
    ck_assert_int_gt(seen, N * N / 4);
    fixture_destroy(&image);
}
END_TEST

/* ---- alpha ------------------------------------------------------------------------------------------------------- */

static double squares_image(const void *context, double u, double v, int channel)
{
    (void)context;
    (void)channel;
    return first_square(u, v) ? 0.0 : 1.0;
}

/* Holes where the texture is 0. */
START_TEST(test_alpha_texture)
{
    RenderedImage image;
    analytic_picture(&image, 1, 2,
                     ANALYTIC_FROM_ABOVE ANALYTIC_OVERHEAD
                     "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 2 "
                     "\"float tex1\" 0 \"float tex2\" 1\n"
                     "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n"
                     "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  1 1 0  0 1 0 ] "
                     "\"point2 uv\" [ 0 0 1 0 1 1 0 1 ] \"integer indices\" [ 0 1 2 0 2 3 ] "
                     "\"texture alpha\" \"holes\"\n",
                     16, 16);
    analytic_compare(&image, squares_image, NULL, 1e-5);
    fixture_destroy(&image);
}
END_TEST

TCase *analytic_textures_case(void)
{
    TCase *tcase = tcase_create("textures");
    tcase_set_timeout(tcase, 120);
    tcase_add_checked_fixture(tcase, map_make, test_folder_remove);
    tcase_add_test(tcase, test_orientation);
    tcase_add_loop_test(tcase, test_bilinear, 0, 3);
    tcase_add_test(tcase, test_planar);
    tcase_add_test(tcase, test_expressions);
    tcase_add_test(tcase, test_encodings);
    tcase_add_loop_test(tcase, test_parametrisation, 0, (int)(sizeof PARAMETRISATIONS / sizeof *PARAMETRISATIONS));
    tcase_add_test(tcase, test_alpha_texture);
    return tcase;
}
