/* Hair: values against a reference in double, samples against their density, energy, absorption, and paths from the
 * light against those from the camera, on surfaces and on curves. */
#include "support/bsdf_cases.h"

#include "bsdf/material.h"

#define SAMPLES 100000
#define ROWS 24 /* cells in x, which is uniform on the sphere */
#define COLUMNS 32 /* in azimuth around x */

static Bsdf hair_bsdf(float beta_m, float beta_n, float h, float absorption, uint flags)
{
    return (Bsdf){.kind = MATERIAL_HAIR,
                  .flags = flags,
                  .color0 = {absorption, 2.0f * absorption, 4.0f * absorption},
                  .color1 = {h, 2.0f * (float)(TEST_PI / 180.0), 0.0f},
                  .alpha_x = beta_m,
                  .alpha_y = beta_n,
                  .eta = 1.55f,
                  .coat_table = NONE};
}

/* ---- the reference: Chiang et al. 2016, in double ---------------------------------------------------------------- */

static double bessel_i0(double x)
{
    double sum = 1.0, term = 1.0;
    for (int i = 1; i < 2000; ++i) {
        term *= x * x / (4.0 * i * i);
        sum += term;
    }
    return sum;
}

/* M_p, for 1 / v that neither overflows nor cancels. */
static double longitudinal(double theta_i, double theta_o, double v)
{
    return exp(-sin(theta_i) * sin(theta_o) / v) * bessel_i0(cos(theta_i) * cos(theta_o) / v) /
           (2.0 * v * sinh(1.0 / v));
}

static double logistic(double x, double s)
{
    return exp(-fabs(x) / s) / (s * pow(1.0 + exp(-fabs(x) / s), 2.0));
}

static double logistic_sum(double x, double s)
{
    return 1.0 / (1.0 + exp(-x / s));
}

static double azimuthal(double phi, int p, double s, double gamma_o, double gamma_t)
{
    double x = remainder(phi - (2.0 * p * gamma_t - 2.0 * gamma_o + p * TEST_PI), 2.0 * TEST_PI);
    return logistic(x, s) / (logistic_sum(TEST_PI, s) - logistic_sum(-TEST_PI, s));
}

/* S and the density of the first channel. */
static double scattering(const Bsdf *bsdf, Vec3 wo, Vec3 wi)
{
    double theta_o = asin((double)wo.x), theta_i = asin((double)wi.x), h = (double)bsdf->color1.x;
    double phi = atan2((double)wi.z, (double)wi.y) - atan2((double)wo.z, (double)wo.y), eta = (double)bsdf->eta;
    double bm = (double)bsdf->alpha_x, bn = (double)bsdf->alpha_y, tilt = (double)bsdf->color1.y;
    double v0 = pow(0.726 * bm + 0.812 * bm * bm + 3.7 * pow(bm, 20), 2.0);
    double s = sqrt(TEST_PI / 8.0) * (0.265 * bn + 1.194 * bn * bn + 5.372 * pow(bn, 22));
    double etap = sqrt(eta * eta - pow(sin(theta_o), 2.0)) / cos(theta_o);
    double gamma_o = asin(h), gamma_t = asin(h / etap), cos_t = sqrt(1.0 - pow(sin(theta_o) / eta, 2.0));
    double t = exp(-(double)bsdf->color0.x * 2.0 * cos(gamma_t) / cos_t);
    double f = (double)fresnel_dielectric((float)(cos(theta_o) * sqrt(1.0 - h * h)), bsdf->eta);
    double a[4] = {f, (1.0 - f) * (1.0 - f) * t, (1.0 - f) * (1.0 - f) * t * t * f, 0.0};
    a[3] = a[2] * f * t / (1.0 - t * f);
    const double v[4] = {v0, 0.25 * v0, 4.0 * v0, 4.0 * v0}, turn[4] = {-2.0, 1.0, 4.0, 0.0};
    double sum = 0.0;
    for (int p = 0; p < 4; ++p) {
        double turned = theta_o + turn[p] * tilt;
        turned = asin(sin(turned)); /* its cosine counts as positive */
        sum += a[p] * longitudinal(theta_i, turned, v[p]) *
               (p == 3 ? 0.5 / TEST_PI : azimuthal(phi, p, s, gamma_o, gamma_t));
    }
    return sum;
}

