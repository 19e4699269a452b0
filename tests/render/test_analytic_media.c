/* Participating media against closed forms and numerical integrals, by every integrator that renders paths of any
 * length. */
#include "support/analytic.h"

#include "render/integrator.h"

#include <string.h>

typedef struct MediaCase {
    const char *name; /* of the integrator */
    const Integrator *(*integrator)(void);
} MediaCase;

static const MediaCase CASES[] = {{"pt", integrator_pt}, {"ibpt", integrator_ibpt}, {"bdpt", integrator_bdpt}};
enum { CASE_COUNT = 3 };

static void media_color(double mean[3], const Integrator *integrator, unsigned samples, int depth, const char *text)
{
    RenderSetup setup = {.text = text, .samples = samples, .max_depth = depth, .seed = 11, .integrator = integrator};
    RenderedImage image;
    fixture_render(&setup, &image);
    int pixels = image.width * image.height;
    for (int c = 0; c < 3; ++c) {
        mean[c] = 0.0;
        for (int i = 0; i < pixels; ++i)
            mean[c] += (double)image.rgb[3 * i + c] / pixels;
    }
    fixture_destroy(&image);
}

static void media_check(const MediaCase *by, const char *what, const double got[3], const double expected[3],
                        double tolerance)
{
    for (int c = 0; c < 3; ++c) {
        char name[96];
        snprintf(name, sizeof name, "%s, %s, channel %d", what, by->name, c);
        analytic_check(name, got[c], expected[c], tolerance);
    }
}

/* Looks along z, from z = -4, at a lamp of radiance 1 at z = 3. */
#define ALONG_Z(camera)                                                                                                \
    ANALYTIC_FILM                                                                                                      \
    "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.25 0.5 1 ] \"float sigma_s\" 0\n"     \
    "\"float scale\" 2\n" camera "LookAt 0 0 -4  0 0 0  0 1 0\n"                                                       \
    "Camera \"orthographic\" \"float screenwindow\" [ -0.1 0.1 -0.1 0.1 ]\nWorldBegin\n"
#define LAMP                                                                                                           \
    "AttributeBegin MediumInterface \"\" Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"                         \
    "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] \"bool twosided\" true Translate 0 0 3\n"                         \
    "Shape \"bilinearmesh\" \"point3 P\" [ -5 -5 0  5 -5 0  -5 5 0  5 5 0 ] AttributeEnd\n"
/* Two planes, at z = 0 and 1, whose normals point away from each other. */
#define SLAB                                                                                                           \
    "Shape \"bilinearmesh\" \"point3 P\" [ -4 -4 1  4 -4 1  -4 4 1  4 4 1 ]\n"                                         \
    "ReverseOrientation Shape \"bilinearmesh\" \"point3 P\" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]\n"

/* A slab of depth 1 with optical depths 0.5, 1 and 2 between the camera and a lamp. */
START_TEST(test_slab)
{
    static const double EXPECTED[3] = {0.60653066, 0.36787944, 0.13533528};
    for (int i = 0; i < CASE_COUNT; ++i) {
        double mean[3];
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z("") LAMP "MediumInterface \"ink\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "slab", mean, EXPECTED, 1e-5);
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z("") LAMP "MediumInterface \"\" \"ink\" Material \"interface\" ReverseOrientation\n" SLAB);
        media_check(&CASES[i], "slab from outside", mean, EXPECTED, 1e-5);
    }
}
END_TEST

/* Slabs of grids, whose samples lie at z = 1/4 and 3/4: absorption that goes from 2 at the first to 6 at the second
 * and, beyond them, half of the way to 0; and the same with other colours. */
#define NINE(sample) sample sample sample sample sample sample sample sample sample
#define GRID_PLACE                                                                                                     \
    "\"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 2 \"point3 p0\" [ -1 -1 0 ] \"point3 p1\" [ 1 1 1 ]\n"
