/* The coat's closed form: against exact integrals, against simulation of the layers, and its tables. */
#include "support/bsdf_cases.h"

#include <time.h>

/* T_mean = integral of (1 - F(c)) 2 c dc, by midpoints in t, c = t^2. */
static double mean_transmission(float eta)
{
    const int cells = 20000;
    double sum = 0.0;
    for (int k = 0; k < cells; ++k) {
        double t = (k + 0.5) / cells;
        sum += 4.0 * t * t * t * (1.0 - (double)fresnel_dielectric((float)(t * t), eta));
    }
    return sum / cells;
}

START_TEST(test_smooth_escape)
{
    for (float eta = 1.0f; eta <= COAT_ETA_MAX; eta += 0.01f) {
        double exact = mean_transmission(eta);
        REQUIRE_MSG(fabs((double)coat_smooth_mean(eta) / exact - 1.0) < 1.5e-4, "eta %g: %g instead of %g", (double)eta,
                    (double)coat_smooth_mean(eta), exact);
        double inside = mean_transmission(1.0f / eta);
        REQUIRE(fabs((double)coat_smooth_escape(eta) / inside - 1.0) < 1e-3);
        REQUIRE(fabs((double)coat_smooth_escape(1.0f / eta) / exact - 1.0) < 1e-3);
    }
    REQUIRE(coat_smooth_escape(6.0f) > 0.0f && coat_smooth_escape(6.0f) < 1.0f);
}
END_TEST

/* One random walk through the layers that define the material: a photon from above, a dielectric interface, a base that
 * absorbs 1 - rho and reflects diffusely. Returns the direction in which it leaves, z = 0 if absorbed; *specular tells
 * whether the outside of the coat reflected it. `coat` is the interface alone. */
static Vec3 layers_walk(const TestScene *scene, const Bsdf *coat, Vec3 wo, double rho, TestRandom *random,
                        bool *specular)
{
    Vec3 w = wo; /* points back to where the photon came from */
    BsdfSample sample;
    *specular = true;
    for (int bounce = 0; bounce < 10000; ++bounce) {
        float u_lobe = random_float24(random);
        if (!bsdf_sample(&scene->view, coat, w, u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE, &sample) ||
            random_double(random) >= (double)sample.weight.x)
            break;
        if (sample.wi.z > 0.0f)
            return sample.wi;
        *specular = false;
        if (random_double(random) >= rho)
            break;
        Vec3 up = warp_cosine_hemisphere(random_vec2(random));
        w = vec3_negate(up);
    }
    return vec3_splat(0.0f);
}

#define BINS 10
#define PHOTONS 200000

/* Histogram over cos^2 of the direction of photons that leave via the base, against the integral of the diffuse term
 * over each bin; p > 1e-3 over all cases (Sidak). */
