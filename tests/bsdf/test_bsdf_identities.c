/* Identities for arbitrary pairs of directions: weights, reciprocity, reverse densities, adjoints, finite values. */
#include "support/bsdf_cases.h"

#include "bsdf/bsdf_state.h"

#include <string.h>

#define POOL 64
#define PAIRS 400000

/* BSDFs of every kind with random roughness, index and colour. */
static void pool_make(TestScene *scene, TestRandom *random, Bsdf pool[POOL])
{
    static const float ETAS[] = {1.5f, 1.33f, 2.4f, 1.01f, 0.7f, 1.0f, 1.0005f};
    for (int k = 0; k < POOL; ++k) {
        const struct TestAlpha alpha = TEST_ALPHAS[random_next(random) % TEST_ALPHA_COUNT];
        float eta = ETAS[random_next(random) % 7];
        uint kind = (uint)k % MATERIAL_MIX;
        float color0 = (float)random_double(random), color1 = (float)random_double(random) * 5.0f;
        if (kind == MATERIAL_DIFFUSE_TRANSMISSION)
            color1 = 1.0f - color0;
        if (kind == MATERIAL_HAIR) /* where across the hair */
            color1 = 2.0f * color0 - 1.0f;
        pool[k] = test_bsdf(scene, kind, alpha.x, alpha.y, eta, color0, color1);
        if (kind == MATERIAL_CONDUCTOR && (k & 8))
            pool[k].flags |= BSDF_REFLECTANCE;
    }
}

/* Uniform, or close to grazing. */
static Vec3 any_direction(TestRandom *random)
{
    double cosine = 2.0 * random_double(random) - 1.0;
    if (random_next(random) % 4 == 0)
        cosine *= 0.01;
    return random_direction(random, cosine);
}

static bool near_float(float a, float b, float relative)
{
    return fabsf(a - b) <= relative * fmaxf(fabsf(a), fabsf(b)) + 1e-30f;
}

/* A sample's densities equal eval's for its direction, and weight = f_cos / pdf. */
START_TEST(test_weight_is_value_over_density)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {1};
    Bsdf pool[POOL];
    pool_make(&scene, &random, pool);
    int compared = 0;
    for (int n = 0; n < PAIRS; ++n) {
        const Bsdf *bsdf = &pool[n % POOL];
        uint transport = (uint)(n / POOL) & 1u;
        Vec3 wo = any_direction(&random);
        BsdfSample sample;
        float u_lobe = random_float24(&random);
        if (!bsdf_sample(&scene.view, bsdf, wo, u_lobe, random_vec2(&random), transport, &sample) || sample.delta)
            continue;
        BsdfValue value = bsdf_eval(&scene.view, bsdf, wo, sample.wi, transport);
        float weight = value.f_cos.y / value.pdf_w;
        REQUIRE(value.pdf_w == sample.pdf_w);
        REQUIRE(value.pdf_rev_w == sample.pdf_rev_w);
        REQUIRE_MSG(near_float(weight, sample.weight.y, 1e-5f), "kind %u: weight %.9g, f cos / pdf %.9g", bsdf->kind,
                    (double)sample.weight.y, (double)weight);
        REQUIRE(sample.transmitted == (sample.wi.z * wo.z < 0.0f));
        REQUIRE(fabs((double)vec3_length(sample.wi) - 1.0) < 1e-6);
        ++compared;
    }
    ck_assert_int_gt(compared, PAIRS / 3);
    test_scene_destroy(&scene);
}
END_TEST

/* Relative index, wi's side over wo's, for a refracting pair, else 1. */
static float pair_eta(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    if (bsdf->kind != MATERIAL_DIELECTRIC || wo.z * wi.z > 0.0f)
        return 1.0f;
    return wo.z > 0.0f ? bsdf->eta : 1.0f / bsdf->eta;
}

/* f(wo, wi) = f(wi, wo), for refraction eta_i^2 f(wo, wi) = eta_o^2 f(wi, wo) in radiance (Veach 1997, eq. 5.14);
 * importance is the adjoint f(wi, wo) of radiance; pdf_rev_w is pdf_w of the swapped pair. */
