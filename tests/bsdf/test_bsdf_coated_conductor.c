/* A coat over a conductor: against exact sums, against the conductor without a coat, and against simulation of the
 * layers. */
#include "support/bsdf_cases.h"

#include "bsdf/material.h"

#define PHOTONS 60000

/* A conductor of index eta + i k in the coat of index `coat`, with the alphas of both. */
static Bsdf coated_make(TestScene *scene, float alpha, float base, float coat, float eta, float k, float thickness)
{
    Bsdf bsdf = {.kind = MATERIAL_COATED_CONDUCTOR, .eta = coat, .alpha_x = alpha, .alpha_y = alpha};
    bsdf.color0 = vec3_splat(eta);
    bsdf.color1 = vec3_splat(k);
    bsdf.coat_table = NONE;
    bsdf.flags = bsdf_base_pack(base, base);
    bsdf_flags_set(&bsdf);
    test_record_make(scene, &bsdf, thickness);
    return bsdf;
}

/* ---- exact cases ------------------------------------------------------------------------------------------------- */

/* Both smooth: the sum of all reflections between them, term by term. */
START_TEST(test_smooth_is_the_series)
{
    TestScene scene;
    test_scene_init(&scene);
    const float ks[] = {0.5f, 3.9f, 200.0f}, thicknesses[] = {0.0f, 0.01f, 0.5f};
    for (int n = 0; n < 9; ++n)
        for (int d = 0; d < TEST_WO_COUNT; ++d) {
            float thickness = thicknesses[n / 3];
            Bsdf bsdf = coated_make(&scene, 0.0f, 0.0f, 1.5f, 0.2f, ks[n % 3], thickness);
            Vec3 wo = test_wo(d);
            BsdfSample sample;
            REQUIRE((bsdf.flags & BSDF_SMOOTH) != 0u);
            REQUIRE(bsdf_sample(&scene.view, &bsdf, wo, 0.5f, vec2(0.5f, 0.5f), TRANSPORT_RADIANCE, &sample));
            REQUIRE(sample.delta && sample.pdf_w == 1.0f && sample.wi.z == wo.z && sample.wi.x == -wo.x);
            float cos_t = refraction_cosine(fabsf(wo.z), 1.5f);
            double r = (double)fresnel_dielectric(fabsf(wo.z), 1.5f);
            double f = (double)fresnel_conductor(cos_t, 0.2f, ks[n % 3]) * exp(-2.0 * (double)(thickness / cos_t));
            double sum = r, term = (1.0 - r) * (1.0 - r) * f;
            for (int k = 0; k < 20000; ++k, term *= r * f)
                sum += term;
            REQUIRE_MSG(fabs(sum - (double)sample.weight.x) < 2e-4, "k %g, direction %d: %g instead of %g",
                        (double)ks[n % 3], d, (double)sample.weight.x, sum);
            REQUIRE(bsdf_eval(&scene.view, &bsdf, wo, sample.wi, TRANSPORT_RADIANCE).pdf_w == 0.0f);
        }
    test_scene_destroy(&scene);
}
END_TEST

/* A coat of the index of air without absorption changes nothing. */
START_TEST(test_matched_coat_is_no_coat)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {31};
    for (int a = 2; a < TEST_ALPHA_COUNT - 1; ++a) {
        float alpha = TEST_ALPHAS[a].x;
        Bsdf coated = coated_make(&scene, 0.3f, alpha, 1.0f, 0.2f, 3.9f, 0.0f);
        Vec2 packed = bsdf_base_alphas(coated.flags);
        Bsdf plain = test_bsdf(&scene, MATERIAL_CONDUCTOR, packed.x, packed.y, 1.0f, 0.2f, 3.9f);
        for (int n = 0; n < 2000; ++n) {
            Vec3 o = random_direction(&random, random_double(&random)), i;
            i = n % 2 ? random_direction(&random, random_double(&random)) : vec3(-o.x, -o.y, o.z);
            BsdfValue a_value = bsdf_eval(&scene.view, &coated, o, i, TRANSPORT_RADIANCE);
            BsdfValue b_value = bsdf_eval(&scene.view, &plain, o, i, TRANSPORT_RADIANCE);
            REQUIRE_MSG(fabsf(a_value.f_cos.x - b_value.f_cos.x) <= 1e-3f * b_value.f_cos.x + 1e-7f, "alpha %g: %g, %g",
                        (double)alpha, (double)a_value.f_cos.x, (double)b_value.f_cos.x);
            REQUIRE(fabsf(a_value.pdf_w - b_value.pdf_w) <= 1e-2f * b_value.pdf_w + 1e-7f);
        }
    }
    test_scene_destroy(&scene);
}
END_TEST

