/* Spectra as RGB, against published numbers. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "image/color.h"

#include <math.h>

TCase *texture_color_tcase(void);

static double luminance(const float rgb[3])
{
    return 0.2126729 * (double)rgb[0] + 0.7151522 * (double)rgb[1] + 0.0721750 * (double)rgb[2];
}

/* CIE 1931 chromaticity by the matrix of IEC 61966-2-1. */
static void chromaticity(const float rgb[3], double xy[2])
{
    const double m[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    double xyz[3] = {0};
    for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
            xyz[i] += m[i][c] * (double)rgb[c];
    for (int i = 0; i < 2; ++i)
        xy[i] = xyz[i] / (xyz[0] + xyz[1] + xyz[2]);
}

/* Points of the Planckian locus inside sRGB (Wyszecki and Stiles 1982, table 1(3.11), to the digits given there). */
START_TEST(test_blackbody)
{
    const double points[][3] = {{2856.0, 0.4475, 0.4074},
                                {4000.0, 0.3805, 0.3768},
                                {5000.0, 0.3451, 0.3516},
                                {6504.0, 0.3135, 0.3236},
                                {10000.0, 0.2807, 0.2884}};
    float rgb[3];
    for (int i = 0; i < 5; ++i) {
        double xy[2];
        color_blackbody((float)points[i][0], rgb);
        chromaticity(rgb, xy);
        ck_assert_double_eq_tol(xy[0], points[i][1], 3e-4);
        ck_assert_double_eq_tol(xy[1], points[i][2], 3e-4);
    }
    for (float kelvin = -100.0f; kelvin < 1e6f; kelvin = kelvin * 1.3f + 131.0f) {
        color_blackbody(kelvin, rgb);
        ck_assert_double_eq_tol(luminance(rgb), 1.0, 1e-5);
        ck_assert(rgb[0] >= 0.0f && rgb[1] >= 0.0f && rgb[2] >= 0.0f);
    }
}
END_TEST

/* Planck's law with the constants of CODATA 2018, up to a factor. */
static double planck(double nanometre, double kelvin)
{
    double metre = nanometre * 1e-9;
    return pow(metre, -5.0) / expm1(6.62607015e-34 * 299792458.0 / (metre * 1.380649e-23 * kelvin));
}

/* The observer's luminance by the fit of Wyman, Sloan and Shirley, "Simple analytic approximations to the CIE XYZ color
 * matching functions", 2013, which is off by less than 1 %. */
static double observer(double nanometre)
{
    double a = (nanometre - 568.8) * (nanometre < 568.8 ? 0.0213 : 0.0247),
           b = (nanometre - 530.9) * (nanometre < 530.9 ? 0.0613 : 0.0322);
    return 0.821 * exp(-0.5 * a * a) + 0.286 * exp(-0.5 * b * b);
}

/* Luminance of black bodies whose spectrum has the maximum 1; their colour is that of others. */
START_TEST(test_blackbody_relative)
{
    static const float KELVINS[] = {700.0f, 1000.0f, 1500.0f, 3000.0f, 6500.0f, 20000.0f};
    float rgb[3], color[3];
    for (size_t i = 0; i < sizeof KELVINS / sizeof *KELVINS; ++i) {
        double most = 0.0, sum = 0.0, kelvin = (double)KELVINS[i];
        for (double x = 50.0; x < 6000.0; x += 1.0)
            most = fmax(most, planck(x, kelvin));
        for (double x = 360.0; x <= 830.0; x += 1.0)
            sum += observer(x) * planck(x, kelvin) / most;
        color_blackbody_relative(KELVINS[i], rgb);
        color_blackbody(KELVINS[i], color);
        ck_assert_double_eq_tol(luminance(rgb) / sum, 1.0, kelvin < 1200.0 ? 0.1 : 0.02); /* the fit's far red */
        ck_assert_double_eq_tol((double)(rgb[1] / rgb[0]), (double)(color[1] / color[0]), 1e-5);
    }
    color_blackbody_relative(100.0f, rgb);
    ck_assert_float_eq(rgb[0], 0.0f);
    color_blackbody_relative(0.0f, rgb);
    ck_assert_float_eq(rgb[0], 0.0f);
    color_blackbody_relative(1e9f, rgb);
    ck_assert_float_lt(rgb[0], 1e-3f);
}
END_TEST

static void named(const char *name, ColorRole role, float rgb[3])
{
    Error error;
    ck_assert_msg(color_named_spectrum(name, role, rgb, &error), "%s", error.message);
}

static double fresnel(double n, double k)
{
    return ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
}

/* Reflectance at normal incidence in linear sRGB as tabulated by S. Lagarde ("Feeding a physically based shading
 * model", 2011) for silver, aluminium and copper; gold's red lies outside sRGB and is clamped below 1. */
START_TEST(test_metals)
{
    const struct {
        const char *eta, *k;
        double rgb[3], tolerance;
    } metals[] = {
        {"metal-Ag-eta", "metal-Ag-k", {0.972, 0.960, 0.915}, 1e-3},
        {"metal-Al-eta", "metal-Al-k", {0.913, 0.922, 0.924}, 1e-3},
        {"metal-Cu-eta", "metal-Cu-k", {0.955, 0.638, 0.538}, 1e-3},
        {"metal-Au-eta", "metal-Au-k", {0.999, 0.782, 0.344}, 1e-3},
        {"metal-CuZn-eta", "metal-CuZn-k", {0.910, 0.778, 0.423}, 1e-3},
    };
    for (size_t i = 0; i < sizeof metals / sizeof *metals; ++i) {
        float eta[3], k[3];
        named(metals[i].eta, COLOR_INDEX, eta);
        named(metals[i].k, COLOR_INDEX, k);
        for (int c = 0; c < 3; ++c)
            ck_assert_double_eq_tol(fresnel((double)eta[c], (double)k[c]), metals[i].rgb[c], metals[i].tolerance);
    }
}
END_TEST

/* n_d (587.6 nm) and n_F (486.1 nm) from Schott's catalogue bracket the averages of the channels. */
START_TEST(test_glass)
{
    const struct {
        const char *name;
        double nd, nf;
    } glasses[] = {{"glass-BK7", 1.51680, 1.52238},
                   {"glass-SF10", 1.72825, 1.74648},
                   {"glass-SF11", 1.78472, 1.80645},
                   {"glass-F11", 1.78472, 1.80645},
                   {"glass-BAF10", 1.67003, 1.68001}};
    for (size_t i = 0; i < sizeof glasses / sizeof *glasses; ++i) {
        float n[3];
        named(glasses[i].name, COLOR_INDEX, n);
        ck_assert(n[0] < n[1] && n[1] < n[2]);
        ck_assert_double_eq_tol((double)n[0], glasses[i].nd, 2e-3);
        ck_assert((double)n[1] > glasses[i].nd && (double)n[1] < glasses[i].nf && (double)n[2] > glasses[i].nf);
    }
}
END_TEST

/* Chromaticities of CIE 15:2004, tables T.3 and T.8. */
START_TEST(test_illuminants)
{
    const struct {
        const char *name;
        double x, y;
    } lights[] = {{"stdillum-A", 0.44758, 0.40745},   {"stdillum-D50", 0.34567, 0.35851},
                  {"stdillum-D65", 0.31272, 0.32903}, {"stdillum-F2", 0.3721, 0.3751},
                  {"stdillum-F7", 0.3129, 0.3292},    {"stdillum-F11", 0.3805, 0.3769},
                  {"illum-acesD60", 0.32168, 0.33767}};
    for (size_t i = 0; i < sizeof lights / sizeof *lights; ++i) {
        float rgb[3];
        double xy[2];
        named(lights[i].name, COLOR_ILLUMINANT, rgb);
        chromaticity(rgb, xy);
        ck_assert_double_eq_tol(xy[0], lights[i].x, 3e-4);
        ck_assert_double_eq_tol(xy[1], lights[i].y, 3e-4);
        ck_assert_double_eq_tol(luminance(rgb), 1.0, 1e-4);
    }
}
END_TEST

static void sampled(const float *pairs, size_t n, ColorRole role, float rgb[3])
{
    Error error;
    ck_assert_msg(color_from_samples(pairs, n, role, rgb, &error), "%s", error.message);
}

START_TEST(test_samples)
{
    const float grey[] = {300, 0.5f, 900, 0.5f}, middle[] = {500, 1.6f}, blue[] = {360, 1, 499, 1, 500, 0};
    const float edge[] = {400, 2, 420, 2, 560, 2, 600, 1, 700, 1}, line[] = {649.5f, 0, 650, 9, 650.5f, 0};
    float rgb[3];
    sampled(grey, 2, COLOR_REFLECTANCE, rgb);
    for (int c = 0; c < 3; ++c)
        ck_assert_float_eq_tol(rgb[c], 0.5f, 1e-6f);
    /* Illuminant E: the sRGB matrix times (1, 1, 1). */
    sampled(grey, 2, COLOR_ILLUMINANT, rgb);
    ck_assert_float_eq_tol(rgb[0], 1.2048f, 1e-3f);
    ck_assert_float_eq_tol(rgb[1], 0.9483f, 1e-3f);
    ck_assert_float_eq_tol(rgb[2], 0.9089f, 1e-3f);
    sampled(middle, 1, COLOR_INDEX, rgb);
    for (int c = 0; c < 3; ++c)
        ck_assert_float_eq_tol(rgb[c], 1.6f, 1e-6f);
    sampled(edge, 5, COLOR_INDEX, rgb);
    ck_assert(rgb[2] > 1.9f && rgb[2] <= 2.0f && rgb[0] < 1.35f && rgb[0] >= 1.0f && rgb[1] > rgb[0]);
    /* A saturated reflectance leaves the gamut and is mapped back; values of at most 1 remain so. */
    sampled(blue, 3, COLOR_REFLECTANCE, rgb);
    ck_assert(rgb[0] >= 0.0f && rgb[1] >= 0.0f && rgb[2] > 0.8f && rgb[2] <= 1.0f);
    sampled(line, 3, COLOR_ILLUMINANT, rgb);
    ck_assert(rgb[1] == 0.0f && rgb[2] == 0.0f);
    ck_assert_double_eq_tol(luminance(rgb), 1.0, 1e-5);
}
END_TEST

START_TEST(test_errors)
{
    const float back[] = {500, 1, 500, 1}, below[] = {400, 1, 500, -1}, nan[] = {400, NAN}, dark[] = {400, 0, 500, 0};
    const float outside[] = {900, 1, 1000, 1};
    float rgb[3];
    Error error;
    ck_assert(!color_from_samples(back, 2, COLOR_REFLECTANCE, rgb, &error));
    ck_assert(!color_from_samples(below, 2, COLOR_REFLECTANCE, rgb, &error));
    ck_assert(!color_from_samples(nan, 1, COLOR_REFLECTANCE, rgb, &error));
    ck_assert(!color_from_samples(back, 0, COLOR_INDEX, rgb, &error));
    ck_assert(!color_from_samples(dark, 2, COLOR_ILLUMINANT, rgb, &error));
    ck_assert(!color_from_samples(outside, 2, COLOR_ILLUMINANT, rgb, &error));
    ck_assert(!color_named_spectrum("metal-Xx-eta", COLOR_INDEX, rgb, &error));
    ck_assert_str_eq(error.message, "error: unknown spectrum \"metal-Xx-eta\"");
    ck_assert(!color_named_spectrum("canon_eos_5d_r", COLOR_REFLECTANCE, rgb, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "camera"));
    ck_assert(!color_named_spectrum("metal-Cu-eta", COLOR_REFLECTANCE, rgb, &error));
    ck_assert(!color_named_spectrum("stdillum-A", COLOR_INDEX, rgb, &error));
}
END_TEST

START_TEST(test_spectrum_file)
{
    const char *const bad[] = {"400 1 500\n", "400 1\n500 x\n", "", "# nothing\n", "500 1 400 1", "400 nan"};
    const char good[] = "# a comment\n300 .5  400 5e-1 # another\n\n\t900 0.5";
    float rgb[3];
    Error error;
    test_file_write(test_path("a.spd"), good, strlen(good));
    ck_assert_msg(color_spectrum_file(test_path("a.spd"), COLOR_REFLECTANCE, rgb, &error), "%s", error.message);
    ck_assert_float_eq_tol(rgb[1], 0.5f, 1e-6f);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        test_file_write(test_path("bad.spd"), bad[i], strlen(bad[i]));
        ck_assert_msg(!color_spectrum_file(test_path("bad.spd"), COLOR_REFLECTANCE, rgb, &error), "%s", bad[i]);
        ck_assert_ptr_nonnull(strstr(error.message, "bad.spd"));
    }
    test_file_write(test_path("bad.spd"), bad[1], strlen(bad[1]));
    color_spectrum_file(test_path("bad.spd"), COLOR_REFLECTANCE, rgb, &error);
    ck_assert_ptr_nonnull(strstr(error.message, "bad.spd:2:5: error: expected a number, not \"x\""));
    ck_assert(!color_spectrum_file(test_path("none.spd"), COLOR_REFLECTANCE, rgb, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "none.spd: No such file"));
}
END_TEST

TCase *texture_color_tcase(void)
{
    TCase *tcase = tcase_create("color");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_blackbody);
    tcase_add_test(tcase, test_blackbody_relative);
    tcase_add_test(tcase, test_metals);
    tcase_add_test(tcase, test_glass);
    tcase_add_test(tcase, test_illuminants);
    tcase_add_test(tcase, test_samples);
    tcase_add_test(tcase, test_errors);
    tcase_add_test(tcase, test_spectrum_file);
    return tcase;
}