START_TEST(test_values)
{
    static const float BETAS[] = {0.1f, 0.2f, 0.3f, 0.6f, 1.0f};
    TestScene scene;
    TestRandom random = {900};
    double worst = 0.0;
    test_scene_init(&scene);
    for (int i = 0; i < 20000; ++i) {
        Bsdf bsdf = hair_bsdf(BETAS[i % 5], BETAS[i / 5 % 5], 2.0f * random_float24(&random) - 1.0f,
                              random_float24(&random), 0u);
        Vec3 wo = random_direction(&random, 2.0 * random_double(&random) - 1.0);
        Vec3 wi = random_direction(&random, 2.0 * random_double(&random) - 1.0);
        if (fabsf(wo.x) > 0.999f)
            continue;
        double value = (double)bsdf_eval(&scene.view, &bsdf, wo, wi, TRANSPORT_RADIANCE).f_cos.x;
        double exact = scattering(&bsdf, wo, wi);
        worst = fmax(worst, fabs(value - exact) / (exact + 1e-3));
    }
    printf("# hair: values off by at most %.2g\n", worst);
    REQUIRE_MSG(worst < 2e-3, "values are off by %g", worst);
    test_scene_destroy(&scene);
}
END_TEST

/* The integral of M_p cos(theta_i), by the midpoint rule around its peak. */
static double longitudinal_integral(double theta_o, float v)
{
    enum { STEPS = 2000 };
    double reach = 10.0 * sqrt((double)v), sum = 0.0;
    double low = fmax(-theta_o - reach, -0.5 * TEST_PI), high = fmin(-theta_o + reach, 0.5 * TEST_PI);
    HairAngle o = {(float)sin(theta_o), (float)cos(theta_o)};
    for (int k = 0; k < STEPS; ++k) {
        double theta = low + (high - low) * (k + 0.5) / STEPS;
        HairAngle i = {(float)sin(theta), (float)cos(theta)};
        sum += (double)hair_longitudinal(i, o, v) * cos(theta) * (high - low) / STEPS;
    }
    return sum;
}

/* exp(-x) I_0(x), and M_p for roughnesses down to the smallest, whose exponentials would overflow on their own. */
START_TEST(test_longitudinal)
{
    double bessel = 0.0, worst = 0.0;
    for (float x = 0.0f; x < 80.0f; x += 0.01f)
        bessel = fmax(bessel, fabs((double)bessel_i0_scaled(x) / (bessel_i0((double)x) * exp(-(double)x)) - 1.0));
    for (float x = 80.0f; x < 1e6f; x *= 1.1f) { /* its asymptotic series */
        double y = (double)x;
        double series = (1.0 + 1.0 / (8.0 * y) + 9.0 / (128.0 * y * y)) / sqrt(2.0 * TEST_PI * y);
        bessel = fmax(bessel, fabs((double)bessel_i0_scaled(x) / series - 1.0));
    }
    for (float beta = HAIR_BETA_MIN; beta <= 1.0f; beta += 0.01f)
        for (double theta_o = -1.5; theta_o <= 1.5; theta_o += 0.3) {
            double sum = longitudinal_integral(theta_o, 0.25f * hair_variance(beta));
            REQUIRE(isfinite(sum));
            worst = fmax(worst, fabs(sum - 1.0));
        }
    printf("# exp(-x) I0(x) off by at most %.2g, M_p integrates to 1 within %.2g\n", bessel, worst);
    REQUIRE_MSG(bessel < 1e-6, "exp(-x) I0(x) is off by %g", bessel);
    REQUIRE_MSG(worst < 1e-3, "M_p does not integrate to 1: %g", worst);
}
END_TEST