static void pair_check(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    BsdfValue a = bsdf_eval(&scene->view, bsdf, wo, wi, TRANSPORT_RADIANCE);
    BsdfValue b = bsdf_eval(&scene->view, bsdf, wi, wo, TRANSPORT_RADIANCE);
    BsdfValue adjoint = bsdf_eval(&scene->view, bsdf, wo, wi, TRANSPORT_IMPORTANCE);
    float eta = pair_eta(bsdf, wo, wi), f_a = a.f_cos.x / fabsf(wi.z), f_b = b.f_cos.x / fabsf(wo.z);
    /* Tolerance: half vectors of nearly opposite directions lose digits, which matters more for narrower lobes; so do
     * cosines of directions that graze the microfacet. */
    Vec3 half = vec3_mad(wo, eta, wi);
    float h = vec3_length(half);
    float graze = fminf(fabsf(vec3_dot(wo, half)), fabsf(vec3_dot(wi, half))) / h;
    float alpha = fminf(bsdf->alpha_x, bsdf->alpha_y);
    bool rough = (bsdf->flags & BSDF_ROUGH) != 0u || bsdf->flags >> BSDF_BASE_SHIFT != 0u;
    float tolerance = 2e-5f + (rough ? 3e-6f / (h * fminf(alpha, graze)) : 0.0f);
    REQUIRE_MSG(near_float(f_a * eta * eta, f_b, tolerance), "kind %u, alpha %g, eta %g: %.9g and %.9g, |h| = %g",
                bsdf->kind, (double)alpha, (double)bsdf->eta, (double)(f_a * eta * eta), (double)f_b, (double)h);
    REQUIRE(near_float(a.pdf_rev_w, b.pdf_w, tolerance) && near_float(a.pdf_w, b.pdf_rev_w, tolerance));
    REQUIRE(near_float(adjoint.f_cos.x, a.f_cos.x * eta * eta, 1e-5f));
    REQUIRE(adjoint.pdf_w == a.pdf_w && adjoint.pdf_rev_w == a.pdf_rev_w);
}

START_TEST(test_reciprocity)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {2};
    Bsdf pool[POOL];
    pool_make(&scene, &random, pool);
    for (int n = 0; n < PAIRS; ++n) {
        const Bsdf *bsdf = &pool[n % POOL];
        if (bsdf->kind == MATERIAL_HAIR) /* not symmetric */
            continue;
        Vec3 wo = any_direction(&random), wi = any_direction(&random);
        BsdfSample sample;
        float u_lobe = random_float24(&random);
        pair_check(&scene, bsdf, wo, wi);
        if (bsdf_sample(&scene.view, bsdf, wo, u_lobe, random_vec2(&random), TRANSPORT_RADIANCE, &sample) &&
            !sample.delta)
            pair_check(&scene, bsdf, wo, sample.wi);
    }
    test_scene_destroy(&scene);
}
END_TEST

/* The reverse of a smooth refraction has the same probability, the inverse eta, and the weights 1 / eta^2 (radiance)
 * and 1 (importance). */
START_TEST(test_smooth_refraction)
{
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {3};
    Bsdf bsdf = test_bsdf(&scene, MATERIAL_DIELECTRIC, 0.0f, 0.0f, 1.5f, 0.0f, 0.0f);
    int refracted = 0;
    for (int n = 0; n < 20000; ++n) {
        Vec3 wo = any_direction(&random);
        BsdfSample forth, back, importance;
        if (!bsdf_sample(&scene.view, &bsdf, wo, 0.99999f, vec2(0.5f, 0.5f), TRANSPORT_RADIANCE, &forth) ||
            !forth.transmitted)
            continue;
        ++refracted;
        float eta = wo.z > 0.0f ? 1.5f : 1.0f / 1.5f;
        REQUIRE(forth.eta == eta);
        REQUIRE(near_float(forth.weight.x, 1.0f / (eta * eta), 1e-6f));
        REQUIRE(bsdf_sample(&scene.view, &bsdf, forth.wi, 0.99999f, vec2(0.5f, 0.5f), TRANSPORT_RADIANCE, &back));
        REQUIRE(bsdf_sample(&scene.view, &bsdf, wo, 0.99999f, vec2(0.5f, 0.5f), TRANSPORT_IMPORTANCE, &importance));
        REQUIRE(importance.weight.x == 1.0f);
        REQUIRE(near_float(back.eta, 1.0f / eta, 1e-6f));
        REQUIRE((double)vec3_length(vec3_sub(back.wi, wo)) < 1e-3); /* sqrt(ulp) where wo or wi is grazing */
        REQUIRE(fabs((double)(back.pdf_w - forth.pdf_rev_w)) < 4e-3);
        /* Snell: sin(theta_o) = eta sin(theta_i), in the same plane. */
        REQUIRE(fabs((double)(wo.x + eta * forth.wi.x)) + fabs((double)(wo.y + eta * forth.wi.y)) < 1e-6);
    }
    ck_assert_int_gt(refracted, 5000);
    test_scene_destroy(&scene);
}
END_TEST