START_TEST(test_grid_slab)
{
    static const double RAMP[3] = {3.5, 3.5, 3.5}, COLORS[3] = {0.875, 1.75, 0.4375};
    double expected[2][3], mean[3];
    for (int c = 0; c < 3; ++c) {
        expected[0][c] = exp(-0.5 * RAMP[c]);
        expected[1][c] = exp(-COLORS[c]);
    }
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z("MakeNamedMedium \"grid\" \"string type\" \"uniformgrid\" \"float scale\" 0.5\n" GRID_PLACE
                            "\"float sigma_s\" 0 \"float density\" [" NINE(" 2") NINE(" 6") " ]\n") LAMP
                    "MediumInterface \"grid\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "slab of a grid", mean, expected[0], 1e-5);
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z("MakeNamedMedium \"grid\" \"string type\" \"rgbgrid\" \"rgb sigma_s\" [" NINE(
                        " 0 0 0 0 0 0") " ]\n" GRID_PLACE "\"rgb sigma_a\" [" NINE(" 2 1 0") NINE(" 0 3 1") " ]\n") LAMP
                    "MediumInterface \"grid\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "slab of a grid of colours", mean, expected[1], 1e-5);
    }
}
END_TEST

/* A sphere in a grid that is the same everywhere but at its border is like one of the homogeneous medium: the same
 * paths by the same numbers. */
static void sphere_color(double mean[3], const Integrator *integrator, const char *medium)
{
    char text[2048];
    snprintf(text, sizeof text,
             ANALYTIC_FILM "MakeNamedMedium \"fog\" \"string type\" %s\n\"rgb sigma_s\" [ 1.5 1 0.5 ] \"float g\" 0.3\n"
                           "LookAt 0.3 0 -4  0.3 0 0  0 1 0\n"
                           "Camera \"perspective\" \"float fov\" 30\nWorldBegin\n"
                           "AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true Translate 0 2 0\n"
                           "Shape \"sphere\" \"float radius\" 0.7 AttributeEnd\n"
                           "LightSource \"infinite\" \"rgb L\" [ 0.1 0.1 0.2 ]\n"
                           "MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\"\n",
             medium);
    media_color(mean, integrator, 1024, 8, text);
}

START_TEST(test_constant_grid)
{
    for (int i = 0; i < CASE_COUNT; ++i) {
        double expected[3], mean[3];
        sphere_color(expected, CASES[i].integrator(),
                     "\"homogeneous\" \"rgb sigma_a\" [ 0.1 0.2 0.4 ] \"float scale\" 2");
        sphere_color(
            mean, CASES[i].integrator(),
            "\"uniformgrid\" \"rgb sigma_a\" [ 0.1 0.2 0.4 ] \"point3 p0\" [ -2 -2 -2 ] \"point3 p1\" [ 2 2 2 ]\n"
            "\"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 3\n"
            "\"float density\" [" NINE(" 2 2 2") " ]");
        media_check(&CASES[i], "constant grid", mean, expected, i == 0 ? 1e-5 : 5e-3); /* other light subpaths */
    }
}
END_TEST

/* The same slab of clear glass with an absorbing inside: the sum over all internal reflections. */
START_TEST(test_glass)
{
    double expected[3], mean[3], r = 0.04;
    for (int c = 0; c < 3; ++c) {
        double a = exp(-0.5 * (1 << c));
        expected[c] = (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a);
    }
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 4096, 12,
                    ALONG_Z("") LAMP "MediumInterface \"ink\" \"\" Material \"dielectric\" \"float eta\" 1.5\n" SLAB);
        media_check(&CASES[i], "absorbing glass", mean, expected, ANALYTIC_TOLERANCE);
    }
}
END_TEST

/* The camera in a medium that goes on beyond the lamp: 7 units. Of the environment nothing arrives. */
START_TEST(test_camera_inside)
{
    double expected[3], mean[3];
    for (int c = 0; c < 3; ++c)
        expected[c] = exp(-7.0 * 0.05 * (1 << c));
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z("MakeNamedMedium \"air\" \"string type\" \"homogeneous\" \"float sigma_s\" 0\n"
                            "\"rgb sigma_a\" [ 0.05 0.1 0.2 ]\nMediumInterface \"\" \"air\"\n") LAMP
                    "LightSource \"infinite\"\n");
        media_check(&CASES[i], "camera in a medium", mean, expected, 1e-5);
    }
}
END_TEST