/* ---- sampling ---------------------------------------------------------------------------------------------------- */

typedef struct HairCase {
    float beta_m, beta_n, h;
    uint flags, transport;
} HairCase;

static Vec3 cell_direction(double row, double column)
{
    double x = 2.0 * row / ROWS - 1.0, phi = 2.0 * TEST_PI * column / COLUMNS, r = sqrt(fmax(1.0 - x * x, 0.0));
    return vec3((float)x, (float)(r * cos(phi)), (float)(r * sin(phi)));
}

static double cell_density(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, int row, int column, uint transport)
{
    enum { STEPS = 12 };
    double sum = 0.0, area = 4.0 * TEST_PI / (ROWS * COLUMNS * STEPS * STEPS);
    for (int i = 0; i < STEPS; ++i)
        for (int j = 0; j < STEPS; ++j) {
            Vec3 wi = cell_direction(row + (i + 0.5) / STEPS, column + (j + 0.5) / STEPS);
            sum += (double)bsdf_eval(&scene->view, bsdf, wo, wi, transport).pdf_w * area;
        }
    return sum;
}

static int cell_of(Vec3 w)
{
    double phi = atan2((double)w.z, (double)w.y);
    phi += phi < 0.0 ? 2.0 * TEST_PI : 0.0;
    int row = (int)fmin(0.5 * ((double)w.x + 1.0) * ROWS, ROWS - 1),
        column = (int)fmin(phi / (2.0 * TEST_PI) * COLUMNS, COLUMNS - 1);
    return row * COLUMNS + column;
}

static void samples_check(const TestScene *scene, HairCase c, Vec3 wo, uint64_t seed)
{
    static double observed[ROWS * COLUMNS], expected[ROWS * COLUMNS];
    TestRandom random = {seed};
    Bsdf bsdf = hair_bsdf(c.beta_m, c.beta_n, c.h, 0.3f, c.flags);
    double integral = 0.0;
    memset(observed, 0, sizeof observed);
    for (int n = 0; n < SAMPLES; ++n) {
        BsdfSample sample;
        float u_lobe = random_float24(&random);
        REQUIRE(bsdf_sample(&scene->view, &bsdf, wo, u_lobe, random_vec2(&random), c.transport, &sample));
        REQUIRE(fabsf(vec3_length(sample.wi) - 1.0f) < 1e-5f);
        observed[cell_of(sample.wi)] += 1.0;
        if (n >= 200)
            continue;
        BsdfValue value = bsdf_eval(&scene->view, &bsdf, wo, sample.wi, c.transport);
        float weight = sample.weight.x * sample.pdf_w;
        REQUIRE(fabsf(value.pdf_w - sample.pdf_w) <= 1e-4f * sample.pdf_w);
        REQUIRE(fabsf(value.pdf_rev_w - sample.pdf_rev_w) <= 1e-4f * value.pdf_rev_w);
        REQUIRE(fabsf(value.f_cos.x - weight) <= 1e-4f * weight);
    }
    for (int i = 0; i < ROWS * COLUMNS; ++i) {
        double part = cell_density(scene, &bsdf, wo, i / COLUMNS, i % COLUMNS, c.transport);
        expected[i] = part * SAMPLES;
        integral += part;
    }
    double p = test_chi_square(observed, expected, ROWS * COLUMNS);
    REQUIRE_MSG(p > 1e-5 && fabs(integral - 1.0) < 2e-3,
                "beta %g %g, h %g, flags %u, transport %u: p = %g, integral %g", (double)c.beta_m, (double)c.beta_n,
                (double)c.h, c.flags, c.transport, p, integral);
}