START_TEST(test_smooth_coat_is_the_layers)
{
    TestScene scene;
    test_scene_init(&scene);
    const double rhos[] = {0.2, 0.8, 1.0}, degrees[] = {0.0, 60.0, 85.0};
    TestRandom random = {21};
    Bsdf coat = test_bsdf(&scene, MATERIAL_DIELECTRIC, 0.0f, 0.0f, 1.5f, 0.0f, 0.0f);
    for (int r = 0; r < 3; ++r)
        for (int d = 0; d < 3; ++d) {
            Vec3 wo = test_direction(degrees[d], 0.0);
            Bsdf bsdf = test_bsdf(&scene, MATERIAL_COATED_DIFFUSE, 0.0f, 0.0f, 1.5f, (float)rhos[r], 0.0f);
            double observed[BINS + 2] = {0.0}, expected[BINS + 2] = {0.0};
            for (int n = 0; n < PHOTONS; ++n) {
                bool specular;
                Vec3 w = layers_walk(&scene, &coat, wo, rhos[r], &random, &specular);
                int bin = w.z == 0.0f ? BINS : specular ? BINS + 1 : (int)((double)w.z * (double)w.z * BINS);
                observed[bin < BINS || w.z == 0.0f || specular ? bin : BINS - 1] += 1.0;
            }
            expected[BINS] = PHOTONS;
            for (int k = 0; k < BINS * 100; ++k) { /* f cos d(omega) = f pi d(cos^2) for a rotationally symmetric f */
                double cosine = sqrt((k + 0.5) / (BINS * 100));
                Vec3 wi = vec3((float)sqrt(1.0 - cosine * cosine), 0.0f, (float)cosine);
                BsdfValue value = bsdf_eval(&scene.view, &bsdf, wo, wi, TRANSPORT_RADIANCE);
                double share = (double)value.f_cos.x / cosine * TEST_PI / (BINS * 100) * PHOTONS;
                expected[k / 100] += share;
                expected[BINS] -= share;
            }
            expected[BINS + 1] = PHOTONS * (double)fresnel_dielectric(wo.z, 1.5f);
            expected[BINS] = fmax(0.0, expected[BINS] - expected[BINS + 1]);
            if (r == 2) { /* rho = 1: nothing is absorbed; a few walks fail at grazing angles */
                REQUIRE(observed[BINS] + expected[BINS] < 1e-3 * PHOTONS);
                observed[BINS] = expected[BINS] = 0.0;
            }
            double p = test_chi_square(observed, expected, BINS + 2);
            REQUIRE_MSG(p > 1.0 - pow(1.0 - 1e-3, 1.0 / 9.0), "rho %g, %g degrees: p = %g", rhos[r], degrees[d], p);
        }
    test_scene_destroy(&scene);
}
END_TEST

/* Fraction of a diffuse field below the interface that it reflects back down. */
static double inside_reflectance(const TestScene *scene, const Bsdf *coat, TestRandom *random)
{
    double sum = 0.0;
    for (int n = 0; n < PHOTONS; ++n) {
        Vec3 w = vec3_negate(warp_cosine_hemisphere(random_vec2(random)));
        BsdfSample sample;
        float u_lobe = random_float24(random);
        if (bsdf_sample(&scene->view, coat, w, u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE, &sample) &&
            !sample.transmitted)
            sum += (double)sample.weight.x;
    }
    return sum / PHOTONS;
}

/* For a rough coat, closed form and random walk differ only in the internal reflectance R_i: the walk's is from single
 * scattering, which loses energy; the closed form's is 1 - escape, which returns that energy to the base. With the
 * walk's R_i, the closed form predicts the walk's albedo (to 4 standard deviations); with its own it is brighter, by
 * the printed figures. */
START_TEST(test_rough_coat_is_the_layers)
{
    const float alphas[] = {0.01f, 0.1f, 0.3f, 0.6f};
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {22};
    for (int a = 0; a < 4; ++a) {
        Bsdf coat = test_bsdf(&scene, MATERIAL_DIELECTRIC, alphas[a], alphas[a], 1.5f, 0.0f, 0.0f);
        Bsdf bsdf = test_bsdf(&scene, MATERIAL_COATED_DIFFUSE, alphas[a], alphas[a], 1.5f, 0.8f, 0.0f);
        Vec3 wo = test_direction(40.0, 0.0);
        float escape;
        double rho = 0.8, t = (double)coated_transmission(&scene.view, &bsdf, wo, &escape);
        double walk = 0.0, closed = 0.0, outside = 0.0, inside = inside_reflectance(&scene, &coat, &random);
        for (int n = 0; n < PHOTONS; ++n) {
            bool specular;
            BsdfSample sample;
            walk += layers_walk(&scene, &coat, wo, rho, &random, &specular).z > 0.0f ? 1.0 : 0.0;
            float u_lobe = random_float24(&random);
            Vec2 u = random_vec2(&random);
            if (bsdf_sample(&scene.view, &bsdf, wo, u_lobe, u, TRANSPORT_IMPORTANCE, &sample))
                closed += (double)sample.weight.x;
            if (bsdf_sample(&scene.view, &coat, wo, u_lobe, u, TRANSPORT_IMPORTANCE, &sample) && !sample.transmitted)
                outside += (double)sample.weight.x;
        }
        double predicted = outside / PHOTONS + t * rho * (double)escape / (1.0 - rho * inside);
        printf("# coat alpha %g, rho %g: albedo %.4f, layers %.4f, R_i %.4f, of the layers %.4f\n", (double)alphas[a],
               rho, closed / PHOTONS, walk / PHOTONS, 1.0 - (double)escape, inside);
        REQUIRE_MSG(fabs(predicted - walk / PHOTONS) < 5e-3, "alpha %g: albedo %g instead of %g", (double)alphas[a],
                    predicted, walk / PHOTONS);
        ck_assert_double_gt(closed / PHOTONS, walk / PHOTONS - 5e-3);
    }
    test_scene_destroy(&scene);
}
END_TEST

