/* Infinite lights in small and large scenes, near and far from the origin: a distant light, and a sun that is one texel
 * of an environment. Rounding must not leave any part of the scene unlit. */
#include "light/emit.h"
#include "light/test_emit.h"
#include "support/light_fixture.h"

typedef struct DistanceCase {
    double radius; /* of the scene */
    double shift; /* of its centre along every axis */
} DistanceCase;

static const DistanceCase CASES[] = {{10.0, 0.0}, {1e3, 0.0}, {1e5, 0.0}, {10.0, 1e5}, {1e3, -1e6}, {1e5, 1e5}};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

/* A cube with bounds as by scene_finish; *low and *high are its corners. */
static void setup(LightFixture *f, const DistanceCase *c, bool sun, float low[3], float high[3])
{
    static const double rotation[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6};
    fixture_init(f);
    double square = 0.0, center[3];
    for (int k = 0; k < 3; ++k) {
        low[k] = (float)(c->shift * (k + 1) - c->radius / sqrt(3.0));
        high[k] = (float)(c->shift * (k + 1) + c->radius / sqrt(3.0));
        center[k] = 0.5 * ((double)low[k] + (double)high[k]);
        square += 0.25 * ((double)high[k] - (double)low[k]) * ((double)high[k] - (double)low[k]);
    }
    f->scene.frame.scene.world_center = vec3((float)center[0], (float)center[1], (float)center[2]);
    f->scene.frame.scene.world_radius = (float)(sqrt(square) * 1.0001);
    if (sun) {
        enum { WIDTH = 512, HEIGHT = 256 };
        float *texels = malloc(sizeof *texels * 3 * WIDTH * HEIGHT);
        for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i)
            texels[i] = 1e-3f;
        for (int k = 0; k < 3; ++k)
            texels[3 * (WIDTH * 70 + 130) + k] = 1e5f;
        fixture_add_environment(f, texels, WIDTH, HEIGHT, LIGHT_EQUIRECTANGULAR, rotation);
        free(texels);
    } else {
        fixture_add_light(
            f, (LightData){.kind = LIGHT_DISTANT, .emission = {1, 1, 1}, .detail.direction = {0.36f, 0.48f, -0.8f}});
    }
    fixture_finish(f);
}

/* Corner `i` of the box relative to p, in double. */
static void corner_from(int i, const float low[3], const float high[3], Vec3 p, double d[3])
{
    const float at[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; ++k)
        d[k] = (double)((i >> k) & 1 ? high[k] : low[k]) - (double)at[k];
}

static double dot(const double a[3], Vec3 w)
{
    return a[0] * (double)w.x + a[1] * (double)w.y + a[2] * (double)w.z;
}

/* Rays start outside the scene, behind every corner, even if the disc's rim rounds inward; and the computed rim lies
 * outside of everything that the scene covers. */
START_TEST(test_covers)
{
    for (int sun = 0; sun < 2; ++sun) {
        float low[3], high[3];
        LightFixture f;
        setup(&f, &CASES[_i], sun != 0, low, high);
        for (uint i = 0; i < 4000; ++i) {
            LightEmission e;
            Vec2 u = fixture_random(2, i);
            if (i % 2u == 0u) /* on the rim, and 2 / 2^24 inside it */
                u = i % 4u == 0u ? vec2(5.9604645e-8f, u.y) : vec2(u.x, 1.0f - 5.9604645e-8f);
            TEST_TRUE(light_emit(&f.view, 0, u, fixture_random(9, i), &e));
            double center[3] = {0.0}, scene_radius = 0.0;
            for (int k = 0; k < 8; ++k) {
                double d[3];
                corner_from(k, low, high, e.p, d);
                TEST_TRUE(dot(d, e.w) > 0.0);
                for (int j = 0; j < 3; ++j)
                    center[j] += d[j] / 8.0;
            }
            for (int j = 0; j < 3; ++j)
                scene_radius += 0.25 * ((double)high[j] - (double)low[j]) * ((double)high[j] - (double)low[j]);
            double along = dot(center, e.w), across2 = -along * along;
            for (int j = 0; j < 3; ++j)
                across2 += center[j] * center[j];
            if (i % 2u == 0u)
                TEST_TRUE(across2 > scene_radius * (1.0 + 1e-7));
        }
        fixture_destroy(&f);
    }
}
END_TEST

/* Receivers perpendicular to the light, a twentieth of the scene wide: in the middle of the scene, inside it and at its
 * rim. Centres in units of the scene's radius, in the frame around the direction to the light. */
static const double RECEIVERS[][2] = {{0.0, 0.0}, {0.94, 0.0}, {-0.5, 0.5}, {0.0, 0.94}};
enum { RECEIVER_COUNT = sizeof RECEIVERS / sizeof *RECEIVERS };
#define RECEIVER_RADIUS 0.05

