/* Infinite lights: constant and images, in both parametrisations. */
#include "light/test_light.h"
#include "support/light_fixture.h"

/* A proper rotation, not about an axis of the image. */
static const double ROTATION[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6};

enum { CELLS = 12, SUB = 24, SAMPLES = 60000 };

/* Four chi-square tests. */
#define P_MIN (1e-3 / 4.0)

/* The world direction with cos(theta) = 1 - 2 a, phi = 2 pi b. */
static Vec3 direction(double a, double b)
{
    double z = 1.0 - 2.0 * a, r = sqrt(1.0 - z * z);
    return vec3((float)(r * cos(2.0 * M_PI * b)), (float)(r * sin(2.0 * M_PI * b)), (float)z);
}

/* Directions in equal-area cells of the world against environment_pdf_w. `smooth`: accuracy of the midpoint rule for
 * the density, which is discontinuous. */
static void check_density(const char *name, const LightFixture *f, double smooth)
{
    double expected[CELLS * CELLS] = {0.0}, observed[CELLS * CELLS] = {0.0}, total = 0.0;
    const int n = CELLS * SUB;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            Vec3 d = direction((y + 0.5) / n, (x + 0.5) / n);
            double share = (double)environment_pdf_w(&f->view, 0, d) * 4.0 * M_PI / ((double)n * n);
            expected[y / SUB * CELLS + x / SUB] += share;
            total += share;
        }
    ck_assert_msg(fabs(total - 1.0) < smooth, "%s: the density integrates to %g", name, total);
    for (uint i = 0; i < SAMPLES; ++i) {
        LightSample s;
        if (!light_sample(&f->view, 0, vec3(0, 0, 0), fixture_random(9, i), &s))
            continue;
        double phi = atan2((double)s.wi.y, (double)s.wi.x) / (2.0 * M_PI);
        int y = (int)fmin(0.5 * (1.0 - (double)s.wi.z) * CELLS, CELLS - 1);
        int x = (int)fmin((phi < 0.0 ? phi + 1.0 : phi) * CELLS, CELLS - 1);
        observed[y * CELLS + x] += 1.0;
    }
    for (int i = 0; i < CELLS * CELLS; ++i)
        expected[i] *= SAMPLES / total;
    double p = test_chi_square(observed, expected, CELLS * CELLS);
    ck_assert_msg(p > P_MIN, "%s: chi-square p = %g", name, p);
}

/* Every sample's density and radiance equal those evaluated for its direction, except for directions that rounding
 * moves across a cell's border. */
static void check_samples(const char *name, const LightFixture *f)
{
    int pdf_differs = 0, radiance_differs = 0, count = 20000;
    for (uint i = 0; i < (uint)count; ++i) {
        LightSample s;
        if (!light_sample(&f->view, 0, vec3(0, 0, 0), fixture_random(4, i), &s))
            continue;
        ck_assert(s.infinite == 1u && s.delta == 0u);
        double pdf = (double)light_pdf_w(&f->view, 0, vec3(0, 0, 0), s.wi, NULL) / (double)s.pdf_w;
        double radiance = (double)environment_radiance(&f->view, vec3_splat(0.0f), s.wi).y / (double)s.radiance.y;
        pdf_differs += fabs(pdf - 1.0) > 1e-4;
        radiance_differs += fabs(radiance - 1.0) > 1e-3;
    }
    ck_assert_msg(pdf_differs < count / 1000, "%s: %d densities differ", name, pdf_differs);
    ck_assert_msg(radiance_differs < count / 1000, "%s: %d radiances differ", name, radiance_differs);
}

/* Irradiance by quadrature that is independent of the light's distribution. */
static double irradiance_by_quadrature(const LightFixture *f, Vec3 n)
{
    double sum = 0.0;
    const int count = 700;
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) {
            Vec3 d = direction((y + 0.5) / count, (x + 0.5) / count);
            double cosine = (double)vec3_dot(d, n);
            sum += cosine > 0.0 ? cosine * (double)environment_radiance(&f->view, vec3_splat(0.0f), d).x : 0.0;
        }
    return sum * 4.0 * M_PI / ((double)count * count);
}