static double transmitted_share(const TestScene *scene, const Bsdf *coat, Vec3 wo, TestRandom *random)
{
    double sum = 0.0;
    for (int n = 0; n < PHOTONS; ++n) {
        BsdfSample sample;
        float u_lobe = random_float24(random);
        if (bsdf_sample(&scene->view, coat, wo, u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE, &sample) &&
            sample.transmitted)
            sum += (double)sample.weight.x;
    }
    return sum / PHOTONS;
}

/* The table's transmission equals the rough interface's in every direction; the table for ranges of roughness nearly
 * does. */
START_TEST(test_table_is_transmission)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {23};
    Error error;
    uint32_t range;
    REQUIRE(coat_table_build_range(1.5f, &scene.lookup, &range, &error));
    for (int a = 1; a < TEST_ALPHA_COUNT; ++a) {
        float ax = TEST_ALPHAS[a].x, ay = TEST_ALPHAS[a].y;
        Bsdf coat = test_bsdf(&scene, MATERIAL_DIELECTRIC, ax, ay, 1.5f, 0.0f, 0.0f);
        Bsdf bsdf = test_bsdf(&scene, MATERIAL_COATED_DIFFUSE, ax, ay, 1.5f, 0.5f, 0.0f);
        for (int d = 0; d < 6; ++d) {
            const double degrees[] = {3.0, 41.0, 63.0, 77.0, 84.0, 88.0};
            Vec3 wo = test_direction(degrees[d], 0.3 * d);
            float escape;
            double exact = transmitted_share(&scene, &coat, wo, &random);
            double table = (double)coated_transmission(&scene.view, &bsdf, wo, &escape);
            REQUIRE_MSG(fabs(table - exact) < 6e-3, "alpha %g %g, %g degrees: T %g instead of %g", (double)ax,
                        (double)ay, degrees[d], table, exact);
            if (ax != ay)
                continue;
            double from_range = (double)coat_table_lookup(scene.view.lookup + range, ax, ay, wo, &escape);
            REQUIRE_MSG(fabs(from_range - exact) < 0.02, "range, alpha %g, %g degrees: T %g instead of %g", (double)ax,
                        degrees[d], from_range, exact);
        }
    }
    test_scene_destroy(&scene);
}
END_TEST

/* Textured roughness: no energy gain, isotropic or not. */
START_TEST(test_range_table_furnace)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {24};
    Error error;
    uint32_t range;
    REQUIRE(coat_table_build_range(1.5f, &scene.lookup, &range, &error));
    double high = 0.0, low = 2.0;
    for (int n = 0; n < 60; ++n) {
        float ax = (float)pow(10.0, -2.9 + 2.9 * random_double(&random));
        float ay = n % 3 ? ax : (float)pow(10.0, -2.9 + 2.9 * random_double(&random));
        Bsdf bsdf = {.kind = MATERIAL_COATED_DIFFUSE, .color0 = {1.0f, 1.0f, 1.0f}, .alpha_x = ax, .alpha_y = ay};
        bsdf.eta = 1.5f;
        bsdf.coat_table = range;
        scene.view.lookup = scene.lookup.data;
        bsdf_flags_set(&bsdf);
        Vec3 wo = random_direction(&random, 0.02 + 0.98 * random_double(&random));
        double sum = 0.0;
        for (int k = 0; k < PHOTONS / 4; ++k) {
            BsdfSample sample;
            float u_lobe = random_float24(&random);
            if (bsdf_sample(&scene.view, &bsdf, wo, u_lobe, random_vec2(&random), TRANSPORT_RADIANCE, &sample))
                sum += (double)sample.weight.x;
        }
        double a = sum / (PHOTONS / 4);
        if (ax == ay) {
            REQUIRE_MSG(a < 1.003, "alpha %g, cos %g: albedo %g", (double)ax, (double)wo.z, a);
            high = fmax(high, a);
            low = fmin(low, a);
        } else {
            REQUIRE_MSG(a < 1.1, "alpha %g %g, cos %g: albedo %g", (double)ax, (double)ay, (double)wo.z, a);
        }
    }
    printf("# textured roughness: albedo %.4f ... %.4f\n", low, high);
    test_scene_destroy(&scene);
}
END_TEST

