/* Samples against the density: chi-square per BSDF, roughness and direction. */
#include "support/bsdf_cases.h"

#define SAMPLES 200000
#define CELLS 24

/* Cells over one hemisphere in z = |cos| and azimuth, both spaced as sinh around a lobe's peak: linear within a GGX
 * lobe, logarithmic in its tails, and bounded by the horizon. */
typedef struct LobeGrid {
    double z0, z_scale, z_low, z_range; /* low, range: of asinh, for z in 0..1 */
    double phi0, phi_scale, phi_range;
} LobeGrid;

static LobeGrid grid_make(Vec3 peak, double alpha)
{
    double z = fabs((double)peak.z), sine = sqrt((double)peak.x * (double)peak.x + (double)peak.y * (double)peak.y);
    if (sine * sine < 0.5)
        z = sqrt(1.0 - sine * sine);
    LobeGrid grid = {.z0 = z};
    grid.z_scale = 2.0 * alpha * sine + 2.0 * alpha * alpha + 1e-9;
    grid.z_low = asinh(-z / grid.z_scale);
    grid.z_range = asinh((1.0 - z) / grid.z_scale) - grid.z_low;
    grid.phi0 = atan2((double)peak.y, (double)peak.x);
    grid.phi_scale = fmin(10.0, 2.0 * alpha * (z + alpha) / fmax(sine, 1e-9));
    grid.phi_range = asinh(TEST_PI / grid.phi_scale);
    return grid;
}

/* Direction at (a, b) of the unit square and the Jacobian d(omega)/d(a, b). */
static Vec3 grid_direction(const LobeGrid *grid, double a, double b, double side, double *jacobian)
{
    double t = sinh(grid->z_low + a * grid->z_range), p = sinh((2.0 * b - 1.0) * grid->phi_range);
    double z = fmin(fmax(grid->z0 + grid->z_scale * t, 0.0), 1.0), phi = grid->phi0 + grid->phi_scale * p;
    double sine = sqrt((1.0 - z) * (1.0 + z));
    *jacobian =
        grid->z_scale * grid->z_range * sqrt(1.0 + t * t) * grid->phi_scale * 2.0 * grid->phi_range * sqrt(1.0 + p * p);
    return vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)(side * z));
}

/* Close to the pole z is computed from x and y, which have more significant digits. */
static int grid_cell(const LobeGrid *grid, Vec3 w)
{
    double r2 = (double)w.x * (double)w.x + (double)w.y * (double)w.y;
    double z = r2 < 0.5 ? sqrt(1.0 - r2) : fabs((double)w.z);
    double a = (asinh((z - grid->z0) / grid->z_scale) - grid->z_low) / grid->z_range;
    double phi = remainder(atan2((double)w.y, (double)w.x) - grid->phi0, 2.0 * TEST_PI);
    double b = 0.5 + 0.5 * asinh(phi / grid->phi_scale) / grid->phi_range;
    int row = (int)fmin(fmax(a * CELLS, 0.0), CELLS - 1), column = (int)fmin(fmax(b * CELLS, 0.0), CELLS - 1);
    return row * CELLS + column;
}

typedef struct LobeCase {
    const TestScene *scene;
    Bsdf bsdf;
    Vec3 wo;
    double alpha;
    LobeGrid grid[2]; /* [0] wo's side, [1] the other side */
    double side[2];
} LobeCase;

static double lobe_density(const LobeCase *lobe, int s, double a, double b)
{
    double jacobian;
    Vec3 wi = grid_direction(&lobe->grid[s], a, b, lobe->side[s], &jacobian);
    return (double)bsdf_eval(&lobe->scene->view, &lobe->bsdf, lobe->wo, wi, TRANSPORT_RADIANCE).pdf_w * jacobian;
}

/* Integral over a square by Gauss-Legendre 3 x 3, subdivided until the four quarters agree with the whole. Always
 * subdivided at the horizon (a = 0): for a grazing wo, refraction ends at |z| = |wo.z| / eta, a step that no node
 * sees. */
