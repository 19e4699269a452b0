/* bsdf_invert against bsdf_sample and bsdf_eval: the point that it returns samples the given direction, and the
 * densities of all lobes, each times its selection probability, add up to the direction's density. */
#include "support/bsdf_cases.h"

#include "bsdf/bsdf.h"

#define DRAWS 20000

/* Probability of selecting the lobe that the inverse found, over u_lobe. */
static double lobe_probability(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, bool base)
{
    bool flip = wo.z<0.0f, same = wo.z * wi.z> 0.0f;
    float t_o, specular;
    if (bsdf->kind == MATERIAL_DIFFUSE_TRANSMISSION) {
        specular = diffuse_transmission_reflect_probability(bsdf);
        return same ? (double)specular : 1.0 - (double)specular;
    }
    if (bsdf->kind == MATERIAL_COATED_DIFFUSE) {
        specular = coated_specular(&scene->view, bsdf, direction_flip(wo, flip), &t_o);
        return base ? 1.0 - (double)specular : (double)specular;
    }
    if (bsdf->kind != MATERIAL_DIELECTRIC)
        return 1.0;
    float eta = dielectric_relative_eta(bsdf->eta, wo);
    Vec3 o = direction_flip(wo, flip), i = direction_flip(wi, flip), h = same ? vec3_add(o, i) : vec3_mad(o, eta, i);
    double reflectance = (double)fresnel_dielectric(float_abs(vec3_dot(o, h)) / vec3_length(h), eta);
    return same ? reflectance : 1.0 - reflectance;
}

/* A coated conductor has two lobes that are drawn with the same point. */
static double density_of_coated_conductor(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    Vec3 o = direction_flip(wo, wo.z < 0.0f);
    CoatedConductor c = coated_conductor(&scene->view, bsdf);
    CoatedSide side = coated_side(&scene->view, bsdf, &c, o);
    const float ends[4] = {0.0f, side.coat, side.direct, 1.0f};
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        BsdfInverse inverse;
        float width = ends[k + 1] - ends[k];
        if (width > 0.0f && bsdf_invert(&scene->view, bsdf, wo, wi, ends[k] + 0.5f * width, &inverse))
            sum += (double)width * (double)inverse.pdf_w;
    }
    return sum;
}

/* Sum over the lobes; a grid of u_lobe finds them all. */
static double density_of_lobes(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    double sum = 0.0;
    bool seen[2] = {false, false};
    if (bsdf->kind == MATERIAL_COATED_CONDUCTOR)
        return density_of_coated_conductor(scene, bsdf, wo, wi);
    for (int k = 0; k < 1024; ++k) {
        BsdfInverse inverse;
        if (!bsdf_invert(&scene->view, bsdf, wo, wi, ((float)k + 0.5f) / 1024.0f, &inverse) || seen[inverse.base])
            continue;
        seen[inverse.base] = true;
        sum += lobe_probability(scene, bsdf, wo, wi, inverse.base) * (double)inverse.pdf_w;
    }
    return sum;
}

typedef struct InverseCounts {
    double near; /* in: distances up to this one do not count as far */
    int drawn, lost, far, wrong;
    double farthest;
} InverseCounts;

/* Inverts one sampled direction. Distances are in units of 1 / sqrt(pdf_w), the root of the sample's solid angle. */
static void inverse_try(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, TestRandom *random, bool density,
                        InverseCounts *counts)
{
    BsdfSample sample, again;
    BsdfInverse inverse;
    float u_lobe = random_float24(random);
    if (!bsdf_sample(&scene->view, bsdf, wo, u_lobe, random_vec2(random), TRANSPORT_RADIANCE, &sample))
        return;
    if (sample.delta) {
        REQUIRE(!bsdf_invert(&scene->view, bsdf, wo, sample.wi, u_lobe, &inverse));
        return;
    }
    ++counts->drawn;
    if (!bsdf_invert(&scene->view, bsdf, wo, sample.wi, u_lobe, &inverse) ||
        !bsdf_sample(&scene->view, bsdf, wo, u_lobe, inverse.u, TRANSPORT_RADIANCE, &again)) {
        ++counts->lost;
        return;
    }
    double away = (double)vec3_length(vec3_sub(again.wi, sample.wi)) * sqrt((double)inverse.pdf_w);
    counts->farthest = fmax(counts->farthest, away);
    counts->far += away > counts->near;
    if (density) {
        double all = density_of_lobes(scene, bsdf, wo, sample.wi);
        double pdf = (double)bsdf_eval(&scene->view, bsdf, wo, sample.wi, TRANSPORT_RADIANCE).pdf_w;
        counts->wrong += fabs(all - pdf) > 1e-3 * pdf;
    }
}

