/* Values against textbook formulas, evaluated in double precision in the textbooks' form. */
#include "support/bsdf_cases.h"

#include <complex.h>

#define IMAGINARY ((double complex)I)

/* Fresnel's amplitude equations for a complex index (Born and Wolf 1.5.2). */
static double textbook_fresnel(double cos_i, double complex index)
{
    double complex sin_t = sqrt(fmax(0.0, 1.0 - cos_i * cos_i)) / index;
    double complex cos_t = csqrt(1.0 - sin_t * sin_t);
    double complex r_p = (index * cos_i - cos_t) / (index * cos_i + cos_t);
    double complex r_s = (cos_i - index * cos_t) / (cos_i + index * cos_t);
    return 0.5 * (creal(r_p * conj(r_p)) + creal(r_s * conj(r_s)));
}

typedef struct Double3 {
    double x, y, z;
} Double3;

static double dot3(Double3 a, Double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* The unit vector of which v is the rounding: Snell's law holds for unit vectors only. */
static Double3 double3(Vec3 v)
{
    Double3 w = {(double)v.x, (double)v.y, (double)v.z};
    double length = sqrt(dot3(w, w));
    return (Double3){w.x / length, w.y / length, w.z / length};
}

/* D(m) through slopes (Heitz 2014, eq. 85). */
static double textbook_density(Double3 m, double alpha_x, double alpha_y)
{
    if (m.z <= 0.0)
        return 0.0;
    double slope_x = -m.x / m.z, slope_y = -m.y / m.z;
    double e = 1.0 + slope_x * slope_x / (alpha_x * alpha_x) + slope_y * slope_y / (alpha_y * alpha_y);
    return 1.0 / (TEST_PI * alpha_x * alpha_y * e * e * pow(m.z, 4.0));
}

/* Lambda (Heitz 2014, eq. 86 with eq. 80 for two alphas). */
static double textbook_lambda(Double3 w, double alpha_x, double alpha_y)
{
    double tangent2 = (w.x * w.x * alpha_x * alpha_x + w.y * w.y * alpha_y * alpha_y) / (w.z * w.z);
    return 0.5 * (sqrt(1.0 + tangent2) - 1.0);
}

typedef struct TextbookValue {
    double f_cos, pdf_w;
} TextbookValue;

static Double3 double3_face(Double3 m)
{
    double scale = (m.z < 0.0 ? -1.0 : 1.0) / sqrt(dot3(m, m));
    return (Double3){m.x * scale, m.y * scale, m.z * scale};
}

/* Walter et al. 2007, eq. 20 and 14, with the sampling of visible normals. `index` is relative to wo's side. */
static TextbookValue textbook_reflection(Double3 wo, Double3 wi, double ax, double ay, double complex index,
                                         bool choose)
{
    Double3 m = double3_face((Double3){wo.x + wi.x, wo.y + wi.y, wo.z + wi.z});
    double fresnel = textbook_fresnel(fabs(dot3(wo, m)), index);
    double lambda_o = textbook_lambda(wo, ax, ay), lambda_i = textbook_lambda(wi, ax, ay);
    double density = textbook_density(m, ax, ay);
    TextbookValue value;
    value.f_cos = fresnel * density / (1.0 + lambda_o + lambda_i) / (4.0 * fabs(wo.z));
    double visible = fabs(dot3(wo, m)) * density / ((1.0 + lambda_o) * fabs(wo.z));
    value.pdf_w = visible / (4.0 * fabs(dot3(wo, m))) * (choose ? fresnel : 1.0);
    return value;
}

/* Walter et al. 2007, eq. 16, 17 and 21: eta_i, eta_o are absolute; f for radiance, which is that for importance times
 * (eta_o / eta_i)^2. */
static TextbookValue textbook_refraction(Double3 wo, Double3 wi, double ax, double ay, double eta_o, double eta_i)
{
    Double3 h = {-(eta_o * wo.x + eta_i * wi.x), -(eta_o * wo.y + eta_i * wi.y), -(eta_o * wo.z + eta_i * wi.z)};
    Double3 m = double3_face(h);
    double om = dot3(wo, m), im = dot3(wi, m);
    if (om * wo.z <= 0.0 || im * wi.z <= 0.0)
        return (TextbookValue){0.0, 0.0};
    double transmittance = 1.0 - textbook_fresnel(fabs(om), eta_i / eta_o);
    double lambda_o = textbook_lambda(wo, ax, ay), lambda_i = textbook_lambda(wi, ax, ay);
    double density = textbook_density(m, ax, ay), denominator = pow(eta_i * im + eta_o * om, 2.0);
    double masking = 1.0 / (1.0 + lambda_o + lambda_i);
    TextbookValue value;
    value.f_cos = fabs(om * im / wo.z) * eta_o * eta_o * transmittance * masking * density / denominator;
    double visible = fabs(om) * density / ((1.0 + lambda_o) * fabs(wo.z));
    value.pdf_w = visible * eta_i * eta_i * fabs(im) / denominator * transmittance;
    return value;
}

START_TEST(test_fresnel_dielectric)
{
    static const float ETAS[] = {1.5f, 1.0f / 1.5f, 1.33f, 2.4f, 1.001f, 0.999f, 1e-2f, 100.0f};
    for (int e = 0; e < 8; ++e)
        for (int n = 0; n <= 20000; ++n) {
            float c = (float)n / 20000.0f;
            double exact = textbook_fresnel((double)c, (double)ETAS[e]);
            double critical = 1.0 - (1.0 - (double)c * (double)c) / ((double)ETAS[e] * (double)ETAS[e]);
            double tolerance = 2e-6 + 2e-6 / sqrt(fmax(fabs(critical), 1e-7)); /* dF/dc is infinite there */
            REQUIRE(fabs((double)fresnel_dielectric(c, ETAS[e]) - exact) < tolerance);
        }
    for (int n = 0; n <= 1000; ++n)
        REQUIRE(fresnel_dielectric((float)n / 1000.0f, 1.0f) == 0.0f);
    REQUIRE(fresnel_dielectric(0.0f, 1.5f) == 1.0f);
    REQUIRE(fresnel_dielectric(0.5f, 1.0f / 1.5f) == 1.0f); /* 60 degrees, beyond the critical 41.8 */
    REQUIRE(fabs((double)fresnel_dielectric(1.0f, 1.5f) - 0.04) < 1e-7);
    double brewster = 1.0 / sqrt(1.0 + 1.5 * 1.5), s = (1.5 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0);
    REQUIRE(fabs((double)fresnel_dielectric((float)brewster, 1.5f) - 0.5 * s * s) < 1e-6);
}
END_TEST

START_TEST(test_fresnel_conductor)
{
    static const float ETA[] = {0.2f, 0.143f, 1.65f, 3.1f, 1.0f, 1.5f, 0.05f, 1.0f};
    static const float K[] = {3.91f, 3.98f, 9.22f, 3.3f, 200.0f, 0.0f, 1e-4f, 0.01f};
    for (int m = 0; m < 8; ++m)
        for (int n = 0; n <= 20000; ++n) {
            float c = (float)n / 20000.0f;
            double exact = textbook_fresnel((double)c, (double)ETA[m] + (double)K[m] * IMAGINARY);
            double critical = 1.0 - (1.0 - (double)c * (double)c) / pow((double)ETA[m], 2.0);
            double tolerance = 4e-6 + (K[m] < 0.1f ? 4e-6 / sqrt(fmax(fabs(critical), 1e-7)) : 0.0);
            double value = (double)fresnel_conductor(c, ETA[m], K[m]);
            REQUIRE_MSG(fabs(value - exact) < tolerance, "index %g + %g i, cos %g: %.9g instead of %.9g",
                        (double)ETA[m], (double)K[m], (double)c, value, exact);
        }
    for (int n = 0; n <= 100; ++n) { /* k = 0: a dielectric */
        float c = (float)n / 100.0f;
        REQUIRE(fabs((double)(fresnel_conductor(c, 1.5f, 0.0f) - fresnel_dielectric(c, 1.5f))) < 1e-6);
    }
    REQUIRE(float_finite(fresnel_conductor(0.0f, 1.0f, 0.0f)) && float_finite(fresnel_conductor(1.0f, 0.0f, 0.0f)));
}
END_TEST

/* A conductor derived from a reflectance has that reflectance at normal incidence. */
START_TEST(test_conductor_reflectance)
{
    for (int n = 0; n <= 1000; ++n) {
        float r = (float)n / 1000.0f;
        Vec3 f = fresnel_conductor_reflectance(1.0f, vec3(r, 0.5f, 0.0f));
        REQUIRE(fabs((double)f.x - fmin((double)r, 0.9999)) < 2e-6);
        REQUIRE(fabs((double)f.y - 0.5) + fabs((double)f.z) < 2e-6);
        double k = 2.0 * sqrt(0.5) / sqrt(1.0 - 0.5);
        double exact = textbook_fresnel((double)r, 1.0 + k * IMAGINARY);
        REQUIRE(fabs((double)fresnel_conductor_reflectance(r, vec3_splat(0.5f)).x - exact) < 4e-6);
    }
}
END_TEST

static void value_check(BsdfValue value, TextbookValue exact, double tolerance, const char *what)
{
    REQUIRE_MSG(fabs((double)value.f_cos.x - exact.f_cos) <= tolerance * exact.f_cos + 1e-12 &&
                    fabs((double)value.pdf_w - exact.pdf_w) <= tolerance * exact.pdf_w + 1e-12,
                "%s: f cos %.9g, pdf %.9g instead of %.9g, %.9g", what, (double)value.f_cos.x, (double)value.pdf_w,
                exact.f_cos, exact.pdf_w);
}

/* wi is a sampled direction, so that narrow lobes are compared where they are not zero. */
START_TEST(test_microfacets_against_textbook)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {11};
    for (int n = 0; n < 300000; ++n) {
        const struct TestAlpha alpha = TEST_ALPHAS[2 + n % (TEST_ALPHA_COUNT - 2)];
        bool conductor = n & 1;
        float index = n & 2 ? 1.5f : 0.7f;
        Bsdf bsdf = test_bsdf(&scene, conductor ? MATERIAL_CONDUCTOR : MATERIAL_DIELECTRIC, alpha.x, alpha.y, index,
                              0.2f, 3.91f);
        Vec3 wo = random_direction(&random, (n & 4 ? 1.0 : -1.0) * (0.05 + 0.95 * random_double(&random)));
        Vec3 wi = random_direction(&random, 2.0 * random_double(&random) - 1.0);
        BsdfSample sample;
        float u_lobe = random_float24(&random);
        Vec2 u = random_vec2(&random);
        if ((n & 8) && bsdf_sample(&scene.view, &bsdf, wo, u_lobe, u, TRANSPORT_RADIANCE, &sample))
            wi = sample.wi;
        if (fabsf(wi.z) < 0.01f)
            continue;
        bool reflected = wo.z * wi.z > 0.0f;
        BsdfValue value = bsdf_eval(&scene.view, &bsdf, wo, wi, TRANSPORT_RADIANCE);
        Double3 o = double3(wo), i = double3(wi);
        double ax = (double)alpha.x, ay = (double)alpha.y;
        double eta_o = wo.z > 0.0f ? 1.0 : (double)index, eta_i = wo.z > 0.0f ? (double)index : 1.0;
        TextbookValue exact = {0.0, 0.0};
        Double3 h = {o.x + i.x, o.y + i.y, o.z + i.z};
        if (!reflected)
            h = (Double3){eta_o * o.x + eta_i * i.x, eta_o * o.y + eta_i * i.y, eta_o * o.z + eta_i * i.z};
        double length = sqrt(dot3(h, h));
        double graze = fmin(fabs(dot3(o, h)), fabs(dot3(i, h))) / length;
        double tolerance = 2e-5 + 2e-6 / (length * fmin(fmin(ax, ay), graze)); /* cancellation in the half vector */
        if (reflected) {
            exact = textbook_reflection(o, i, ax, ay, conductor ? 0.2 + 3.91 * IMAGINARY : eta_i / eta_o, !conductor);
            double cos_m = 0.5 * length, critical = fabs(1.0 - (1.0 - cos_m * cos_m) * pow(eta_o / eta_i, 2.0));
            tolerance += conductor ? 0.0 : 4e-6 / sqrt(fmax(critical, 1e-7));
        } else if (!conductor) {
            exact = textbook_refraction(o, i, ax, ay, eta_o, eta_i);
        }
        value_check(value, exact, tolerance, conductor ? "conductor" : reflected ? "reflection" : "refraction");
    }
    test_scene_destroy(&scene);
}
END_TEST