/* ---- scattering -------------------------------------------------------------------------------------------------- */

/* A sphere of fog around a point light of intensity 1 at (0, 0.2, 0), seen along the line (0.5, 0, z). */
static const char *const SINGLE =
    ANALYTIC_FILM "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.2 0.4 0.6 ]\n"
                  "\"rgb sigma_s\" [ 0.5 0.8 0.4 ] \"float g\" 0.4\n"
                  "LookAt 0.5 0 -4  0.5 0 0  0 1 0\n"
                  "Camera \"orthographic\" \"float screenwindow\" [ -0.001 0.001 -0.001 0.001 ]\nWorldBegin\n"
                  "AttributeBegin MediumInterface \"\" \"fog\"\n"
                  "LightSource \"point\" \"rgb I\" [ 1 1 1 ] \"point3 from\" [ 0 0.2 0 ] AttributeEnd\n"
                  "MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\"\n";

static double single_expected(double absorption, double scattering, double g)
{
    enum { STEPS = 100000 };
    double end = sqrt(1.0 - 0.25), sum = 0.0, t = absorption + scattering;
    for (int i = 0; i < STEPS; ++i) {
        double z = end * (2.0 * (i + 0.5) / STEPS - 1.0);
        double r = sqrt(0.25 + 0.04 + z * z), cosine = -z / r; /* between the light's and the camera's direction */
        double phase = (1.0 - g * g) / (4.0 * M_PI * pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
        sum += exp(-t * (z + end)) * scattering * phase * exp(-t * r) / (r * r);
    }
    return sum * 2.0 * end / STEPS;
}

START_TEST(test_single_scattering)
{
    const double expected[3] = {single_expected(0.2, 0.5, 0.4), single_expected(0.4, 0.8, 0.4),
                                single_expected(0.6, 0.4, 0.4)};
    for (int i = 0; i < CASE_COUNT; ++i) {
        double mean[3];
        media_color(mean, CASES[i].integrator(), 16384, 2, SINGLE);
        media_check(&CASES[i], "single scattering", mean, expected, 0.01);
    }
}
END_TEST

/* ---- furnaces: what absorbs nothing in an environment of radiance 1 cannot be seen ------------------------------- */

#define FURNACE_VIEW                                                                                                   \
    "LookAt 0.3 0 -4  0.3 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 2\nWorldBegin LightSource \"infinite\"\n"   \
    "Material \"interface\"\n"
#define FURNACE(scattering)                                                                                            \
    ANALYTIC_FILM "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float sigma_a\" 0 " scattering            \
                  "\n" FURNACE_VIEW "MediumInterface \"fog\" \"\" Shape \"sphere\"\n"
/* A grid in another, so that rays go on from one to the other. */
#define FURNACE_OF_GRIDS(outer, inner)                                                                                 \
    ANALYTIC_FILM                                                                                                      \
    "MakeNamedMedium \"outer\" \"string type\" \"uniformgrid\" \"float sigma_a\" 0 \"rgb sigma_s\" [ " outer           \
    " ]\n\"point3 p0\" [ -1 -1 -1 ] \"integer nx\" 2 \"integer nz\" 2 \"float density\" [ 1 2 0 3 ]\n"                 \
    "MakeNamedMedium \"inner\" \"string type\" \"rgbgrid\" \"rgb sigma_a\" [ 0 0 0 0 0 0 ]\n"                          \
    "\"point3 p0\" [ -0.6 -0.6 -0.6 ] \"integer ny\" 2 \"rgb sigma_s\" [ " inner " ] \"float g\" 0.5\n" FURNACE_VIEW   \
    "MediumInterface \"outer\" \"\" Shape \"sphere\"\n"                                                                \
    "MediumInterface \"inner\" \"outer\" Shape \"sphere\" \"float radius\" 0.5\n"

typedef struct Furnace {
    const char *name, *text;
    unsigned samples; /* per pixel */
} Furnace;

/* *error: largest standard error of a channel's mean, by the differences of pixels. */
static void furnace_check(const Furnace *furnace, double tolerance, double *error)
{
    RenderSetup setup = {.text = furnace->text,
                         .samples = furnace->samples,
                         .max_depth = 1000,
                         .seed = 11,
                         .integrator = integrator_pt()};
    RenderedImage image;
    fixture_render(&setup, &image);
    const int pixels = image.width * image.height;
    *error = 0.0;
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < pixels; ++i) {
            double value = (double)image.rgb[3 * i + c];
            sum += value;
            squares += value * value;
        }
        double mean = sum / pixels;
        *error = fmax(*error, sqrt((squares / pixels - mean * mean) / (pixels - 1)));
        analytic_check(furnace->name, mean, 1.0, tolerance);
    }
    fixture_destroy(&image);
}