START_TEST(test_samples)
{
    static const float BETAS[][2] = {{0.3f, 0.3f}, {0.5f, 0.25f}, {1.0f, 0.6f}, {0.3f, 1.0f}};
    static const float H[] = {-0.95f, 0.0f, 0.4f};
    TestScene scene;
    test_scene_init(&scene);
    for (uint i = 0; i < 24; ++i) {
        HairCase c = {BETAS[i % 4][0], BETAS[i % 4][1], H[i % 3], i < 12 ? 0u : BSDF_FIBRE,
                      i % 2 == 0 ? TRANSPORT_RADIANCE : TRANSPORT_IMPORTANCE};
        samples_check(&scene, c, vec3_normalize(vec3(i % 3 == 0 ? -0.7f : 0.4f, i < 12 ? 0.5f : 0.0f, 0.8f)), i);
    }
    test_scene_destroy(&scene);
}
END_TEST

/* ---- energy ------------------------------------------------------------------------------------------------------ */

/* Without absorption all light leaves: every sample weighs 1. With absorption, none weighs more. */
START_TEST(test_energy)
{
    static const float BETAS[] = {0.01f, 0.1f, 0.3f, 0.6f, 1.0f}, H[] = {-1.0f, -0.99f, -0.5f, 0.0f, 0.3f, 0.9f, 1.0f};
    TestScene scene;
    TestRandom random = {910};
    test_scene_init(&scene);
    for (int i = 0; i < 5 * 5 * 7 * 300; ++i) {
        BsdfSample sample;
        uint flags = i % 2 == 0 ? 0u : BSDF_FIBRE;
        Vec3 wo = random_direction(&random, 2.0 * random_double(&random) - 1.0);
        Bsdf bsdf = hair_bsdf(BETAS[i % 5], BETAS[i / 5 % 5], H[i / 25 % 7], 0.0f, flags);
        float u_lobe = random_float24(&random);
        Vec2 u = random_vec2(&random);
        REQUIRE(bsdf_sample(&scene.view, &bsdf, wo, u_lobe, u, TRANSPORT_RADIANCE, &sample));
        REQUIRE_MSG(fabsf(sample.weight.x - 1.0f) < 1e-4f, "weight %g", (double)sample.weight.x);
        bsdf.color0 = vec3(0.1f, 1.0f, 1e4f);
        if (!bsdf_sample(&scene.view, &bsdf, wo, u_lobe, u, TRANSPORT_RADIANCE, &sample))
            continue;
        double mean = (double)vec3_mean(sample.weight);
        REQUIRE(isfinite(mean) && mean <= 1.0 + 1e-4);
        REQUIRE(sample.weight.z <= sample.weight.y * 1.0001f && sample.weight.y <= sample.weight.x * 1.0001f);
    }
    test_scene_destroy(&scene);
}
END_TEST

/* pbrt's formulas in double. */
START_TEST(test_absorption)
{
    for (float beta = 0.05f; beta <= 1.0f; beta += 0.05f)
        for (float c = 0.05f; c < 1.0f; c += 0.05f) {
            double b = (double)beta;
            double divisor =
                5.969 - 0.215 * b + 2.532 * b * b - 10.73 * pow(b, 3) + 5.574 * pow(b, 4) + 0.245 * pow(b, 5);
            double exact = pow(log((double)c) / divisor, 2.0);
            REQUIRE(fabs((double)hair_absorption(c, beta) - exact) < 1e-5 * exact);
        }
    Vec3 sigma = hair_melanin(1.3f, 0.5f);
    REQUIRE(fabsf(sigma.x - (1.3f * 0.419f + 0.5f * 0.187f)) < 1e-6f);
    REQUIRE(fabsf(sigma.y - (1.3f * 0.697f + 0.5f * 0.4f)) < 1e-6f);
    REQUIRE(fabsf(sigma.z - (1.3f * 1.37f + 0.5f * 1.05f)) < 1e-6f);
    REQUIRE(float_finite(hair_absorption(0.0f, 0.3f)) && hair_absorption(1.0f, 0.3f) == 0.0f);
}
END_TEST

