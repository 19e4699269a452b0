/* Conductors, mixes, alpha and the coat over a diffuse base against their formulas. */
#include "support/analytic.h"

#include <complex.h>

#define SAMPLES 16384

/* ---- conductors -------------------------------------------------------------------------------------------------- */

/* Reflectance for unpolarised light of a metal of index eta + i k, in complex arithmetic (Born and Wolf 1999, 14.2). */
static double fresnel_metal(double cosine, double eta, double k)
{
    double complex n = eta + I * k, t = csqrt(1.0 - (1.0 - cosine * cosine) / (n * n));
    double s = cabs((cosine - n * t) / (cosine + n * t)), p = cabs((n * cosine - t) / (n * cosine + t));
    return 0.5 * (s * s + p * p);
}

/* A mirror at z = 0 seen at `angle`, in an environment of radiance 1. */
static void mirror(double mean[3], const char *material, double angle, unsigned samples)
{
    analytic_color(mean, samples, 2,
                   ANALYTIC_FILM "LookAt %.9g 0 %.9g  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 0.05\n"
                                 "WorldBegin LightSource \"infinite\"\n%s\n"
                                 "Shape \"bilinearmesh\" \"point3 P\" [ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ]",
                   9.0 * sin(angle), 9.0 * cos(angle), material);
}

START_TEST(test_mirrors)
{
    static const double ANGLES[] = {0.0, 45.0, 80.0};
    static const struct {
        const char *material;
        double eta[3], k[3];
    } METALS[] = {
        {"Material \"conductor\" \"rgb eta\" [ 0.2 0.92 1.1 ] \"rgb k\" [ 3.9 2.45 2.14 ]",
         {0.2, 0.92, 1.1},
         {3.9, 2.45, 2.14}},
        {"Material \"conductor\" \"rgb eta\" [ 1.5 2.5 4 ] \"rgb k\" [ 0 0.5 9 ]", {1.5, 2.5, 4.0}, {0.0, 0.5, 9.0}}};
    for (int m = 0; m < 2; ++m)
        for (int i = 0; i < 3; ++i) {
            double mean[3], angle = ANGLES[i] * M_PI / 180.0;
            mirror(mean, METALS[m].material, angle, 16);
            for (int c = 0; c < 3; ++c) {
                char name[100];
                snprintf(name, sizeof name, "metal %g + %g i at %g degrees", METALS[m].eta[c], METALS[m].k[c],
                         ANGLES[i]);
                analytic_check(name, mean[c], fresnel_metal(cos(angle), METALS[m].eta[c], METALS[m].k[c]), 1e-4);
            }
        }
}
END_TEST

/* pbrt's "reflectance": eta = 1, k = 2 sqrt(r / (1 - r)). */
START_TEST(test_mirror_of_reflectance)
{
    for (int i = 0; i < 2; ++i) {
        double mean[3], angle = i * 70.0 * M_PI / 180.0;
        mirror(mean, "Material \"conductor\" \"rgb reflectance\" [ 0.2 0.5 0.9 ]", angle, 16);
        for (int c = 0; c < 3; ++c) {
            double r = c == 0 ? 0.2 : c == 1 ? 0.5 : 0.9;
            analytic_check(i ? "reflectance at 70 degrees" : "reflectance at normal incidence", mean[c],
                           fresnel_metal(cos(angle), 1.0, 2.0 * sqrt(r / (1.0 - r))), 1e-4);
        }
    }
}
END_TEST

/* A rough mirror under a distant light from l, seen from (8, 1, 3): D F G / (4 cos o), with GGX of alpha_x along dp/du
 * and alpha_y across (Walter et al. 2007, Heitz 2014: G = 1 / (1 + lambda(o) + lambda(i))). */
static double ggx_lambda(const double w[3], double ax, double ay)
{
    return 0.5 * (sqrt(1.0 + (ax * ax * w[0] * w[0] + ay * ay * w[1] * w[1]) / (w[2] * w[2])) - 1.0);
}

static double rough_mirror(const double l[3], double ax, double ay, double eta, double k)
{
    double o[3] = {8.0 / sqrt(74.0), 1.0 / sqrt(74.0), 3.0 / sqrt(74.0)}, m[3], length = 0.0, cosine = 0.0;
    for (int c = 0; c < 3; ++c) {
        m[c] = o[c] + l[c];
        length += m[c] * m[c];
    }
    for (int c = 0; c < 3; ++c) {
        m[c] /= sqrt(length);
        cosine += m[c] * o[c];
    }
    double slope = m[0] * m[0] / (ax * ax) + m[1] * m[1] / (ay * ay) + m[2] * m[2];
    double d = 1.0 / (M_PI * ax * ay * slope * slope);
    double g = 1.0 / (1.0 + ggx_lambda(o, ax, ay) + ggx_lambda(l, ax, ay));
    return d * g * fresnel_metal(cosine, eta, k) / (4.0 * o[2]);
}