/* Nearly every direction is reproduced to 0.01 of the lobe's width; to 0.2 at 0.1 degrees above the surface, where the
 * half vector in floats is that coarse relative to a lobe of alpha 1e-3. Directions at the border between two lobes may
 * round to the other side. */
START_TEST(test_inverse)
{
    const struct TestMaterial *kind = &TEST_MATERIALS[_i];
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {(uint64_t)(500 + _i)};
    double farthest = 0.0;
    for (int a = kind->alphas > 1; a < kind->alphas; ++a) {
        Bsdf bsdf =
            test_bsdf(&scene, kind->kind, TEST_ALPHAS[a].x, TEST_ALPHAS[a].y, kind->eta, kind->color0, kind->color1);
        for (int d = 0; d < TEST_WO_COUNT; ++d) {
            bool coarse = fabsf(test_wo(d).z) < 0.01f && TEST_ALPHAS[a].x < 0.01f && kind->alphas > 1;
            InverseCounts counts = {.near = coarse ? 0.2 : 0.01};
            for (int n = 0; n < DRAWS; ++n)
                inverse_try(&scene, &bsdf, test_wo(d), &random, n % 20 == 0, &counts);
            REQUIRE_MSG(counts.drawn > 0, "%s, alpha %g, direction %d: nothing drawn", kind->name, (double)bsdf.alpha_x,
                        d);
            REQUIRE_MSG(counts.lost * (coarse ? 500 : 1000) <= counts.drawn && counts.far * 1000 <= counts.drawn &&
                            counts.wrong <= 1,
                        "%s, alpha %g %g, direction %d: of %d directions %d not found, %d not drawn again (%g), %d "
                        "densities differ",
                        kind->name, (double)bsdf.alpha_x, (double)bsdf.alpha_y, d, counts.drawn, counts.lost,
                        counts.far, counts.farthest, counts.wrong);
            farthest = fmax(farthest, counts.farthest);
        }
    }
    printf("# %s: at most %.2g of a lobe's width away\n", kind->name, farthest);
    test_scene_destroy(&scene);
}
END_TEST

/* For independent directions and lobe numbers: if an inverse is found, it samples the direction with that lobe number,
 * and its density is positive. Narrow lobes are excluded: in their tails floats do not resolve half vectors. */
START_TEST(test_any)
{
    const struct TestMaterial *kind = &TEST_MATERIALS[_i];
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {(uint64_t)(900 + _i)};
    int found = 0, far = 0;
    for (int a = 0; a < kind->alphas; ++a) {
        if (kind->alphas > 1 && fminf(TEST_ALPHAS[a].x, TEST_ALPHAS[a].y) < 0.1f)
            continue;
        Bsdf bsdf =
            test_bsdf(&scene, kind->kind, TEST_ALPHAS[a].x, TEST_ALPHAS[a].y, kind->eta, kind->color0, kind->color1);
        for (int n = 0; n < DRAWS; ++n) {
            Vec3 wo = random_direction(&random, 2.0 * random_double(&random) - 1.0);
            Vec3 wi = random_direction(&random, 2.0 * random_double(&random) - 1.0);
            float u_lobe = random_float24(&random);
            BsdfInverse inverse;
            BsdfSample sample;
            if (fabsf(wo.z) < 0.05f || fabsf(wi.z) < 0.05f ||
                !bsdf_invert(&scene.view, &bsdf, wo, wi, u_lobe, &inverse))
                continue;
            ++found;
            REQUIRE_MSG(inverse.pdf_w > 0.0f, "%s: found with density %g", kind->name, (double)inverse.pdf_w);
            far += !bsdf_sample(&scene.view, &bsdf, wo, u_lobe, inverse.u, TRANSPORT_RADIANCE, &sample) ||
                   (double)vec3_length(vec3_sub(sample.wi, wi)) > 0.01;
        }
    }
    printf("# %s: %d found, of which %d are not drawn again\n", kind->name, found, far);
    REQUIRE_MSG(far * 500 <= found, "%s: %d found, of which %d are not drawn again", kind->name, found, far);
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_inverse_tests(void)
{
    TCase *tcase = tcase_create("inverse");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_inverse, 0, TEST_MATERIAL_COUNT);
    tcase_add_loop_test(tcase, test_any, 0, TEST_MATERIAL_COUNT);
    return tcase;
}