/* What a material makes of its parameters: colours, bounds of roughness, and h from v. */
START_TEST(test_material)
{
    TestScene scene;
    TexturePoint point = {.uv = {0.1f, 0.75f}};
    Material m = {.kind = MATERIAL_HAIR,
                  .flags = MATERIAL_HAIR_MELANIN,
                  .color0 = {{0.2f, 0.4f, 0.6f}, NONE},
                  .roughness_u = {0.001f, NONE},
                  .roughness_v = {0.4f, NONE},
                  .amount = {2.0f, NONE},
                  .base_u = {0.3f, NONE},
                  .base_v = {-1.0f, NONE},
                  .eta = 1.55f};
    test_scene_init(&scene);
    scene.view.materials = &m;
    Bsdf bsdf = material_bsdf(&scene.view, 0, &point);
    REQUIRE(bsdf.kind == MATERIAL_HAIR && bsdf.eta == 1.55f && bsdf.color1.x == 0.5f);
    REQUIRE(bsdf.alpha_x == HAIR_BETA_MIN && bsdf.alpha_y == 0.4f);
    REQUIRE(fabsf(bsdf.color1.y - 2.0f * (float)(TEST_PI / 180.0)) < 1e-7f);
    REQUIRE(fabsf(bsdf.color0.x - 0.3f * 0.419f) < 1e-6f && fabsf(bsdf.color0.z - 0.3f * 1.37f) < 1e-6f);
    m.flags = MATERIAL_HAIR_COLOR;
    bsdf = material_bsdf(&scene.view, 0, &point);
    REQUIRE(bsdf.color0.y == hair_absorption(0.4f, 0.4f));
    m.flags = 0u;
    m.color0.value = vec3(-1.0f, 2.0f, 3.0f);
    bsdf = material_bsdf(&scene.view, 0, &point);
    REQUIRE(bsdf.color0.x == 0.0f && bsdf.color0.y == 2.0f && bsdf.color0.z == 3.0f);
    test_scene_destroy(&scene);
}
END_TEST

/* ---- paths from the light ---------------------------------------------------------------------------------------- */

/* What a path from the light finds at a surface is what one from the camera finds. */
START_TEST(test_adjoint_on_surfaces)
{
    TestScene scene;
    TestRandom random = {920};
    test_scene_init(&scene);
    for (int i = 0; i < 20000; ++i) {
        Bsdf bsdf = hair_bsdf(0.3f, 0.4f, 2.0f * random_float24(&random) - 1.0f, 0.3f, 0u);
        Vec3 camera = random_direction(&random, 2.0 * random_double(&random) - 1.0);
        Vec3 light = random_direction(&random, 2.0 * random_double(&random) - 1.0);
        BsdfValue from_camera = bsdf_eval(&scene.view, &bsdf, camera, light, TRANSPORT_RADIANCE);
        BsdfValue from_light = bsdf_eval(&scene.view, &bsdf, light, camera, TRANSPORT_IMPORTANCE);
        float scale = fabsf(camera.z / light.z);
        REQUIRE(fabsf(from_light.f_cos.x - scale * from_camera.f_cos.x) <= 1e-4f * from_light.f_cos.x);
        REQUIRE(from_light.pdf_w == from_camera.pdf_rev_w && from_light.pdf_rev_w == from_camera.pdf_w);
    }
    test_scene_destroy(&scene);
}
END_TEST

/* Paths from the light draw by almost what they find: mirrored hair scatters as hair does, seen the other way. */
START_TEST(test_samples_from_the_light)
{
    TestScene scene;
    TestRandom random = {925};
    int near = 0, all = 0;
    test_scene_init(&scene);
    for (int i = 0; i < 20000; ++i) {
        BsdfSample sample;
        Bsdf bsdf = hair_bsdf(0.3f, 0.3f, i % 2 == 0 ? 0.6f : -0.6f, 0.3f, 0u);
        Vec3 wo = random_direction(&random, 2.0 * random_double(&random) - 1.0);
        float u_lobe = random_float24(&random);
        if (!bsdf_sample(&scene.view, &bsdf, wo, u_lobe, random_vec2(&random), TRANSPORT_IMPORTANCE, &sample))
            continue;
        float weight = sample.weight.x * fabsf(wo.z / sample.wi.z);
        ++all;
        near += weight > 0.3f && weight < 2.0f;
    }
    REQUIRE_MSG(near > 0.8 * all, "%d of %d samples weigh 0.3 to 2", near, all);
    test_scene_destroy(&scene);
}
END_TEST