START_TEST(test_rough_mirrors)
{
    static const double LIGHT[3] = {-0.64, 0.48, 0.6};
    static const struct {
        const char *material;
        double ax, ay, eta, k;
    } CASES[] = {
        {"Material \"conductor\" \"rgb eta\" [ 1.2 1.2 1.2 ] \"rgb k\" [ 3 3 3 ] \"float uroughness\" 0.5 "
         "\"float vroughness\" 0.1 \"bool remaproughness\" false",
         0.5, 0.1, 1.2, 3.0},
        {"Material \"conductor\" \"rgb eta\" [ 1.2 1.2 1.2 ] \"rgb k\" [ 3 3 3 ] \"float uroughness\" 0.04 "
         "\"float vroughness\" 0.25",
         0.2, 0.5, 1.2, 3.0},
        {"Material \"dielectric\" \"float eta\" 1.6 \"float roughness\" 0.16", 0.4, 0.4, 1.6, 0.0},
    };
    for (int i = 0; i < 3; ++i) {
        double got =
            analytic_mean(16, 2,
                          ANALYTIC_LOOK_AT_ORIGIN
                          "LightSource \"distant\" \"point3 from\" [ -0.64 0.48 0.6 ] \"point3 to\" [ 0 0 0 ]\n"
                          "%s\nShape \"bilinearmesh\" \"point3 P\" [ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ]",
                          CASES[i].material);
        char name[64];
        snprintf(name, sizeof name, "GGX of alpha %g along u, %g along v", CASES[i].ax, CASES[i].ay);
        analytic_check(name, got, rough_mirror(LIGHT, CASES[i].ax, CASES[i].ay, CASES[i].eta, CASES[i].k), 1e-3);
    }
}
END_TEST

/* ---- mixes and interfaces ---------------------------------------------------------------------------------------- */

/* "amount" is the weight of the second material. */
START_TEST(test_mix)
{
    double mean[3];
    mirror(mean,
           "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
           "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n"
           "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.3",
           0.5, SAMPLES);
    analytic_check("mix, 0.3 of the second", mean[1], 0.3, ANALYTIC_TOLERANCE);
}
END_TEST

START_TEST(test_interface)
{
    double got = analytic_mean(16, 3,
                               ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
                               "LightSource \"distant\" \"rgb L\" [ 3.14159265 3.14159265 3.14159265 ] "
                               "\"point3 to\" [ 0 0 -1 ]\nMaterial \"interface\" Shape \"sphere\" \"float radius\" 2");
    analytic_check("plane inside an interface", got, 0.5, 1e-3);
}
END_TEST

/* ---- alpha ------------------------------------------------------------------------------------------------------- */

/* Rays pass or not according to a hash of the ray, as in pbrt: the view must be wide enough for rays to differ by more
 * than rounding. */
#define VEIL_VIEW ANALYTIC_FILM "LookAt 8 1 3  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 1\nWorldBegin\n"
#define VEIL "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] "

START_TEST(test_alpha)
{
    analytic_check(
        "lamp behind a veil of alpha 0.3",
        analytic_mean(4096, 1,
                      VEIL_VIEW VEIL
                      "AttributeBegin Translate 0 0 0.5 Shape \"disk\" \"float radius\" 9 \"float alpha\" 0.3 "
                      "AttributeEnd AreaLightSource \"diffuse\" Shape \"disk\""),
        0.7, ANALYTIC_TOLERANCE);
    analytic_check("veil of alpha 0.3 before a distant light",
                   analytic_mean(4096, 2,
                                 VEIL_VIEW ANALYTIC_DIFFUSE_PLANE VEIL
                                 "LightSource \"distant\" \"rgb L\" [ 3.14159265 3.14159265 3.14159265 ] "
                                 "\"point3 to\" [ 0 0 -1 ] Translate 0 0 2 Shape \"disk\" \"float alpha\" 0.3"),
                   0.7 * 0.5, ANALYTIC_TOLERANCE);
    analytic_check("lamp of alpha 0.25",
                   analytic_mean(4096, 2,
                                 ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
                                 "AreaLightSource \"diffuse\" Translate 0 0 1 ReverseOrientation "
                                 "Shape \"disk\" \"float radius\" 0.5 \"float alpha\" 0.25"),
                   0.25 * 0.5 * 0.25 / 1.25, ANALYTIC_TOLERANCE);
}
END_TEST