static void fill_random(float *texels, uint count, uint stream)
{
    for (uint i = 0; i < count; ++i) {
        Vec2 r = fixture_random(stream, i);
        texels[3 * i] = texels[3 * i + 1] = texels[3 * i + 2] = r.x < 0.3f ? 0.0f : r.y * r.y;
    }
}

START_TEST(test_constant)
{
    LightFixture f;
    fixture_init(&f);
    fixture_add_light(&f, (LightData){.kind = LIGHT_INFINITE, .emission = {2, 2, 2}});
    fixture_finish(&f);
    ASSERT_IRRADIANCE(&f, 0, vec3(1, 2, 3), vec3(0.6f, 0, 0.8f), 2.0 * M_PI);
    check_density("constant", &f, 1e-5);
    check_samples("constant", &f);
    fixture_destroy(&f);
}
END_TEST

START_TEST(test_images)
{
    for (uint equirectangular = 0; equirectangular < 2; ++equirectangular) {
        enum { WIDTH = 16, HEIGHT = 16 };
        float texels[3 * WIDTH * HEIGHT];
        const char *name = equirectangular ? "latitude-longitude image" : "octahedral image";
        LightFixture f;
        fixture_init(&f);
        fill_random(texels, WIDTH * HEIGHT, 21);
        fixture_add_environment(&f, texels, equirectangular ? 16 : 8, 8, equirectangular ? LIGHT_EQUIRECTANGULAR : 0,
                                ROTATION);
        fixture_finish(&f);
        check_density(name, &f, 3e-3);
        check_samples(name, &f);
        Vec3 n = vec3(0.0f, -0.6f, 0.8f);
        ASSERT_IRRADIANCE(&f, 0, vec3(1, 2, 3), n, irradiance_by_quadrature(&f, n));
        fixture_destroy(&f);
    }
}
END_TEST

/* A single bright texel at an edge of the image: interpolation spreads its light into its neighbours, across the seam,
 * too, and all of it has a density. */
START_TEST(test_hot_texel)
{
    for (uint equirectangular = 0; equirectangular < 2; ++equirectangular) {
        enum { WIDTH = 16, HEIGHT = 8 };
        float texels[3 * WIDTH * WIDTH] = {0.0f};
        uint height = equirectangular ? HEIGHT : WIDTH;
        size_t hot = 3 * (equirectangular ? (size_t)WIDTH * 5 : (size_t)WIDTH * 5 + WIDTH - 1);
        texels[hot] = texels[hot + 1] = texels[hot + 2] = 1e5f;
        LightFixture f;
        fixture_init(&f);
        fixture_add_environment(&f, texels, WIDTH, height, equirectangular ? LIGHT_EQUIRECTANGULAR : 0, ROTATION);
        fixture_finish(&f);
        check_samples("hot texel", &f);
        int lit = 0, n = 400;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                Vec3 d = direction((y + 0.5) / n, (x + 0.5) / n);
                if (!(environment_radiance(&f.view, vec3_splat(0.0f), d).x > 1.0f))
                    continue;
                ++lit;
                ck_assert_msg((environment_pdf_w(&f.view, 0, d) > 0.0f), "light without density");
            }
        ck_assert_int_gt(lit, 100);
        for (int axis = 0; axis < 6; ++axis) {
            float sign = axis % 2 ? -1.0f : 1.0f;
            Vec3 normal = vec3(axis / 2 == 0 ? sign : 0, axis / 2 == 1 ? sign : 0, axis / 2 == 2 ? sign : 0);
            double expected = irradiance_by_quadrature(&f, normal);
            if (expected > 1000.0) /* not at a grazing angle */
                ASSERT_IRRADIANCE(&f, 0, vec3(0, 0, 0), normal, expected);
        }
        fixture_destroy(&f);
    }
}
END_TEST

/* Texel positions of pbrt's octahedral map and of the latitude-longitude map: the direction of a texel's centre sees
 * that texel. */