START_TEST(test_furnace)
{
    static const Furnace FURNACES[] = {
        {"furnace of colours", FURNACE("\"rgb sigma_s\" [ 1 2 3 ] \"float g\" 0.6"), 4096},
        {"furnace", FURNACE("\"float sigma_s\" 4"), 4096},
        {"dense furnace", FURNACE("\"rgb sigma_s\" [ 20 20 20 ] \"float g\" -0.9"), 256},
        {"furnace of grids", FURNACE_OF_GRIDS("1 2 3", "4 2 1 0 3 5"), 4096}};
    double error;
    furnace_check(&FURNACES[_i], 0.005, &error);
}
END_TEST

/* To 1e-3, by enough samples for a standard error below 2.5e-4: minutes. Colours are less different than above, because
 * the variance grows fast with that; and at an optical depth of 40, 0.16 % of the light goes over more than 1000
 * segments. */
START_TEST(test_exact_furnace)
{
    static const Furnace FURNACES[] = {
        {"exact furnace of colours", FURNACE("\"rgb sigma_s\" [ 1.8 2 2.2 ] \"float g\" 0.6"), 131072},
        {"exact furnace", FURNACE("\"float sigma_s\" 4"), 163840},
        {"exact dense furnace", FURNACE("\"rgb sigma_s\" [ 8 8 8 ] \"float g\" -0.9"), 65536},
        {"exact furnace of grids", FURNACE_OF_GRIDS("1.2 1.3 1.4", "2.2 2 1.8 0.9 1 1.1"), 131072}};
    double error;
    if (test_effort() == 1)
        return;
    furnace_check(&FURNACES[_i], 1e-3, &error);
    printf("%s: standard error %.6f\n", FURNACES[_i].name, error);
    ck_assert_double_lt(error, 2.5e-4);
}
END_TEST

/* ---- emission ---------------------------------------------------------------------------------------------------- */

/* A slab that absorbs and emits, before a lamp of radiance 1: T + Le (1 - T). */
START_TEST(test_emission)
{
    static const double LE[3] = {3.0, 2.0, 1.5};
    double expected[3], mean[3];
    for (int c = 0; c < 3; ++c) {
        double a = exp(-0.5 * (1 << c));
        expected[c] = a + 2.0 * LE[c] * (1.0 - a);
    }
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z("MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"float sigma_s\" 0\n"
                            "\"rgb sigma_a\" [ 0.5 1 2 ] \"rgb Le\" [ 3 2 1.5 ] \"float Lescale\" 2\n") LAMP
                    "MediumInterface \"fire\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "emission", mean, expected, 1e-5);
    }
}
END_TEST