/* Building a table is deterministic, and both sides of the coat give the same one. */
START_TEST(test_table_build)
{
    Error error;
    Array a, b;
    array_init(&a, sizeof(float));
    array_init(&b, sizeof(float));
    uint32_t first[3];
    clock_t start = clock();
    REQUIRE(coat_table_build(0.3f, 0.3f, 1.5f, &a, &first[0], &error));
    clock_t isotropic = clock();
    REQUIRE(coat_table_build(0.05f, 0.4f, 1.5f, &a, &first[1], &error));
    clock_t anisotropic = clock();
    REQUIRE(coat_table_build_range(1.5f, &a, &first[2], &error));
    clock_t done = clock();
    printf("# coat tables: %.1f ms, anisotropic %.1f ms, range %.1f ms\n",
           1e3 * (double)(isotropic - start) / CLOCKS_PER_SEC, 1e3 * (double)(anisotropic - isotropic) / CLOCKS_PER_SEC,
           1e3 * (double)(done - anisotropic) / CLOCKS_PER_SEC);
    REQUIRE(coat_table_build(0.3f, 0.3f, 1.5f, &b, &first[0], &error));
    REQUIRE(first[0] == (0));
    REQUIRE(first[1] == (1 + COAT_ROW));
    REQUIRE(first[2] == (2 + COAT_ROW + COAT_AZIMUTH_ROWS * COAT_ROW));
    ck_assert_int_eq(memcmp(a.data, b.data, b.count * sizeof(float)), 0);
    for (size_t k = 0; k < a.count; ++k) {
        float value = ARRAY_AT(&a, float, k);
        REQUIRE(value == 1.0f || value == (float)COAT_AZIMUTH_ROWS || value == (float)COAT_ALPHA_ROWS ||
                (value >= 0.0f && value < 1.0f));
    }
    array_destroy(&a);
    array_destroy(&b);
}
END_TEST

START_TEST(test_coat_is_two_sided)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {25};
    Bsdf bsdf = test_bsdf(&scene, MATERIAL_COATED_DIFFUSE, 0.05f, 0.4f, 1.5f, 0.7f, 0.0f);
    for (int n = 0; n < 1000; ++n) {
        Vec3 o = random_direction(&random, random_double(&random)),
             i = random_direction(&random, random_double(&random));
        BsdfValue a = bsdf_eval(&scene.view, &bsdf, o, i, TRANSPORT_RADIANCE);
        BsdfValue b = bsdf_eval(&scene.view, &bsdf, vec3_negate(o), vec3_negate(i), TRANSPORT_RADIANCE);
        REQUIRE(a.f_cos.x == b.f_cos.x && a.pdf_w == b.pdf_w && a.pdf_rev_w == b.pdf_rev_w);
        BsdfValue across = bsdf_eval(&scene.view, &bsdf, o, vec3_negate(i), TRANSPORT_RADIANCE);
        REQUIRE(across.f_cos.x == 0.0f && across.pdf_w == 0.0f);
    }
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_coated_tests(void)
{
    TCase *tcase = tcase_create("coated");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_smooth_escape);
    tcase_add_test(tcase, test_smooth_coat_is_the_layers);
    tcase_add_test(tcase, test_rough_coat_is_the_layers);
    tcase_add_test(tcase, test_table_is_transmission);
    tcase_add_test(tcase, test_range_table_furnace);
    tcase_add_test(tcase, test_table_build);
    tcase_add_test(tcase, test_coat_is_two_sided);
    return tcase;
}
