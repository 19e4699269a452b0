/* Dielectrics: slabs, a sphere as a lens, radiance inside, and rough interfaces against integrals over microfacet
 * normals. */
#include "support/analytic.h"

#define SAMPLES 4096
/* A photon is either reflected or not: with 262144 samples the standard error is up to 0.001 of the whole. */
#define SPLIT_TOLERANCE 0.0025
#define QUAD "Shape \"bilinearmesh\" \"point3 P\" "

/* ---- slabs ------------------------------------------------------------------------------------------------------- */

/* Transmittance and reflectance of a slab at z = 0 that fills the view: the half space below emits red, the one above
 * green, both with radiance 1. The camera looks down at `angle`. */
static void slab(const char *material, bool solid, double angle, double *transmitted, double *reflected)
{
    double s = 20.0 * sin(angle), c = 20.0 * cos(angle), mean[3];
    analytic_color(mean, SAMPLES, 200,
                   ANALYTIC_FILM "LookAt %.9g 0 %.9g  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 0.05\n"
                                 "WorldBegin\nAttributeBegin ReverseOrientation\n"
                                 "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
                                 "AreaLightSource \"diffuse\" \"rgb L\" [ 1 0 0 ]\n"
                                 "Shape \"sphere\" \"float radius\" 90 \"float zmax\" 0\n"
                                 "AreaLightSource \"diffuse\" \"rgb L\" [ 0 1 0 ]\n"
                                 "Shape \"sphere\" \"float radius\" 90 \"float zmin\" 0\nAttributeEnd\n"
                                 "%s\n" QUAD "[ -80 -80 0  80 -80 0  -80 80 0  80 80 0 ]\n%s",
                   s, c, material,
                   solid ? "ReverseOrientation " QUAD "[ -80 -80 -1  80 -80 -1  -80 80 -1  80 80 -1 ]" : "");
    *transmitted = mean[0];
    *reflected = mean[1];
}

/* Sums over all internal reflections: R = 2 F / (1 + F), T = (1 - F) / (1 + F), for light that is unpolarised at every
 * interface. */
START_TEST(test_slabs)
{
    static const double ANGLES[] = {0.0, 45.0, 75.0}, ETAS[] = {1.5, 2.4};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j)
            for (int thin = 0; thin < 2; ++thin) {
                char material[100], name[100];
                double angle = ANGLES[i] * M_PI / 180.0, f = analytic_fresnel(cos(angle), ETAS[j]);
                double transmitted, reflected;
                const char *kind = thin ? "thindielectric" : "dielectric";
                snprintf(material, sizeof material, "Material \"%s\" \"float eta\" %g", kind, ETAS[j]);
                snprintf(name, sizeof name, "%s %g at %g degrees: transmitted", kind, ETAS[j], ANGLES[i]);
                slab(material, !thin, angle, &transmitted, &reflected);
                analytic_check(name, transmitted, (1.0 - f) / (1.0 + f), SPLIT_TOLERANCE * (1.0 + f) / (1.0 - f));
                snprintf(name, sizeof name, "%s %g at %g degrees: reflected", kind, ETAS[j], ANGLES[i]);
                analytic_check(name, reflected, 2.0 * f / (1.0 + f), SPLIT_TOLERANCE * (1.0 + f) / (2.0 * f));
            }
}
END_TEST

/* ---- the ball as a lens ------------------------------------------------------------------------------------------ */

/* A ray parallel to the axis of a unit ball at height h leaves it deflected by 2 (i - t), with sin i = h, sin t = h /
 * eta, at an angle of 2 t - i from the far pole. A small light is placed where it intersects the plane three units
 * behind the centre. */