/* Emission behind a slab that absorbs; and of a slab so thin that 1 - exp(-x) would lose digits. */
START_TEST(test_emission_behind)
{
    static const double THIN[3] = {3e-4, 3e-4, 3e-4};
    double expected[3], mean[3];
    for (int c = 0; c < 3; ++c) {
        double a = exp(-0.5 * (1 << c));
        expected[c] = a * (exp(-1.0) + 3.0 * (1.0 - exp(-1.0)));
    }
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z("MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"float sigma_s\" 0\n"
                            "\"float sigma_a\" 1 \"rgb Le\" [ 3 3 3 ]\n") LAMP
                    "MediumInterface \"fire\" \"\" Material \"interface\" AttributeBegin Translate 0 0 1.5\n" SLAB
                    "AttributeEnd MediumInterface \"ink\" \"\"\n" SLAB);
        media_check(&CASES[i], "emission behind a slab", mean, expected, 1e-5);
        media_color(
            mean, CASES[i].integrator(), 16, 3,
            ALONG_Z(
                "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"float sigma_s\" 0\n"
                "\"float sigma_a\" 1e-6 \"rgb Le\" [ 300 300 300 ]\n") "LightSource \"point\" MediumInterface \"fire\" "
                                                                       "\"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "emission of a thin slab", mean, THIN, 1e-4);
    }
}
END_TEST

/* The ramp of test_grid_slab, which emits: T + Le (1 - T); and with scattering, at depth 1, Le sigma_a / sigma_t (1 -
 * T). */
START_TEST(test_emission_of_grid)
{
    static const double LE[3] = {3.0, 2.0, 0.5};
    double slab[3], fog[3], mean[3], t = exp(-1.75);
    for (int c = 0; c < 3; ++c) {
        slab[c] = t + 2.0 * LE[c] * (1.0 - t);
        fog[c] = 2.0 * LE[c] * 0.5 * (1.0 - t * t);
    }
#define FIRE(scattering)                                                                                               \
    "MakeNamedMedium \"grid\" \"string type\" \"uniformgrid\" \"float scale\" 0.5 \"rgb Le\" [ 6 4 1 ]\n" GRID_PLACE   \
    "\"float sigma_s\" " scattering " \"float density\" [" NINE(" 2") NINE(" 6") " ]\n"
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 16, 3,
                    ALONG_Z(FIRE("0")) LAMP "MediumInterface \"grid\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "emission of a grid", mean, slab, 1e-5);
        media_color(mean, CASES[i].integrator(), 16384, 1,
                    ALONG_Z(FIRE("1")) "LightSource \"point\"\n"
                                       "MediumInterface \"grid\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "emission of a grid that scatters", mean, fog, ANALYTIC_TOLERANCE);
    }
}
END_TEST

/* Between samples at z = 1/4 and 3/4, and half of the way to 0 at the faces. */
static double ramp_value(double z, double first, double second)
{
    if (z < 0.25)
        return first * (0.5 + 2.0 * z);
    return z < 0.75 ? first + (second - first) * (2.0 * z - 0.5) : second * (2.5 - 2.0 * z);
}

/* The integral of transmittance times absorption times radiance from z = 0 to `end` in steps, for samples at z = 1/4
 * and 3/4. */
static double ramp_light(double extinction, double absorption, const double density[2], const double radiance[2],
                         double end)
{
    enum { STEPS = 20000 };
    double sum = 0.0, depth = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        double z = end * (i + 0.5) / STEPS, d = ramp_value(z, density[0], density[1]) * end / STEPS;
        sum += absorption * d * ramp_value(z, radiance[0], radiance[1]) * exp(-depth - 0.5 * extinction * d);
        depth += extinction * d;
    }
    return sum;
}

#define FLICKERS                                                                                                       \
    ALONG_Z("MakeNamedMedium \"grid\" \"string type\" \"uniformgrid\" \"float scale\" 0.5\n"                           \
            "\"rgb Le\" [ 3 2 0.5 ] \"float Lescale\" [" NINE(" 1")                                                    \
                NINE(" 4") " ]\n" GRID_PLACE "\"float density\" [" NINE(" 2") NINE(" 6") " ]\n")                       \
    "LightSource \"point\"\n"

