/* Point, spot and distant lights, and the meaning of "power", "illuminance", "scale" and "twosided". */
#include "support/analytic.h"

#define UNIT 0.5 / M_PI /* radiance of the plane per irradiance */

static double plane_under(unsigned samples, const char *light)
{
    return analytic_mean(samples, 2, ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE "%s", light);
}

/* ---- delta lights: no noise -------------------------------------------------------------------------------------- */

START_TEST(test_point)
{
    double r2 = 1.0 + 4.0 + 4.0, cosine = 2.0 / 3.0;
    analytic_check(
        "point, I and scale",
        plane_under(4, "LightSource \"point\" \"rgb I\" [ 3 3 3 ] \"float scale\" 2 \"point3 from\" [ -1 2 2 ]"),
        6.0 * cosine / r2 * UNIT, 1e-3);
    analytic_check(
        "point, power (I of 3 times the power)",
        plane_under(4, "LightSource \"point\" \"rgb I\" [ 3 3 3 ] \"float power\" 10 \"point3 from\" [ -1 2 2 ]"),
        3.0 * 10.0 / (4.0 * M_PI) * cosine / r2 * UNIT, 1e-3);
    analytic_check("point moved by a transform that scales",
                   plane_under(4, "Scale 2 2 2 Translate -0.5 1 1 LightSource \"point\" \"rgb I\" [ 3 3 3 ]"),
                   3.0 * cosine / r2 * UNIT, 1e-3);
}
END_TEST

/* Smooth step between the cosines of coneangle and of coneangle - conedeltaangle. */
static double spot_factor(double angle, double cone, double delta)
{
    double outer = cos(cone * M_PI / 180.0), inner = cos((cone - delta) * M_PI / 180.0);
    double t = fmin(1.0, fmax(0.0, (cos(angle) - outer) / (inner - outer)));
    return t * t * (3.0 - 2.0 * t);
}

/* Falloff at the origin for a spot 2 above it that points `degrees` to the side. */
static double spot_at(double degrees, const char *parameters)
{
    char light[300];
    snprintf(light, sizeof light,
             "LightSource \"spot\" \"point3 from\" [ 0 0 2 ] \"point3 to\" [ %.9g 0 0 ] \"rgb I\" [ 3 3 3 ] %s",
             -2.0 * tan(degrees * M_PI / 180.0), parameters);
    return plane_under(4, light) / (3.0 / 4.0 * UNIT);
}

START_TEST(test_spot)
{
    static const double ANGLES[] = {0.0, 20.0, 26.0, 27.5, 29.0, 30.5};
    for (int i = 0; i < 6; ++i) {
        char name[64];
        snprintf(name, sizeof name, "spot of 30 and 5 degrees at %g", ANGLES[i]);
        analytic_check(name, spot_at(ANGLES[i], ""), spot_factor(ANGLES[i] * M_PI / 180.0, 30.0, 5.0), 2e-3);
    }
    analytic_check("spot of 60 and 50 degrees at 40",
                   spot_at(40.0, "\"float coneangle\" 60 \"float conedeltaangle\" 50"),
                   spot_factor(40.0 * M_PI / 180.0, 60.0, 50.0), 1e-3);
    /* the power at intensity 1, by quadrature */
    double power = 0.0;
    for (int i = 0; i < 100000; ++i) {
        double angle = M_PI * (i + 0.5) / 100000.0;
        power += 2.0 * M_PI * sin(angle) * spot_factor(angle, 40.0, 25.0) * M_PI / 100000.0;
    }
    analytic_check("spot, power", spot_at(0.0, "\"float coneangle\" 40 \"float conedeltaangle\" 25 \"float power\" 7"),
                   7.0 / power, 1e-3);
}
END_TEST

START_TEST(test_distant)
{
    analytic_check(
        "distant, L and scale",
        plane_under(4, "LightSource \"distant\" \"rgb L\" [ 3 3 3 ] \"float scale\" 2 \"point3 from\" [ -3 0 4 ] "
                       "\"point3 to\" [ 0 0 0 ]"),
        6.0 * 0.8 * UNIT, 1e-3);
    analytic_check("distant, illuminance",
                   plane_under(4, "LightSource \"distant\" \"float illuminance\" 5 \"point3 from\" [ -3 0 4 ] "
                                  "\"point3 to\" [ 0 0 0 ]"),
                   5.0 * 0.8 * UNIT, 1e-3);
    analytic_check("distant, direction through a rotation",
                   plane_under(4, "Rotate 120 0 1 0 LightSource \"distant\" \"point3 from\" [ 0 0 0 ] "
                                  "\"point3 to\" [ 0 0 1 ]"),
                   0.5 * UNIT, 1e-3);
    analytic_check("distant, from below", plane_under(4, "LightSource \"distant\" \"point3 to\" [ 0 0 1 ]"), 0.0, 1e-6);
}
END_TEST

/* ---- area lights and environments -------------------------------------------------------------------------------- */

/* Power of a Lambertian surface: pi L area per side. The disk of radius r at height h gives an irradiance of pi L r^2 /
 * (r^2 + h^2). */
START_TEST(test_area_scales)
{
    static const struct {
        const char *name, *parameters;
        double radiance;
    } cases[] = {
        {"area, scale", "\"rgb L\" [ 2 2 2 ] \"float scale\" 3", 6.0},
        {"area, power", "\"float power\" 40", 40.0 / (M_PI * M_PI * 0.25)},
        {"area, power, two-sided", "\"float power\" 40 \"bool twosided\" true", 20.0 / (M_PI * M_PI * 0.25)},
        {"area, power and scale", "\"float power\" 40 \"float scale\" 2", 80.0 / (M_PI * M_PI * 0.25)},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char light[300];
        snprintf(
            light, sizeof light,
            "AreaLightSource \"diffuse\" %s\nTranslate 0 0 1 ReverseOrientation Shape \"disk\" \"float radius\" 0.5",
            cases[i].parameters);
        analytic_check(cases[i].name, plane_under(1024, light), cases[i].radiance * M_PI * 0.25 / 1.25 * UNIT,
                       ANALYTIC_TOLERANCE);
    }
}
END_TEST