START_TEST(test_ball_lens)
{
    static const double HEIGHTS[] = {0.2, 0.5, 0.8};
    for (int i = 0; i < 3; ++i) {
        double h = HEIGHTS[i], in = asin(h), t = asin(h / 1.5), leave = 2.0 * t - in, turn = 2.0 * (in - t);
        double x = sin(leave), z = cos(leave), at = x - tan(turn) * (3.0 - z);
        double got = analytic_mean(
            1024, 3,
            ANALYTIC_FILM "LookAt %.9g 0 -5  %.9g 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" "
                          "[ -1e-3 1e-3 -1e-3 1e-3 ]\nWorldBegin\nMaterial \"dielectric\" \"float eta\" 1.5\n"
                          "Shape \"sphere\"\nMaterial \"diffuse\"\nAreaLightSource \"diffuse\" \"bool twosided\" true\n"
                          "Translate %.9g 0 3 Shape \"disk\" \"float radius\" 0.02",
            h, h, at);
        char name[64];
        double f = analytic_fresnel(cos(in), 1.5);
        snprintf(name, sizeof name, "ball lens, ray at height %g", h);
        analytic_check(name, got, (1.0 - f) * (1.0 - f), ANALYTIC_TOLERANCE);
    }
}
END_TEST

/* ---- inside ------------------------------------------------------------------------------------------------------ */

/* Radiance inside is eta^2 times that outside: the camera is in a glass ball in a furnace, in its centre and at a point
 * where light in some directions is totally reflected forever. */
START_TEST(test_furnace_inside)
{
    double got = analytic_mean(SAMPLES, 100,
                               ANALYTIC_FILM "Camera \"perspective\" \"float fov\" 90\nWorldBegin\n"
                                             "LightSource \"infinite\"\nMaterial \"dielectric\" \"float eta\" 1.5\n"
                                             "Shape \"sphere\" \"float radius\" 2");
    analytic_check("furnace seen from inside a ball of glass", got, 2.25, ANALYTIC_TOLERANCE);
}
END_TEST

/* One interface seen from inside, with a light behind it; beyond the critical angle of 41.8 degrees it is invisible. */
START_TEST(test_total_reflection)
{
    static const double ANGLES[] = {0.0, 30.0, 40.0, 43.0, 60.0};
    for (int i = 0; i < 5; ++i) {
        double angle = ANGLES[i] * M_PI / 180.0;
        double got = analytic_mean(
            SAMPLES, 3,
            ANALYTIC_FILM "LookAt %.9g 0 %.9g  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 0.05\nWorldBegin\n"
                          "AttributeBegin Translate 0 0 20\nAreaLightSource \"diffuse\" \"bool twosided\" true "
                          "Shape \"disk\" \"float radius\" 1000 AttributeEnd\n"
                          "Material \"dielectric\" \"float eta\" 1.5\n" QUAD
                          "[ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ]",
            -10.0 * sin(angle), -10.0 * cos(angle));
        char name[64];
        snprintf(name, sizeof name, "out of glass at %g degrees", ANGLES[i]);
        analytic_check(name, got, 2.25 * (1.0 - analytic_fresnel(cos(angle), 1.0 / 1.5)), ANALYTIC_TOLERANCE);
    }
}
END_TEST

/* A black lamp of radiance 1 deep in glass, seen from outside. */
START_TEST(test_lamp_in_glass)
{
    double angle = M_PI / 4.0;
    double got = analytic_mean(
        SAMPLES, 3,
        ANALYTIC_FILM "LookAt 10 0 10  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 0.05\n"
                      "WorldBegin\nAttributeBegin Translate 0 0 -5\nMaterial \"diffuse\" \"rgb "
                      "reflectance\" [ 0 0 0 ]\nAreaLightSource \"diffuse\" Shape \"disk\" \"float "
                      "radius\" 90 AttributeEnd\n"
                      "Material \"dielectric\" \"float eta\" 1.5\n" QUAD "[ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ]");
    analytic_check("lamp in glass seen from outside", got, (1.0 - analytic_fresnel(cos(angle), 1.5)) / 2.25,
                   ANALYTIC_TOLERANCE);
}
END_TEST

/* ---- rough interfaces -------------------------------------------------------------------------------------------- */