/* Emission that varies otherwise than extinction, with scattering, by every integrator. */
START_TEST(test_emission_that_varies)
{
    static const double LE[3] = {3.0, 2.0, 0.5}, DENSITY[2] = {2.0, 6.0};
    static const double ABSORPTION[3][2] = {{2.0, 1.0}, {1.0, 3.0}, {3.0, 0.0}},
                        RADIANCE[3][2] = {{1.0, 2.0}, {0.0, 4.0}, {2.0, 5.0}};
    double fire[3], half[3], colors[3], mean[3];
    const double scale[2] = {1.0, 4.0};
    for (int c = 0; c < 3; ++c) {
        const double radiance[2] = {LE[c] * scale[0], LE[c] * scale[1]}, *a = ABSORPTION[c];
        fire[c] = ramp_light(1.0, 0.5, DENSITY, radiance, 1.0);
        half[c] = ramp_light(1.0, 0.5, DENSITY, radiance, 0.5);
        colors[c] = ramp_light(1.0, 1.0, a, RADIANCE[c], 1.0);
    }
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 256, 1,
                    FLICKERS "MediumInterface \"grid\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "emission that varies", mean, fire, 1e-3);
        media_color(mean, CASES[i].integrator(), 256, 1,
                    FLICKERS "MediumInterface \"grid\" Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
                             "Shape \"bilinearmesh\" \"point3 P\" [ -4 -4 0.5  4 -4 0.5  -4 4 0.5  4 4 0.5 ]\n"
                             "MediumInterface \"grid\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "emission before a wall", mean, half, 1e-3);
        media_color(
            mean, CASES[i].integrator(), 256, 1,
            ALONG_Z("MakeNamedMedium \"grid\" \"string type\" \"rgbgrid\" \"float Lescale\" 0.00935831\n" GRID_PLACE
                    "\"rgb sigma_a\" [" NINE(" 2 1 3") NINE(" 1 3 0") " ] \"rgb sigma_s\" [" NINE(
                        " 0 0 0 0 0 0") " ]\n"
                                        "\"rgb Le\" [" NINE(" 1 0 2")
                                            NINE(" 2 4 5") " ]\n") "LightSource \"point\"\n"
                                                                   "MediumInterface \"grid\" \"\" Material "
                                                                   "\"interface\"\n" SLAB);
        media_check(&CASES[i], "emission of colours that varies", mean, colors, 1e-3);
    }
}
END_TEST

/* Emission does not depend on where the ray is scattered: a thin medium that emits and scatters, at depth 1. */
START_TEST(test_emission_of_fog)
{
    double expected[3], mean[3];
    for (int c = 0; c < 3; ++c)
        expected[c] = 0.5 / (0.5 + 2.0) * (1.0 - exp(-2.5)) + exp(-2.5);
    for (int i = 0; i < CASE_COUNT; ++i) {
        media_color(mean, CASES[i].integrator(), 16384, 1,
                    ALONG_Z("MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"float sigma_s\" 2\n"
                            "\"float sigma_a\" 0.5 \"rgb Le\" [ 1 1 1 ]\n") LAMP
                    "MediumInterface \"fire\" \"\" Material \"interface\"\n" SLAB);
        media_check(&CASES[i], "emission of fog", mean, expected, ANALYTIC_TOLERANCE);
    }
}
END_TEST

TCase *analytic_media_case(void)
{
    TCase *tcase = tcase_create("media");
    tcase_set_timeout(tcase, test_effort() > 1 ? 3600.0 : 600.0);
    tcase_add_test(tcase, test_slab);
    tcase_add_test(tcase, test_grid_slab);
    tcase_add_test(tcase, test_constant_grid);
    tcase_add_test(tcase, test_glass);
    tcase_add_test(tcase, test_camera_inside);
    tcase_add_test(tcase, test_single_scattering);
    tcase_add_loop_test(tcase, test_furnace, 0, 4);
    tcase_add_loop_test(tcase, test_exact_furnace, 0, 4);
    tcase_add_test(tcase, test_emission);
    tcase_add_test(tcase, test_emission_behind);
    tcase_add_test(tcase, test_emission_of_fog);
    tcase_add_test(tcase, test_emission_of_grid);
    tcase_add_test(tcase, test_emission_that_varies);
    tcase_set_timeout(tcase, 300);
    return tcase;
}
