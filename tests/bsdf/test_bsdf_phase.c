/* The phase function: its density against the formula in double and against its own samples. */
#include "support/bsdf_cases.h"

static const double G[] = {0.0, 0.3, -0.5, 0.9, -0.97, 0.999, 0.9999999};
enum { G_COUNT = 7 };

/* Henyey and Greenstein 1941, at 1 - cos = versine from the foremost direction. */
static double phase_exact(double g, double versine)
{
    double a = fabs(g);
    return (1.0 - a * a) / (4.0 * TEST_PI * pow((1.0 - a) * (1.0 - a) + 2.0 * a * versine, 1.5));
}

/* Fraction of directions whose versine is at most v: the integral of 2 pi times the density. */
static double phase_below(double g, double v)
{
    double a = fabs(g);
    if (a < 1e-6)
        return 0.5 * v;
    return (1.0 - a * a) / (2.0 * a) * (1.0 / (1.0 - a) - 1.0 / sqrt((1.0 - a) * (1.0 - a) + 2.0 * a * v));
}

START_TEST(test_phase_density)
{
    TestScene scene;
    test_scene_init(&scene);
    for (int i = 0; i < G_COUNT; ++i)
        for (int k = 0; k <= 60; ++k) {
            Bsdf bsdf = phase_bsdf((float)G[i]);
            double angle = TEST_PI * pow(10.0, -k / 10.0), g = (double)(float)G[i];
            Vec3 wi = vec3((float)sin(angle), 0.0f, (float)(g > 0.0 ? -cos(angle) : cos(angle)));
            double sine = sin(0.5 * asin(fmin(1.0, (double)wi.x)));
            double versine = fabs(angle) < 1.0 ? 2.0 * sine * sine : 1.0 - cos(angle);
            BsdfValue value = bsdf_eval(&scene.view, &bsdf, vec3(0.0f, 0.0f, 1.0f), wi, TRANSPORT_RADIANCE);
            double exact = phase_exact(g, versine);
            REQUIRE_MSG(fabs((double)value.pdf_w - exact) <= 1e-5 * exact, "g %g, angle %g: %g, not %g", g, angle,
                        (double)value.pdf_w, exact);
            REQUIRE(value.pdf_rev_w == value.pdf_w && value.f_cos.x == value.pdf_w && value.f_cos.z == value.pdf_w);
        }
    test_scene_destroy(&scene);
}
END_TEST

/* The distribution of the versine, in cells of equal probability, and of the azimuth. */
START_TEST(test_phase_samples)
{
    enum { CELLS = 50, SAMPLES = 100000 };
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {7};
    for (int i = 0; i < G_COUNT; ++i) {
        Bsdf bsdf = phase_bsdf((float)G[i]);
        double g = (double)(float)G[i], chi = 0.0, around[2] = {0.0, 0.0};
        int counts[CELLS] = {0};
        for (int n = 0; n < SAMPLES; ++n) {
            BsdfSample sample;
            REQUIRE(bsdf_sample(&scene.view, &bsdf, vec3(0.0f, 0.0f, 1.0f), 0.5f, random_vec2(&random),
                                TRANSPORT_RADIANCE, &sample));
            Vec3 wi = sample.wi;
            double z = g > 0.0 ? 1.0 + (double)wi.z : 1.0 - (double)wi.z;
            double versine = 0.5 * ((double)wi.x * (double)wi.x + (double)wi.y * (double)wi.y + z * z);
            double sine = sqrt((double)wi.x * (double)wi.x + (double)wi.y * (double)wi.y);
            int cell = (int)(CELLS * phase_below(g, versine));
            ++counts[cell < 0 ? 0 : cell < CELLS ? cell : CELLS - 1];
            around[0] += sine > 0.0 ? (double)wi.x / sine : 0.0;
            around[1] += sine > 0.0 ? (double)wi.y / sine : 0.0;
            REQUIRE(fabsf(vec3_length(wi) - 1.0f) < 1e-6f && sample.weight.x == 1.0f && sample.delta == 0u);
            double exact = phase_exact(g, versine);
            REQUIRE_MSG(fabs((double)sample.pdf_w - exact) <= 1e-4 * exact, "g %g: density %g of a sample, not %g", g,
                        (double)sample.pdf_w, exact);
        }
        for (int k = 0; k < CELLS; ++k) {
            double expected = (double)SAMPLES / CELLS, off = counts[k] - expected;
            chi += off * off / expected;
        }
        REQUIRE_MSG(chi < CELLS + 5.0 * sqrt(2.0 * CELLS), "g %g: chi-square %g over %d cells", g, chi, CELLS);
        REQUIRE_MSG(hypot(around[0], around[1]) < 5.0 * sqrt((double)SAMPLES), "g %g: azimuth", g);
    }
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_phase_tests(void)
{
    TCase *tcase = tcase_create("phase");
    tcase_add_test(tcase, test_phase_density);
    tcase_add_test(tcase, test_phase_samples);
    tcase_set_timeout(tcase, 120);
    return tcase;
}