static double smith_lambda(double cosine, double alpha)
{
    double tangent2 = 1.0 / (cosine * cosine) - 1.0;
    return 0.5 * (sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

/* Reflectance and transmittance (as power) of a GGX interface for light arriving at `cosine`: the integral over visible
 * normals m of F G(o, i) / G1(o), with the height-correlated G of Walter et al. 2007 and Heitz 2014; single
 * scattering. */
static void rough_interface(double cosine, double eta, double alpha, double *reflected, double *transmitted)
{
    enum { COUNT = 400 };
    double o[3] = {sqrt(1.0 - cosine * cosine), 0.0, cosine}, lambda_o = smith_lambda(cosine, alpha);
    *reflected = *transmitted = 0.0;
    for (int j = 0; j < COUNT; ++j)
        for (int i = 0; i < COUNT / 2; ++i) {
            /* tan^2 = alpha^2 w / (1 - w) distributes D cos m uniformly over w; q^2 = 1 - w, because the integrand
             * grows like 1 / cos m. */
            double q = (j + 0.5) / COUNT, phi = M_PI * (i + 0.5) / (COUNT / 2);
            double tangent2 = alpha * alpha * (1.0 / (q * q) - 1.0), mz = 1.0 / sqrt(1.0 + tangent2),
                   mx = sqrt(tangent2) * mz;
            double om = o[0] * mx * cos(phi) + o[2] * mz;
            if (om <= 0.0)
                continue;
            double share = 2.0 * q * om / mz / cosine / ((double)COUNT * (COUNT / 2));
            double f = analytic_fresnel(om, eta), iz = 2.0 * om * mz - o[2];
            if (iz > 0.0)
                *reflected += share * f / (1.0 + lambda_o + smith_lambda(iz, alpha));
            if (f < 1.0) {
                double ct = sqrt(1.0 - (1.0 - om * om) / (eta * eta)), tz = (om / eta - ct) * mz - o[2] / eta;
                if (tz < 0.0)
                    *transmitted += share * (1.0 - f) / (1.0 + lambda_o + smith_lambda(-tz, alpha));
            }
        }
}

/* A single interface between two half spaces, of which one emits. */
START_TEST(test_rough_interfaces)
{
    static const double ANGLES[] = {0.0, 60.0}, ALPHAS[] = {0.1, 0.4, 0.8}, ETA = 1.5;
    for (int from_inside = 0; from_inside < 2; ++from_inside)
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 3; ++j) {
                double eta = from_inside ? 1.0 / ETA : ETA, angle = ANGLES[i] * M_PI / 180.0, r, t;
                double transmitted, reflected;
                rough_interface(cos(angle), eta, ALPHAS[j], &r, &t);
                char material[128], name[100];
                snprintf(material, sizeof material,
                         "Rotate %d 1 0 0\nMaterial \"dielectric\" \"float eta\" 1.5 \"float roughness\" %g "
                         "\"bool remaproughness\" false",
                         from_inside ? 180 : 0, ALPHAS[j]);
                const char *side = from_inside ? "from glass" : "from air";
                snprintf(name, sizeof name, "alpha %g, %s, %g degrees: reflected", ALPHAS[j], side, ANGLES[i]);
                slab(material, false, angle, &transmitted, &reflected);
                analytic_check(name, reflected, r, SPLIT_TOLERANCE / r);
                snprintf(name, sizeof name, "alpha %g, %s, %g degrees: transmitted", ALPHAS[j], side, ANGLES[i]);
                analytic_check(name, transmitted, t / (eta * eta), SPLIT_TOLERANCE / t);
                fprintf(stderr, "    alpha %g, %s, %g degrees: %.2f %% lost\n", ALPHAS[j], side, ANGLES[i],
                        100.0 * (1.0 - r - t));
            }
}
END_TEST

TCase *analytic_glass_case(void)
{
    TCase *tcase = tcase_create("glass");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_slabs);
    tcase_add_test(tcase, test_ball_lens);
    tcase_add_test(tcase, test_furnace_inside);
    tcase_add_test(tcase, test_total_reflection);
    tcase_add_test(tcase, test_lamp_in_glass);
    tcase_add_test(tcase, test_rough_interfaces);
    return tcase;
}