/* The alphas of the conductor keep their values to half a part in a hundred, and a smooth one stays smooth. */
START_TEST(test_base_alphas)
{
    for (float alpha = 1e-3f; alpha <= 1.0f; alpha *= 1.01f) {
        Vec2 kept = bsdf_base_alphas(bsdf_base_pack(alpha, 1.0f));
        REQUIRE(fabsf(kept.x / alpha - 1.0f) < 5e-3f && kept.y == 1.0f);
        REQUIRE(bsdf_base_is_anisotropic(bsdf_base_pack(alpha, 1.0f)) == (alpha < 0.9999f));
    }
    REQUIRE(bsdf_base_pack(9e-4f, 5e-4f) == 0u);
    REQUIRE(!bsdf_base_is_anisotropic(bsdf_base_pack(0.3f, 0.3f)));
    REQUIRE((bsdf_base_pack(1.0f, 1.0f) & (BSDF_SMOOTH | BSDF_ROUGH | BSDF_REFLECTANCE)) == 0u);
}
END_TEST

/* The index of the conductor is relative to the coat; the roughnesses of both layers are remapped. */
START_TEST(test_material)
{
    const ColorParam eta = {{0.3f, 0.6f, 0.9f}, NONE}, k = {{3.0f, 1.5f, 4.5f}, NONE},
                     white = {{0.5f, 1.0f, 0.0f}, NONE};
    Material m = {.kind = MATERIAL_COATED_CONDUCTOR, .flags = MATERIAL_REMAP_ROUGHNESS, .color0 = eta, .color1 = k};
    m.roughness_u = m.roughness_v = (FloatParam){0.04f, NONE};
    m.base_u = (FloatParam){0.09f, NONE};
    m.base_v = (FloatParam){0.25f, NONE};
    m.eta = 1.5f;
    m.coat_table = NONE;
    const SceneView view = {.features = FEATURE_COATED_CONDUCTOR | FEATURE_ROUGH, .materials = &m};
    const TexturePoint point = {.uv = {0.0f, 0.0f}};
    Bsdf bsdf = material_bsdf(&view, 0, &point);
    Vec2 alphas = bsdf_base_alphas(bsdf.flags);
    ck_assert_double_eq_tol((double)bsdf.color0.y, 0.4, 1e-6);
    ck_assert_double_eq_tol((double)bsdf.color1.z, 3.0, 1e-6);
    ck_assert_double_eq_tol((double)bsdf.alpha_x, 0.2, 1e-6);
    ck_assert_double_eq_tol((double)alphas.x, 0.3, 1e-3);
    ck_assert_double_eq_tol((double)alphas.y, 0.5, 1e-3);
    ck_assert_uint_eq(bsdf.flags & (BSDF_ROUGH | BSDF_SMOOTH), BSDF_ROUGH);
    m.flags |= MATERIAL_CONDUCTOR_REFLECTANCE;
    m.color0 = white;
    bsdf = material_bsdf(&view, 0, &point);
    ck_assert_double_eq_tol((double)bsdf.color0.x, 1.0 / 1.5, 1e-6);
    ck_assert_double_eq_tol((double)bsdf.color1.x, 2.0 / 1.5, 1e-6); /* 2 sqrt(r / (1 - r)) */
    ck_assert(bsdf.color1.z == 0.0f);
}
END_TEST

/* ---- the layers -------------------------------------------------------------------------------------------------- */

/* Total weight of random walks, and where they leave: cells of the slope of the half vector, at the angle of a lobe of
 * width `alpha`. */
#define CELLS 6
typedef struct Flux {
    double total, cells[CELLS];
} Flux;

static void flux_add(Flux *flux, Vec3 wo, Vec3 wi, double weight, double alpha)
{
    Vec3 h = vec3_add(wo, wi);
    double slope = hypot((double)h.x, (double)h.y) / ((double)h.z * alpha);
    int cell = (int)fmin(2.0 * log2(1.0 + slope), CELLS - 1);
    flux->total += weight / PHOTONS;
    flux->cells[cell] += weight / PHOTONS;
}