static float extreme(TestRandom *random, const float *values, int count)
{
    uint64_t pick = random_next(random) % (uint64_t)(count + 2);
    return pick < (uint64_t)count ? values[pick] : (float)random_double(random);
}

static bool sane(Vec3 v)
{
    return vec3_finite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}

/* No NaN, infinity or negative number for a million extreme inputs. */
START_TEST(test_extreme_inputs)
{
    static const float ALPHAS[] = {0.0f, 1e-20f, 1e-4f, 9.99e-4f, 1e-3f, 1.001e-3f, 0.01f, 1.0f, 4.0f, 1e6f};
    static const float COSINES[] = {1.0f, 1e-8f, 1e-6f, 1.0001e-6f, 1e-5f, 1e-3f, 0.99999994f, 0.9999f};
    static const float ETAS[] = {1.0f, 1.00099f, 1.0011f, 0.998f, 1.5f, 0.1f, 10.0f, 4.0f};
    static const float COLORS[] = {0.0f, 1.0f, 1e-30f, 0.99999994f, 0.9999f, 50.0f};
    static const float NUMBERS[] = {0.0f, 0x1.fffffep-1f, 0x1p-24f, 0.5f, 1.0f - 0x1p-20f};
    TestScene scene;
    test_scene_init(&scene);
    uint32_t range, record;
    Error error;
    REQUIRE(coat_base_build(1.5f, 0.1f, true, &scene.lookup, &record, &error));
    REQUIRE(coat_table_build_range(1.5f, &scene.lookup, &range, &error));
    scene.view.lookup = scene.lookup.data;
    TestRandom random = {4};
    double largest_weight = 0.0;
    for (int n = 0; n < 1000000; ++n) {
        Bsdf bsdf = {.kind = (uint)(random_next(&random) % MATERIAL_MIX), .coat_table = n & 1 ? NONE : range};
        bool conductor = bsdf.kind == MATERIAL_CONDUCTOR;
        bsdf.color0 = vec3(extreme(&random, COLORS, conductor ? 6 : 5), extreme(&random, COLORS, 5), 0.5f);
        bsdf.color1 = vec3(extreme(&random, COLORS, conductor ? 6 : 5), extreme(&random, COLORS, 5), 0.5f);
        bsdf.alpha_x = extreme(&random, ALPHAS, 10);
        bsdf.alpha_y = n & 2 ? bsdf.alpha_x : extreme(&random, ALPHAS, 10);
        bool coated = bsdf.kind == MATERIAL_COATED_DIFFUSE || bsdf.kind == MATERIAL_COATED_CONDUCTOR;
        bsdf.eta = coated && !(n & 1) ? 1.5f : extreme(&random, ETAS, 8) + 0.05f;
        bsdf.flags = n & 4 && conductor ? BSDF_REFLECTANCE : 0u;
        if (bsdf.kind == MATERIAL_COATED_CONDUCTOR) {
            bsdf.coat_table = n & 1 ? NONE : record;
            bsdf.flags = bsdf_base_pack(extreme(&random, ALPHAS, 10), extreme(&random, ALPHAS, 10));
        }
        if (bsdf.kind == MATERIAL_HAIR) {
            bsdf.color1.x = float_clamp(2.0f * bsdf.color1.x - 1.0f, -1.0f, 1.0f);
            bsdf.alpha_x = float_clamp(bsdf.alpha_x, HAIR_BETA_MIN, 1.0f);
            bsdf.alpha_y = float_clamp(bsdf.alpha_y, HAIR_BETA_MIN, 1.0f);
        }
        bsdf_flags_set(&bsdf);
        double side_o = n & 8 ? 1.0 : -1.0, side_i = n & 16 ? 1.0 : -1.0;
        Vec3 wo = random_direction(&random, side_o * (double)extreme(&random, COSINES, 8));
        Vec3 wi = random_direction(&random, side_i * (double)extreme(&random, COSINES, 8));
        if (n & 32)
            wi = n & 64 ? vec3_negate(wo) : vec3(-wo.x, -wo.y, wo.z);
        BsdfValue value = bsdf_eval(&scene.view, &bsdf, wo, wi, (uint)n & 1u);
        REQUIRE_MSG(sane(value.f_cos) && sane(vec3(value.pdf_w, value.pdf_rev_w, 0.0f)),
                    "kind %u alpha %g %g eta %g: f %g pdf %g %g", bsdf.kind, (double)bsdf.alpha_x, (double)bsdf.alpha_y,
                    (double)bsdf.eta, (double)value.f_cos.x, (double)value.pdf_w, (double)value.pdf_rev_w);
        BsdfSample sample;
        float u_lobe = extreme(&random, NUMBERS, 5), u = extreme(&random, NUMBERS, 5);
        Vec2 u2 = vec2(u < 1.0f ? u : 0.5f, random_float24(&random));
        if (!bsdf_sample(&scene.view, &bsdf, wo, u_lobe < 1.0f ? u_lobe : 0.5f, u2, TRANSPORT_IMPORTANCE, &sample))
            continue;
        REQUIRE_MSG(
            sane(sample.weight) && sane(vec3(sample.pdf_w, sample.pdf_rev_w, sample.eta)) && sample.pdf_w > 0.0f &&
                vec3_finite(sample.wi) && fabs((double)vec3_length(sample.wi) - 1.0) < 1e-5,
            "kind %u alpha %g %g eta %g: weight %g pdf %g %g", bsdf.kind, (double)bsdf.alpha_x, (double)bsdf.alpha_y,
            (double)bsdf.eta, (double)sample.weight.x, (double)sample.pdf_w, (double)sample.pdf_rev_w);
        /* With lower eta, a coat emits light in a narrow cone that sampling does not follow; samples of hair do not
         * follow the ratio of cosines of importance. */
        if (bsdf.eta >= 0.5f && bsdf.kind != MATERIAL_HAIR)
            largest_weight = fmax(largest_weight, (double)vec3_max_component(sample.weight));
    }
    printf("# largest weight of a sample of importance: %.3g\n", largest_weight);
    REQUIRE(largest_weight < 20.0);
    test_scene_destroy(&scene);
}
END_TEST

