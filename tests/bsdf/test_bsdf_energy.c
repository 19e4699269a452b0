/* White furnace: no BSDF gains energy, and a rough one loses only what single scattering loses. */
#include "support/bsdf_cases.h"

#define POINTS 65536

/* Mean weight over the unit cube by Roberts' R3 sequence; TRANSPORT_IMPORTANCE, so that refraction does not scale. */
static double albedo(const TestScene *scene, const Bsdf *bsdf, Vec3 wo)
{
    const double g = 1.2207440846057596;
    double sum = 0.0;
    for (int n = 0; n < POINTS; ++n) {
        double a = fmod(0.5 + n / g, 1.0), b = fmod(0.5 + n / (g * g), 1.0), c = fmod(0.5 + n / (g * g * g), 1.0);
        Vec2 u = vec2((float)(b * (1.0 - 1e-7)), (float)(c * (1.0 - 1e-7)));
        BsdfSample sample;
        if (bsdf_sample(&scene->view, bsdf, wo, (float)(a * (1.0 - 1e-7)), u, TRANSPORT_IMPORTANCE, &sample))
            sum += (double)sample.weight.y;
    }
    return sum / POINTS;
}

/* BSDFs without microfacets lose nothing. */
START_TEST(test_smooth_furnace)
{
    static const struct {
        uint kind;
        float eta, color0, color1;
    } WHITE[] = {{MATERIAL_DIFFUSE, 1.0f, 1.0f, 0.0f},         {MATERIAL_DIFFUSE_TRANSMISSION, 1.0f, 0.4f, 0.6f},
                 {MATERIAL_DIELECTRIC, 1.5f, 0.0f, 0.0f},      {MATERIAL_DIELECTRIC, 1.0f, 0.0f, 0.0f},
                 {MATERIAL_THIN_DIELECTRIC, 1.5f, 0.0f, 0.0f}, {MATERIAL_COATED_DIFFUSE, 1.5f, 1.0f, 0.0f},
                 {MATERIAL_COATED_DIFFUSE, 1.05f, 1.0f, 0.0f}, {MATERIAL_COATED_DIFFUSE, 2.5f, 1.0f, 0.0f},
                 {MATERIAL_COATED_DIFFUSE, 0.8f, 1.0f, 0.0f},  {MATERIAL_COATED_DIFFUSE, 1.0f, 1.0f, 0.0f}};
    TestScene scene;
    test_scene_init(&scene);
    for (int k = 0; k < 10; ++k)
        for (int d = 0; d < TEST_WO_COUNT; ++d) {
            Bsdf bsdf = test_bsdf(&scene, WHITE[k].kind, 0.0f, 0.0f, WHITE[k].eta, WHITE[k].color0, WHITE[k].color1);
            double a = albedo(&scene, &bsdf, test_wo(d));
            double tolerance = WHITE[k].eta < 1.0f ? 5e-3 : 1e-3; /* discontinuous at the critical angle */
            REQUIRE_MSG(fabs(a - 1.0) < tolerance, "kind %u, eta %g, direction %d: albedo %g", WHITE[k].kind,
                        (double)WHITE[k].eta, d, a);
        }
    test_scene_destroy(&scene);
}
END_TEST

/* Lowest albedo over directions that single scattering may have, for TEST_ALPHAS[1...]. Conductor: reflectance 1.
 * Dielectric 1.5, from both sides. Coated: eta 1.5, rho = 1. */
static const double LEAST_CONDUCTOR[] = {1.0, 0.9017, 0.9629, 0.8952, 0.8152, 0.3068, 0.8521};
static const double LEAST_DIELECTRIC[] = {1.0, 0.9053, 0.9662, 0.9397, 0.7668, 0.4656, 0.8520};
static const double LEAST_COATED[] = {1.0, 0.9175, 0.9742, 0.9441, 0.9016, 0.7087, 0.8927};