/* w in the frame of a curve that faces o: x along the tangent, z towards o. */
static Vec3 facing(Vec3 o, Vec3 w)
{
    float length = sqrtf(o.y * o.y + o.z * o.z);
    return vec3(w.x, (w.y * o.z - w.z * o.y) / length, (w.y * o.y + w.z * o.z) / length);
}

/* The same on curves, which face the direction from which a path arrives, for every BSDF. There the path from the light
 * is the mirror image, and each end of the path has the cosine of its angle to the plane across the curve. */
static void fibre_check(const TestScene *scene, Bsdf bsdf, TestRandom *random)
{
    Vec3 camera = random_direction(random, 2.0 * random_double(random) - 1.0);
    Vec3 light = random_direction(random, 2.0 * random_double(random) - 1.0), mirror;
    bsdf.flags |= BSDF_FIBRE;
    float cosine_c = sqrtf(1.0f - camera.x * camera.x), cosine_l = sqrtf(1.0f - light.x * light.x);
    if (cosine_c < 0.05f || cosine_l < 0.05f)
        return;
    BsdfValue from_camera =
        bsdf_eval(&scene->view, &bsdf, facing(camera, camera), facing(camera, light), TRANSPORT_RADIANCE);
    mirror = facing(light, camera);
    mirror.y = -mirror.y;
    BsdfValue from_light = bsdf_eval(&scene->view, &bsdf, facing(light, light), mirror, TRANSPORT_IMPORTANCE);
    float a = from_camera.f_cos.x * cosine_c, b = from_light.f_cos.x * cosine_l;
    REQUIRE_MSG(fabsf(a - b) <= 3e-3f * fmaxf(a, b) + 1e-6f, "kind %u: %g from the camera, %g from the light",
                bsdf.kind, (double)a, (double)b);
    REQUIRE(fabsf(from_light.pdf_w - from_camera.pdf_rev_w) <= 3e-3f * from_light.pdf_w + 1e-6f);
    REQUIRE(fabsf(from_light.pdf_rev_w - from_camera.pdf_w) <= 3e-3f * from_camera.pdf_w + 1e-6f);
}

START_TEST(test_adjoint_on_curves)
{
    TestScene scene;
    TestRandom random = {930};
    test_scene_init(&scene);
    for (int i = 0; i < 20000; ++i) {
        fibre_check(&scene, hair_bsdf(0.3f, 0.4f, 2.0f * random_float24(&random) - 1.0f, 0.3f, 0u), &random);
        fibre_check(&scene, test_bsdf(&scene, MATERIAL_DIFFUSE, 0, 0, 1.0f, 0.5f, 0.0f), &random);
        fibre_check(&scene, test_bsdf(&scene, MATERIAL_DIFFUSE_TRANSMISSION, 0, 0, 1.0f, 0.3f, 0.6f), &random);
        fibre_check(&scene, test_bsdf(&scene, MATERIAL_CONDUCTOR, 0.4f, 0.4f, 1.0f, 0.2f, 3.9f), &random);
    }
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_hair_tests(void)
{
    TCase *tcase = tcase_create("hair");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_values);
    tcase_add_test(tcase, test_longitudinal);
    tcase_add_test(tcase, test_samples);
    tcase_add_test(tcase, test_energy);
    tcase_add_test(tcase, test_absorption);
    tcase_add_test(tcase, test_material);
    tcase_add_test(tcase, test_adjoint_on_surfaces);
    tcase_add_test(tcase, test_samples_from_the_light);
    tcase_add_test(tcase, test_adjoint_on_curves);
    return tcase;
}