/* A sphere of power P gives an irradiance of P / (4 pi d^2) at distance d, whatever its size. */
START_TEST(test_power_of_scaled_sphere)
{
    analytic_check("sphere of power 40 scaled by 0.3",
                   plane_under(1024, "Translate 0 0 2 Scale 0.3 0.3 0.3 AreaLightSource \"diffuse\" \"float power\" 40 "
                                     "Shape \"sphere\" \"float radius\" 2"),
                   40.0 / (16.0 * M_PI) * UNIT, ANALYTIC_TOLERANCE);
}
END_TEST

/* As in pbrt, every triangle of a mesh has the given power, hence its own radiance. */
START_TEST(test_power_of_mesh)
{
    const double large[3][3] = {{-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}}, small[3][3] = {{1, -1, 1}, {1, 0, 1}, {0, 0, 1}};
    double expected =
        10.0 / (2.0 * M_PI) * analytic_polygon(large, 3) + 10.0 / (0.5 * M_PI) * analytic_polygon(small, 3);
    analytic_check("two triangles of power 10",
                   plane_under(2048, "AreaLightSource \"diffuse\" \"float power\" 10 ReverseOrientation Shape "
                                     "\"trianglemesh\" \"point3 P\" [ -1 -1 1  1 -1 1  -1 1 1  1 0 1  0 0 1 ] "
                                     "\"integer indices\" [ 0 1 2 1 3 4 ]"),
                   expected * UNIT, ANALYTIC_TOLERANCE);
}
END_TEST

START_TEST(test_constant_environment)
{
    analytic_check("environment, L and scale",
                   plane_under(1024, "LightSource \"infinite\" \"rgb L\" [ 2 2 2 ] \"float scale\" 1.5"),
                   3.0 * M_PI * UNIT, ANALYTIC_TOLERANCE);
    analytic_check("environment, illuminance", plane_under(1024, "LightSource \"infinite\" \"float illuminance\" 5"),
                   5.0 * UNIT, ANALYTIC_TOLERANCE);
}
END_TEST

/* ---- blackbodies ------------------------------------------------------------------------------------------------- */

/* The CIE 1931 observer by the fits of Wyman, Sloan and Shirley 2013, accurate to about 1 % of the maximum. */
static double lobe(double wavelength, double mean, double below, double above)
{
    double t = (wavelength - mean) / (wavelength < mean ? below : above);
    return exp(-0.5 * t * t);
}

static void observer(double l, double xyz[3])
{
    xyz[0] =
        1.056 * lobe(l, 599.8, 37.9, 31.0) + 0.362 * lobe(l, 442.0, 16.0, 26.7) - 0.065 * lobe(l, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8);
}

/* Planck's law through the observer and the sRGB matrix, at luminance 1. */
static void planck_rgb(double kelvin, double rgb[3])
{
    static const double MATRIX[9] = {3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108,
                                     0.0415560, 0.0556434,  -0.2040259, 1.0572252};
    double xyz[3] = {0.0, 0.0, 0.0};
    for (double l = 360.0; l < 830.0; l += 1.0) {
        double m[3], radiance = 1e14 * pow(l, -5.0) / (exp(1.4387769e7 / (l * kelvin)) - 1.0);
        observer(l, m);
        for (int c = 0; c < 3; ++c)
            xyz[c] += m[c] * radiance;
    }
    for (int c = 0; c < 3; ++c)
        rgb[c] = (MATRIX[3 * c] * xyz[0] + MATRIX[3 * c + 1] * xyz[1] + MATRIX[3 * c + 2] * xyz[2]) / xyz[1];
}

START_TEST(test_blackbodies)
{
    static const double KELVINS[] = {2700.0, 4000.0, 6500.0, 9000.0};
    for (int i = 0; i < 4; ++i) {
        double mean[3], rgb[3];
        analytic_color(mean, 4, 1,
                       ANALYTIC_FILM "Camera \"perspective\" WorldBegin\n"
                                     "LightSource \"infinite\" \"blackbody L\" %g \"float scale\" 2",
                       KELVINS[i]);
        planck_rgb(KELVINS[i], rgb);
        for (int c = 0; c < 3; ++c) {
            char name[64];
            snprintf(name, sizeof name, "blackbody of %g K, %s", KELVINS[i],
                     c == 0   ? "red"
                     : c == 1 ? "green"
                              : "blue");
            analytic_check(name, mean[c], 2.0 * rgb[c], 0.03);
        }
        double luminance = 0.2126729 * mean[0] + 0.7151522 * mean[1] + 0.0721750 * mean[2];
        analytic_check("    its luminance", luminance, 2.0, 1e-3);
    }
}
END_TEST

TCase *analytic_lights_case(void)
{
    TCase *tcase = tcase_create("lights");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_point);
    tcase_add_test(tcase, test_spot);
    tcase_add_test(tcase, test_distant);
    tcase_add_test(tcase, test_area_scales);
    tcase_add_test(tcase, test_power_of_scaled_sphere);
    tcase_add_test(tcase, test_power_of_mesh);
    tcase_add_test(tcase, test_constant_environment);
    tcase_add_test(tcase, test_blackbodies);
    return tcase;
}