START_TEST(test_thin_dielectric)
{
    TestScene scene;
    test_scene_init(&scene);
    Bsdf bsdf = test_bsdf(&scene, MATERIAL_THIN_DIELECTRIC, 0.0f, 0.0f, 1.5f, 0.0f, 0.0f);
    for (int n = 1; n <= 1000; ++n) {
        Vec3 wo = test_direction(90.0 * (1000 - n) / 1000.0, 1.0);
        double r = textbook_fresnel((double)wo.z, 1.5), t = 1.0 - r, sum = r, term = t * t * r;
        for (int k = 0; k < 20000 && term > 1e-12; ++k, term *= r * r)
            sum += term;
        BsdfSample sample;
        REQUIRE(bsdf_sample(&scene.view, &bsdf, wo, 0.0f, vec2(0.5f, 0.5f), TRANSPORT_RADIANCE, &sample));
        REQUIRE(!sample.transmitted && sample.delta);
        REQUIRE(fabs((double)sample.pdf_w - sum) < 1e-5);
        REQUIRE(bsdf_sample(&scene.view, &bsdf, wo, 0.9999999f, vec2(0.5f, 0.5f), TRANSPORT_RADIANCE, &sample));
        REQUIRE(sample.transmitted && sample.wi.x == -wo.x && sample.wi.z == -wo.z && sample.eta == 1.0f);
        REQUIRE(fabs((double)sample.pdf_w - (1.0 - sum)) < 1e-5);
    }
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_formula_tests(void)
{
    TCase *tcase = tcase_create("formulas");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_fresnel_dielectric);
    tcase_add_test(tcase, test_fresnel_conductor);
    tcase_add_test(tcase, test_conductor_reflectance);
    tcase_add_test(tcase, test_microfacets_against_textbook);
    tcase_add_test(tcase, test_thin_dielectric);
    return tcase;
}