static double lobe_integrate(const LobeCase *lobe, int s, double a, double b, double width, int depth)
{
    static const double X[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double W[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    double quarters = 0.0, whole = 0.0, half = 0.5 * width;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            whole += W[i] * W[j] * lobe_density(lobe, s, a + X[i] * width, b + X[j] * width);
    whole *= width * width;
    for (int q = 0; q < 4; ++q)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i)
                quarters += W[i] * W[j] * 0.25 * width * width *
                            lobe_density(lobe, s, a + ((q & 1) + X[i]) * half, b + ((q >> 1) + X[j]) * half);
    if (depth == 0 || (fabs(quarters - whole) < 2e-7 + 5e-4 * quarters && (a > 0.0 || depth < 4)))
        return quarters;
    double sum = 0.0;
    for (int q = 0; q < 4; ++q)
        sum += lobe_integrate(lobe, s, a + (q & 1) * half, b + (q >> 1) * half, half, depth - 1);
    return sum;
}

static LobeCase lobe_make(const TestScene *scene, Bsdf bsdf, Vec3 wo)
{
    LobeCase lobe = {.scene = scene, .bsdf = bsdf, .wo = wo};
    double eta = (double)dielectric_relative_eta(bsdf.eta, wo);
    double cos_t = (double)refraction_cosine(fabsf(wo.z), (float)eta);
    Vec3 refracted = vec3(-wo.x / (float)eta, -wo.y / (float)eta, (float)fmax(cos_t, 0.05));
    lobe.alpha = (bsdf.flags & BSDF_ROUGH) != 0u ? (double)fmaxf(bsdf.alpha_x, bsdf.alpha_y) : 1.0;
    if (bsdf.kind == MATERIAL_COATED_CONDUCTOR)
        lobe.alpha = fmax((double)bsdf_base_alphas(bsdf.flags).x, (double)bsdf_base_alphas(bsdf.flags).y);
    lobe.grid[0] = grid_make(vec3(-wo.x, -wo.y, wo.z), lobe.alpha);
    lobe.grid[1] = grid_make(vec3_normalize(refracted), lobe.alpha);
    lobe.side[0] = wo.z > 0.0f ? 1.0 : -1.0;
    lobe.side[1] = -lobe.side[0];
    return lobe;
}

/* The last cell counts deltas and failed samples. Returns the p-value; *integral is the density's. */
static double lobe_p_value(const LobeCase *lobe, uint64_t seed, double *integral, double *succeeded)
{
    static double observed[2 * CELLS * CELLS + 1], expected[2 * CELLS * CELLS + 1];
    memset(observed, 0, sizeof observed);
    TestRandom random = {seed};
    for (int n = 0; n < SAMPLES; ++n) {
        BsdfSample sample;
        float u_lobe = random_float24(&random);
        int cell = 2 * CELLS * CELLS;
        if (bsdf_sample(&lobe->scene->view, &lobe->bsdf, lobe->wo, u_lobe, random_vec2(&random), TRANSPORT_RADIANCE,
                        &sample) &&
            !sample.delta)
            cell = (int)sample.transmitted * CELLS * CELLS + grid_cell(&lobe->grid[sample.transmitted], sample.wi);
        observed[cell] += 1.0;
    }
    *integral = 0.0;
    for (int s = 0; s < 2; ++s)
        for (int c = 0; c < CELLS * CELLS; ++c) {
            double part =
                lobe_integrate(lobe, s, (double)(c / CELLS) / CELLS, (double)(c % CELLS) / CELLS, 1.0 / CELLS, 7);
            expected[s * CELLS * CELLS + c] = part * SAMPLES;
            *integral += part;
        }
    expected[2 * CELLS * CELLS] = fmax(0.0, 1.0 - *integral) * SAMPLES;
    *succeeded = 1.0 - observed[2 * CELLS * CELLS] / SAMPLES;
    return test_chi_square(observed, expected, 2 * CELLS * CELLS + 1);
}

#define TOTAL_CASES ((3 + 4 * (TEST_ALPHA_COUNT - 1)) * TEST_WO_COUNT)

/* A kind of BSDF_LIST with a lobe that is no delta is among the cases of these tests. */
START_TEST(test_every_kind_has_a_case)
{
    for (uint kind = 0; kind < MATERIAL_MIX; ++kind) {
        bool found = (bsdf_traits(kind) & (TRAIT_COSINE | TRAIT_MICROFACET)) == 0u;
        for (int i = 0; i < TEST_MATERIAL_COUNT; ++i)
            found |= TEST_MATERIALS[i].kind == kind;
        ck_assert_msg(found, "support/bsdf_cases.h has no case of material %u", kind);
    }
}
END_TEST

/* Samples follow pdf_w for every BSDF, roughness and direction: p > 1e-3 for all cases together (Sidak). The density
 * integrates to the fraction of samples that succeed, within 5 standard deviations plus the quadrature error. */
START_TEST(test_samples_follow_density)
{
    TestScene scene;
    test_scene_init(&scene);
    int cases = 0;
    double least = 1.0;
    const struct TestMaterial *kind = &TEST_MATERIALS[_i];
    for (int a = kind->alphas > 1; a < kind->alphas; ++a) {
        Bsdf bsdf =
            test_bsdf(&scene, kind->kind, TEST_ALPHAS[a].x, TEST_ALPHAS[a].y, kind->eta, kind->color0, kind->color1);
        for (int d = 0; d < TEST_WO_COUNT; ++d, ++cases) {
            LobeCase lobe = lobe_make(&scene, bsdf, test_wo(d));
            double integral, succeeded;
            double p = lobe_p_value(&lobe, (uint64_t)(1000 * _i + 10 * a + d), &integral, &succeeded);
            double deviation = sqrt(succeeded * (1.0 - succeeded) / SAMPLES);
            least = fmin(least, p);
            REQUIRE_MSG(p > 1.0 - pow(1.0 - 1e-3, 1.0 / TOTAL_CASES), "%s, alpha %g %g, direction %d: p = %g",
                        kind->name, (double)bsdf.alpha_x, (double)bsdf.alpha_y, d, p);
            REQUIRE_MSG(fabs(integral - succeeded) < 5.0 * deviation + 1e-3 && integral < 1.0 + 1e-3,
                        "%s, alpha %g %g, direction %d: the density integrates to %g, %g of the samples succeed",
                        kind->name, (double)bsdf.alpha_x, (double)bsdf.alpha_y, d, integral, succeeded);
        }
    }
    printf("# %s: %d chi-square tests, least p = %.3g\n", kind->name, cases, least);
    test_scene_destroy(&scene);
}
END_TEST

/* Delta lobes are sampled with the probability that pdf_w states. */
START_TEST(test_delta_lobes_follow_probability)
{
    static const uint DELTA_KINDS[] = {MATERIAL_CONDUCTOR, MATERIAL_DIELECTRIC, MATERIAL_THIN_DIELECTRIC,
                                       MATERIAL_COATED_DIFFUSE};
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {77};
    for (int k = 0; k < 4; ++k)
        for (int d = 0; d < TEST_WO_COUNT; ++d) {
            Bsdf bsdf = test_bsdf(&scene, DELTA_KINDS[k], 1e-4f, 1e-4f, 1.5f, 0.5f, 2.0f);
            double count[2] = {0.0, 0.0}, probability[2] = {0.0, 0.0};
            for (int n = 0; n < SAMPLES; ++n) {
                BsdfSample sample;
                float u_lobe = random_float24(&random);
                if (bsdf_sample(&scene.view, &bsdf, test_wo(d), u_lobe, random_vec2(&random), TRANSPORT_RADIANCE,
                                &sample) &&
                    sample.delta) {
                    count[sample.transmitted] += 1.0;
                    probability[sample.transmitted] = (double)sample.pdf_w;
                    REQUIRE(sample.pdf_rev_w == sample.pdf_w);
                    BsdfValue value = bsdf_eval(&scene.view, &bsdf, test_wo(d), sample.wi, TRANSPORT_RADIANCE);
                    REQUIRE(DELTA_KINDS[k] == MATERIAL_COATED_DIFFUSE || value.pdf_w == 0.0f);
                }
            }
            for (int s = 0; s < 2; ++s) {
                double deviation = sqrt(probability[s] * (1.0 - fmin(probability[s], 1.0)) / SAMPLES);
                REQUIRE(fabs(count[s] / SAMPLES - probability[s]) < 5.0 * deviation + 1e-6);
            }
        }
    test_scene_destroy(&scene);
}
END_TEST

TCase *bsdf_sampling_tests(void)
{
    TCase *tcase = tcase_create("sampling");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_every_kind_has_a_case);
    tcase_add_loop_test(tcase, test_samples_follow_density, 0, TEST_MATERIAL_COUNT);
    tcase_add_test(tcase, test_delta_lobes_follow_probability);
    return tcase;
}