/* Stored and loaded, a Bsdf of any kind between any media is what it was. */
START_TEST(test_stored)
{
    TestScene scene;
    TestRandom random = {9};
    uint words[STORED_BSDF_WORDS];
    test_scene_init(&scene);
    for (int n = 0; n < 1000; ++n) {
        Bsdf bsdf = {.kind = (uint)(random_next(&random) % (MATERIAL_PHASE + 1u)), .coat_table = 12u + (uint)n};
        bsdf.media = media_bits((uint)random_next(&random) % MEDIA_MAX, (uint)random_next(&random) % MEDIA_MAX);
        bsdf.flags = (uint)random_next(&random);
        bsdf.color0 = vec3(0.25f, 0.5f, random_float24(&random));
        bsdf.color1 = vec3(random_float24(&random), 2.0f, 3.0f);
        bsdf.alpha_x = random_float24(&random);
        bsdf.alpha_y = random_float24(&random);
        bsdf.eta = 1.0f + random_float24(&random);
        bsdf_store(&scene.view, words, 1u, 0u, 0u, &bsdf);
        Bsdf loaded = bsdf_load(&scene.view, words, 1u, 0u, 0u);
        REQUIRE(memcmp(&loaded, &bsdf, sizeof bsdf) == 0);
        REQUIRE(bsdf_kind_load(&scene.view, words, 1u, 0u, 0u) == bsdf.kind);
    }
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_identity_tests(void)
{
    TCase *tcase = tcase_create("identities");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_stored);
    tcase_add_test(tcase, test_weight_is_value_over_density);
    tcase_add_test(tcase, test_reciprocity);
    tcase_add_test(tcase, test_smooth_refraction);
    tcase_add_test(tcase, test_extreme_inputs);
    return tcase;
}