START_TEST(test_orientation)
{
    static const double IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const struct {
        uint flags;
        uint x, y; /* texel of 8 x 4 or 8 x 8 */
        float d[3]; /* not normalised */
    } cases[] = {{LIGHT_EQUIRECTANGULAR, 0, 1, {0.853553f, 0.353553f, 0.382683f}},
                 {LIGHT_EQUIRECTANGULAR, 2, 0, {-0.146447f, 0.353553f, 0.923880f}},
                 {LIGHT_EQUIRECTANGULAR, 5, 3, {-0.146447f, -0.353553f, -0.923880f}},
                 /* +z in the middle of the square, +x on the right, +y at the bottom; -z in the corners. */
                 {0, 3, 3, {-0.05f, -0.05f, 1.0f}},
                 {0, 7, 4, {1.0f, 0.1f, 0.0f}},
                 {0, 4, 7, {0.1f, 1.0f, 0.0f}},
                 {0, 0, 0, {-0.05f, -0.05f, -1.0f}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        float texels[3 * 64] = {0.0f};
        LightFixture f;
        fixture_init(&f);
        texels[3 * (cases[i].y * 8 + cases[i].x)] = 1.0f;
        fixture_add_environment(&f, texels, 8, cases[i].flags ? 4 : 8, cases[i].flags, IDENTITY);
        ARRAY_AT(&f.scene.images, TextureImage, 0).filter = FILTER_POINT;
        fixture_finish(&f);
        Vec3 d = vec3_normalize(vec3(cases[i].d[0], cases[i].d[1], cases[i].d[2]));
        ck_assert_msg((environment_radiance(&f.view, vec3_splat(0.0f), d).x == 1.0f), "case %zu", i);
        fixture_destroy(&f);
    }
}
END_TEST

/* The top row of a latitude-longitude image does not wrap around to the bottom, though the image repeats. */
START_TEST(test_poles)
{
    static const double IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    float texels[3 * 32] = {0.0f};
    for (int i = 0; i < 24; ++i)
        texels[i] = 1.0f;
    LightFixture f;
    fixture_init(&f);
    fixture_add_environment(&f, texels, 8, 4, LIGHT_EQUIRECTANGULAR, IDENTITY);
    fixture_finish(&f);
    Vec3 down = vec3_normalize(vec3(0.1f, 0.0f, -1.0f)), up = vec3_negate(down);
    ck_assert((environment_radiance(&f.view, vec3_splat(0.0f), down).x == 0.0f) &&
              (environment_pdf_w(&f.view, 0, down) == 0.0f));
    ck_assert((environment_radiance(&f.view, vec3_splat(0.0f), up).x == 1.0f) &&
              (environment_pdf_w(&f.view, 0, up) > 0.0f));
    fixture_destroy(&f);
}
END_TEST

/* Several environments add up; a black one is not listed. */
START_TEST(test_sum)
{
    LightFixture f;
    fixture_init(&f);
    fixture_add_light(&f, (LightData){.kind = LIGHT_INFINITE, .emission = {1, 2, 3}});
    fixture_add_light(&f, (LightData){.kind = LIGHT_INFINITE, .emission = {0, 0, 0}});
    fixture_add_light(&f, (LightData){.kind = LIGHT_INFINITE, .emission = {4, 5, 6}});
    fixture_finish(&f);
    Vec3 sum = environment_radiance(&f.view, vec3_splat(0.0f), vec3(0, 0, 1));
    ck_assert(sum.x == 5.0f && sum.y == 7.0f && sum.z == 9.0f);
    ck_assert_uint_eq(f.scene.infinite_lights.count, 2);
    fixture_destroy(&f);
}
END_TEST

TCase *light_environment_case(void)
{
    TCase *tcase = tcase_create("environment");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_constant);
    tcase_add_test(tcase, test_images);
    tcase_add_test(tcase, test_hot_texel);
    tcase_add_test(tcase, test_orientation);
    tcase_add_test(tcase, test_poles);
    tcase_add_test(tcase, test_sum);
    return tcase;
}