static void furnace_check(const TestScene *scene, const Bsdf *bsdf, const char *name, double least)
{
    double low = 2.0, high = 0.0;
    for (int d = 0; d < TEST_WO_COUNT; ++d) {
        double a = albedo(scene, bsdf, test_wo(d));
        low = fmin(low, a);
        high = fmax(high, a);
    }
    printf("# %s, alpha %g %g: albedo %.4f ... %.4f\n", name, (double)bsdf->alpha_x, (double)bsdf->alpha_y, low, high);
    REQUIRE_MSG(high < 1.0 + 1e-3, "%s, alpha %g %g: albedo %g", name, (double)bsdf->alpha_x, (double)bsdf->alpha_y,
                high);
    REQUIRE_MSG(fabs(low - least) < 5e-3, "%s, alpha %g %g: least albedo %g", name, (double)bsdf->alpha_x,
                (double)bsdf->alpha_y, low);
}

START_TEST(test_rough_furnace)
{
    TestScene scene;
    test_scene_init(&scene);
    for (int a = 1; a < TEST_ALPHA_COUNT; ++a) {
        float x = TEST_ALPHAS[a].x, y = TEST_ALPHAS[a].y;
        Bsdf conductor = test_bsdf(&scene, MATERIAL_CONDUCTOR, x, y, 1.0f, 1.0f, 0.0f);
        conductor.flags |= BSDF_REFLECTANCE;
        Bsdf dielectric = test_bsdf(&scene, MATERIAL_DIELECTRIC, x, y, 1.5f, 0.0f, 0.0f);
        Bsdf coated = test_bsdf(&scene, MATERIAL_COATED_DIFFUSE, x, y, 1.5f, 1.0f, 0.0f);
        furnace_check(&scene, &conductor, "conductor", LEAST_CONDUCTOR[a]);
        furnace_check(&scene, &dielectric, "dielectric", LEAST_DIELECTRIC[a]);
        furnace_check(&scene, &coated, "coated", LEAST_COATED[a]);
    }
    test_scene_destroy(&scene);
}
END_TEST

/* At normal incidence and F = 1 the albedo is a single integral over the normal's angle t, with wi at 2 t:
 * integral of D(t) cos(t) G(2t) 2 pi sin(t) dt, t < pi/4, G = 1 / (1 + Lambda) = 2 / (1 + sqrt(1 + a^2 tan^2 2t)). */
static double normal_albedo(double alpha)
{
    const int cells = 200000;
    double sum = 0.0;
    for (int k = 0; k < cells; ++k) {
        double u = (k + 0.5) / cells; /* quantile of the normal distribution: tan^2 t = alpha^2 u / (1 - u) */
        double t = atan(alpha * sqrt(u / (1.0 - u)));
        if (t < TEST_PI / 4.0)
            sum += 2.0 / (1.0 + sqrt(1.0 + pow(alpha * tan(2.0 * t), 2.0)));
    }
    return sum / cells;
}

START_TEST(test_conductor_albedo_at_normal_incidence)
{
    TestScene scene;
    test_scene_init(&scene);
    for (int a = 1; a < TEST_ALPHA_COUNT - 1; ++a) {
        Bsdf bsdf = test_bsdf(&scene, MATERIAL_CONDUCTOR, TEST_ALPHAS[a].x, TEST_ALPHAS[a].y, 1.0f, 1.0f, 0.0f);
        bsdf.flags |= BSDF_REFLECTANCE;
        double exact = 0.9999 * normal_albedo((double)TEST_ALPHAS[a].x);
        REQUIRE(fabs(albedo(&scene, &bsdf, vec3(0.0f, 0.0f, 1.0f)) - exact) < 1e-3);
    }
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_energy_tests(void)
{
    TCase *tcase = tcase_create("energy");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_smooth_furnace);
    tcase_add_test(tcase, test_rough_furnace);
    tcase_add_test(tcase, test_conductor_albedo_at_normal_incidence);
    return tcase;
}