/* Where the ray intersects the receivers' plane, which contains the scene's centre. Returns false if from behind. */
static bool receivers_meet(const LightFixture *f, const LightEmission *e, const Frame *frame, double at[2])
{
    const Vec3 axes[3] = {frame->t, frame->b, frame->n}, p = vec3_sub(e->p, f->scene.frame.scene.world_center);
    const double from[3] = {(double)p.x, (double)p.y, (double)p.z};
    const double along[3] = {(double)e->w.x, (double)e->w.y, (double)e->w.z};
    double o[3], d[3];
    for (int k = 0; k < 3; ++k) {
        o[k] = dot(from, axes[k]);
        d[k] = dot(along, axes[k]);
    }
    at[0] = o[0] - o[2] / d[2] * d[0];
    at[1] = o[1] - o[2] / d[2] * d[1];
    return d[2] < 0.0;
}

/* The irradiance of every receiver, in units of `expected`, from rays that leave the light. */
static void receivers_check(const DistanceCase *c, const LightFixture *f, const Frame *frame, double expected)
{
    enum { SAMPLES = 400000 };
    double sums[RECEIVER_COUNT] = {0.0}, squares[RECEIVER_COUNT] = {0.0}, r = RECEIVER_RADIUS * c->radius, at[2];
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e;
        if (!light_emit(&f->view, 0, fixture_random(2, i), fixture_random(9, i), &e) ||
            !receivers_meet(f, &e, frame, at))
            continue;
        double value = (double)e.radiance.x / ((double)e.pdf_p * (double)e.pdf_w) / (M_PI * r * r) / expected;
        for (int k = 0; k < RECEIVER_COUNT; ++k)
            if (hypot(at[0] - c->radius * RECEIVERS[k][0], at[1] - c->radius * RECEIVERS[k][1]) < r) {
                sums[k] += value;
                squares[k] += value * value;
            }
    }
    for (int k = 0; k < RECEIVER_COUNT; ++k) {
        double mean = sums[k] / SAMPLES, error = sqrt((squares[k] / SAMPLES - mean * mean) / SAMPLES);
        ck_assert_msg(fabs(mean - 1.0) <= 4.5 * error && error < 0.05,
                      "radius %g, shift %g, receiver %d: %g of what light_sample finds, +- %g", c->radius, c->shift, k,
                      mean, error);
    }
}

START_TEST(test_irradiance)
{
    for (int sun = 0; sun < 2; ++sun) {
        float low[3], high[3];
        LightFixture f;
        LightSample s;
        double expected = 0.0;
        setup(&f, &CASES[_i], sun != 0, low, high);
        TEST_TRUE(light_sample(&f.view, 0, vec3(0, 0, 0), vec2(0.5f, 0.5f), &s));
        Frame frame = frame_from_normal(s.wi); /* toward the sun, whose texel is 0.7 degrees wide */
        for (uint i = 0; i < 10000; ++i)
            if (light_sample(&f.view, 0, vec3(0, 0, 0), fixture_stratified(7, i, 100), &s))
                expected += (double)s.radiance.x * fmax(0.0, (double)vec3_dot(s.wi, frame.n)) / (double)s.pdf_w / 1e4;
        receivers_check(&CASES[_i], &f, &frame, expected);
        fixture_destroy(&f);
    }
}
END_TEST

/* Resolution of the points on the disc: random_float has 2^23 values along a side of the square, 2^-22 of the radius
 * apart and stretched by up to 1.27 on the disc, and coordinates as large as the radius are rounded: adjacent points
 * are at most 6e-7 of the radius apart. */
START_TEST(test_resolution)
{
    float low[3], high[3];
    LightFixture f;
    const float step = 1.1920929e-7f;
    setup(&f, &CASES[2], false, low, high);
    for (uint i = 0; i < 20000; ++i) {
        LightEmission a, b;
        Vec2 u = fixture_random(2, i);
        TEST_TRUE(light_emit(&f.view, 0, u, u, &a));
        TEST_TRUE(light_emit(&f.view, 0, i % 2u ? vec2(u.x + step, u.y) : vec2(u.x, u.y + step), u, &b));
        TEST_TRUE((double)vec3_length(vec3_sub(a.p, b.p)) <= 1e5 * 6e-7);
    }
    fixture_destroy(&f);
}
END_TEST

TCase *emit_distance_case(void)
{
    TCase *tcase = tcase_create("from far");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_covers, 0, CASE_COUNT);
    tcase_add_loop_test(tcase, test_irradiance, 0, CASE_COUNT);
    tcase_add_test(tcase, test_resolution);
    return tcase;
}