/* One random walk through the layers that define the material: a photon from above, a dielectric interface, a medium
 * that absorbs, a conductor. */
static void layers_walk(const TestScene *scene, const Bsdf *coat, const Bsdf *base, double thickness, Vec3 wo,
                        double alpha, TestRandom *random, Flux *flux)
{
    Vec3 w = wo; /* points back to where the photon came from */
    double weight = 1.0;
    BsdfSample sample;
    for (int bounce = 0; bounce < 1000; ++bounce) {
        float u_lobe = random_float24(random);
        if (!bsdf_sample(&scene->view, coat, w, u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE, &sample))
            return;
        weight *= (double)sample.weight.x;
        if (sample.wi.z > 0.0f) {
            flux_add(flux, wo, sample.wi, weight, alpha);
            return;
        }
        weight *= exp(-thickness / fabs((double)sample.wi.z));
        Vec3 up = vec3_negate(sample.wi);
        u_lobe = random_float24(random);
        if (!bsdf_sample(&scene->view, base, up, u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE, &sample))
            return;
        weight *= (double)sample.weight.x * exp(-thickness / fabs((double)sample.wi.z));
        w = vec3_negate(sample.wi);
        if (random_double(random) >= fmin(1.0, 10.0 * weight))
            return;
        weight /= fmin(1.0, 10.0 * weight);
    }
}

static Flux layers_flux(TestScene *scene, const Bsdf *bsdf, float base, double thickness, Vec3 wo, double alpha)
{
    TestRandom random = {32};
    Flux flux = {0};
    Bsdf coat = test_bsdf(scene, MATERIAL_DIELECTRIC, bsdf->alpha_x, bsdf->alpha_y, bsdf->eta, 0.0f, 0.0f);
    Bsdf metal = test_bsdf(scene, MATERIAL_CONDUCTOR, base, base, 1.0f, bsdf->color0.x, bsdf->color1.x);
    for (int n = 0; n < PHOTONS; ++n)
        layers_walk(scene, &coat, &metal, thickness, wo, alpha, &random, &flux);
    return flux;
}

static Flux closed_flux(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, double alpha)
{
    TestRandom random = {33};
    Flux flux = {0};
    for (int n = 0; n < PHOTONS; ++n) {
        BsdfSample sample;
        float u_lobe = random_float24(&random);
        if (bsdf_sample(&scene->view, bsdf, wo, u_lobe, random_vec2(&random), TRANSPORT_IMPORTANCE, &sample))
            flux_add(&flux, wo, sample.wi, (double)sample.weight.x, alpha);
    }
    return flux;
}

/* Half of the sum of absolute differences between cells: the light that is in the wrong place. */
static double flux_misplaced(const Flux *a, const Flux *b)
{
    double sum = 0.0;
    for (int k = 0; k < CELLS; ++k)
        sum += 0.5 * fabs(a->cells[k] - b->cells[k]);
    return sum;
}

/* The closed form against random walks at several roughnesses of both layers, for a dark and a bright metal and three
 * directions. Bounds are what was measured, rounded up. */
static const struct LayersCase {
    float alpha, base;
    double albedo, misplaced;
} LAYERS[] = {{0.0f, 0.1f, 0.015, 0.07}, {0.0f, 0.3f, 0.015, 0.03}, {0.0f, 0.6f, 0.01, 0.01},
              {0.1f, 0.0f, 0.045, 0.1},  {0.3f, 0.0f, 0.11, 0.1},   {0.1f, 0.1f, 0.015, 0.07},
              {0.3f, 0.3f, 0.045, 0.04}, {0.1f, 0.6f, 0.02, 0.015}, {0.6f, 0.1f, 0.08, 0.11}};