/* Lamps of alpha 0 are not seen, and light what they would without alpha. */
START_TEST(test_invisible)
{
    analytic_check("disk of alpha 0",
                   analytic_mean(4096, 2,
                                 ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
                                 "AreaLightSource \"diffuse\" Translate 0 0 1 ReverseOrientation "
                                 "Shape \"disk\" \"float radius\" 0.5 \"float alpha\" 0"),
                   0.5 * 0.25 / 1.25, ANALYTIC_TOLERANCE);
    analytic_check("disk of alpha 0, seen from the front",
                   analytic_mean(64, 1, VEIL_VIEW "AreaLightSource \"diffuse\" Shape \"disk\" \"float alpha\" 0"), 0.0,
                   ANALYTIC_TOLERANCE);
    /* Through its invisible near side, a sphere that shines inwards sends light outwards as one that shines there. */
    for (int inwards = 0; inwards < 2; ++inwards) {
        double mean = analytic_mean(
            4096, 2,
            ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
            "AreaLightSource \"diffuse\" Translate 0 0 2 %s Shape \"sphere\" \"float radius\" 0.5 \"float alpha\" 0",
            inwards ? "ReverseOrientation" : "");
        analytic_check(inwards ? "inward sphere of alpha 0" : "sphere of alpha 0", mean, 0.5 * 0.25 / 4.0,
                       ANALYTIC_TOLERANCE);
    }
}
END_TEST

/* ---- coated diffuse ---------------------------------------------------------------------------------------------- */

/* The cosine inside for a direction of cosine c outside. */
static double inside(double c, double eta)
{
    return sqrt(1.0 - (1.0 - c * c) / (eta * eta));
}

static double through(double c, double eta, double thickness)
{
    return (1.0 - analytic_fresnel(c, eta)) * exp(-thickness / inside(c, eta));
}

typedef struct Coat {
    double entering; /* fraction of a diffuse field outside that reaches the base */
    double returned; /* fraction of the base's radiosity that returns to it */
} Coat;

static Coat coat_integrals(double eta, double thickness)
{
    enum { COUNT = 20000 };
    Coat coat = {0.0, 0.0};
    for (int i = 0; i < COUNT; ++i) {
        double c = (i + 0.5) / COUNT;
        coat.entering += 2.0 * c * through(c, eta, thickness) / COUNT;
        coat.returned += 2.0 * c * analytic_fresnel(c, 1.0 / eta) * exp(-2.0 * thickness / c) / COUNT;
    }
    return coat;
}

static void coat_case(double eta, double thickness, double angle)
{
    static const double RHO[3] = {0.3, 0.6, 0.9};
    double c = cos(angle), mean[3];
    Coat coat = coat_integrals(eta, thickness);
    char material[200], name[100];
    snprintf(material, sizeof material,
             "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.3 0.6 0.9 ] \"float eta\" %g \"float thickness\" %g",
             eta, thickness);
    mirror(mean, material, angle, SAMPLES);
    for (int k = 0; k < 3; ++k) {
        double radiosity = RHO[k] * coat.entering / (1.0 - RHO[k] * coat.returned);
        snprintf(name, sizeof name, "coat %g, thickness %g, base %g, %.0f degrees", eta, thickness, RHO[k],
                 angle * 180.0 / M_PI);
        analytic_check(name, mean[k], analytic_fresnel(c, eta) + radiosity * through(c, eta, thickness) / (eta * eta),
                       ANALYTIC_TOLERANCE);
    }
}

/* In an environment of radiance 1: the mirror image, and the base's radiosity through the interface and the medium. */
START_TEST(test_coats_in_environment)
{
    coat_case(1.5, 0.0, 0.0);
    coat_case(1.5, 0.0, 70.0 * M_PI / 180.0);
    coat_case(1.5, 0.01, 45.0 * M_PI / 180.0);
    coat_case(1.8, 0.3, 30.0 * M_PI / 180.0);
}
END_TEST

/* A single direction in, another out: T T rho / (pi eta^2 (1 - rho R_i)). */
START_TEST(test_coat_under_distant_light)
{
    double eta = 1.5, thickness = 0.2, c = 3.0 / sqrt(74.0), light = 0.8, rho = 0.7;
    Coat coat = coat_integrals(eta, thickness);
    double got =
        analytic_mean(16, 2,
                      ANALYTIC_LOOK_AT_ORIGIN
                      "LightSource \"distant\" \"rgb L\" [ 2 2 2 ] \"point3 from\" [ -3 0 4 ] \"point3 to\" [ 0 0 0 ]\n"
                      "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.7 0.7 0.7 ] \"float thickness\" 0.2\n"
                      "Shape \"disk\" \"float radius\" 50");
    double expected = 2.0 * light * through(light, eta, thickness) * through(c, eta, thickness) * rho /
                      (M_PI * eta * eta * (1.0 - rho * coat.returned));
    analytic_check("coat under a distant light", got, expected, 1e-3);
}
END_TEST

TCase *analytic_opaque_case(void)
{
    TCase *tcase = tcase_create("opaque");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_mirrors);
    tcase_add_test(tcase, test_mirror_of_reflectance);
    tcase_add_test(tcase, test_rough_mirrors);
    tcase_add_test(tcase, test_mix);
    tcase_add_test(tcase, test_interface);
    tcase_add_test(tcase, test_alpha);
    tcase_add_test(tcase, test_invisible);
    tcase_add_test(tcase, test_coats_in_environment);
    tcase_add_test(tcase, test_coat_under_distant_light);
    return tcase;
}