START_TEST(test_layers)
{
    const struct LayersCase *c = &LAYERS[_i];
    const float ks[] = {1.5f, 100.0f};
    const double degrees[] = {0.0, 45.0, 75.0};
    double worst_albedo = 0.0, worst_misplaced = 0.0;
    for (int n = 0; n < 6; ++n) {
        TestScene scene;
        if (test_effort() == 1 && n % 2 != _i % 2)
            continue; /* only in make check-long */
        test_scene_init(&scene);
        Vec3 wo = test_direction(degrees[n % 3], 0.0);
        Bsdf bsdf = coated_make(&scene, c->alpha, c->base, 1.5f, 0.3f, ks[n / 3], 0.01f);
        double width = fmax((double)fmaxf(c->alpha, c->base), 0.05);
        Flux walk = layers_flux(&scene, &bsdf, c->base, 0.01, wo, width);
        Flux closed = closed_flux(&scene, &bsdf, wo, width);
        double misplaced = flux_misplaced(&walk, &closed);
        printf("# coat alpha %g, conductor alpha %g, k %g, %g degrees: albedo %.4f, layers %.4f, %.3f misplaced\n",
               (double)c->alpha, (double)c->base, (double)ks[n / 3], degrees[n % 3], closed.total, walk.total,
               misplaced);
        worst_albedo = fmax(worst_albedo, fabs(closed.total - walk.total));
        worst_misplaced = fmax(worst_misplaced, misplaced);
        test_scene_destroy(&scene);
    }
    REQUIRE_MSG(worst_albedo < c->albedo && worst_misplaced < c->misplaced,
                "alphas %g, %g: albedo off by %g, %g misplaced", (double)c->alpha, (double)c->base, worst_albedo,
                worst_misplaced);
}
END_TEST

/* White metal without absorption: nothing is gained, for any roughnesses, indices and directions. */
START_TEST(test_white_furnace)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {34};
    double high = 0.0;
    for (int n = 0; n < (test_effort() == 1 ? 20 : 60); ++n) {
        const float etas[] = {1.5f, 1.2f, 2.4f, 0.8f};
        float alpha = n % 3 ? (float)pow(10.0, -2.9 + 2.9 * random_double(&random)) : 0.0f;
        float base = n % 5 ? (float)pow(10.0, -2.9 + 2.9 * random_double(&random)) : 0.0f;
        Bsdf bsdf = coated_make(&scene, alpha, base, etas[n % 4], 0.0f, 1e4f, 0.0f);
        Vec3 wo = random_direction(&random, 0.02 + 0.98 * random_double(&random));
        double sum = 0.0;
        for (int k = 0; k < 50000; ++k) {
            BsdfSample sample;
            float u_lobe = random_float24(&random);
            if (bsdf_sample(&scene.view, &bsdf, wo, u_lobe, random_vec2(&random), TRANSPORT_RADIANCE, &sample))
                sum += (double)sample.weight.x;
        }
        REQUIRE_MSG(sum / 50000 < 1.01, "alphas %g, %g, eta %g, cos %g: albedo %g", (double)alpha, (double)base,
                    (double)bsdf.eta, (double)wo.z, sum / 50000);
        high = fmax(high, sum / 50000);
    }
    printf("# white metal: albedo of at most %.4f\n", high);
    test_scene_destroy(&scene);
}
END_TEST

/* Building a record is deterministic, and its numbers are fractions. */
START_TEST(test_record_build)
{
    Error error;
    Array a;
    uint32_t first[2];
    array_init(&a, sizeof(float));
    REQUIRE(coat_base_build(1.5f, 0.25f, true, &a, &first[0], &error));
    REQUIRE(coat_base_build(1.5f, 0.25f, true, &a, &first[1], &error));
    REQUIRE(first[0] == 0 && first[1] == COAT_OUTSIDE && a.count == 2 * COAT_OUTSIDE);
    const float *record = a.data;
    ck_assert_int_eq(memcmp(record, record + COAT_OUTSIDE, COAT_OUTSIDE * sizeof(float)), 0);
    REQUIRE(record[0] == 0.25f && record[1] == coat_round_trip(1.5f, 0.25f));
    for (uint k = 2; k < COAT_OUTSIDE; ++k)
        REQUIRE_MSG(record[k] >= 0.0f && record[k] <= 1.001f, "number %u is %g", k, (double)record[k]);
    array_destroy(&a);
}
END_TEST

TCase *bsdf_coated_conductor_tests(void)
{
    TCase *tcase = tcase_create("coated conductor");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_smooth_is_the_series);
    tcase_add_test(tcase, test_matched_coat_is_no_coat);
    tcase_add_test(tcase, test_base_alphas);
    tcase_add_test(tcase, test_material);
    tcase_add_loop_test(tcase, test_layers, 0, (int)(sizeof LAYERS / sizeof LAYERS[0]));
    tcase_add_test(tcase, test_white_furnace);
    tcase_add_test(tcase, test_record_build);
    return tcase;
}
