/* Emitted power against closed forms, and irradiance of a receiver by light tracing against light_sample; both with
 * rays that are aimed, too. */
#include "light/aim.h"
#include "light/test_emit.h"
#include "support/light_fixture.h"

#define CONE_TOTAL 0.5f
#define CONE_FALLOFF 0.8f

enum {
    SQUARE,
    TRIANGLE,
    PATCH,
    SPHERE,
    PART,
    DISK,
    CYLINDER,
    POINT,
    SPOT,
    GONIOMETRIC,
    PROJECTION,
    DISTANT,
    CONSTANT,
    IMAGE,
    LIGHT_CASES
};

/* A goniometric light, or a white projection downwards; returns the power. */
static double add_intensity(LightFixture *f, bool projection)
{
    static const double down[9] = {1, 0, 0, 0, -1, 0, 0, 0, -1}, extent[2] = {0.9, 0.7};
    float texels[3 * 16];
    double mean = 0.0;
    for (uint i = 0; i < 16; ++i) {
        texels[3 * i] = texels[3 * i + 1] = texels[3 * i + 2] = projection ? 1.0f : fixture_random(3, i).x;
        mean += (double)texels[3 * i] / 16.0;
    }
    fixture_add_environment(f, texels, 4, 4, 0, down);
    fixture_to_intensity(f, projection ? LIGHT_PROJECTION : LIGHT_GONIOMETRIC, vec3(0.0f, 0.0f, 0.0f), extent);
    return projection ? 4.0 * atan(0.63 / sqrt(1.0 + 0.81 + 0.49)) : 4.0 * M_PI * mean;
}

/* One light that illuminates the receiver from above. Returns its power; 0 if that has no closed form. */
static double setup(LightFixture *f, int which)
{
    static const float square[12] = {-1, -1, 0, -1, 1, 0, 1, -1, 0, 1, 1, 0};
    static const float bent[12] = {-1, -1, 0, -1, 2, 0.5f, 1, -1, 0.5f, 1, 1, -0.5f};
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const double turned[16] = {0.6, 0, 0.8, 0, 0, 1.5, 0, 0, -0.8, 0, 0.6, 0, 0, 0, 0, 1};
    const Quadric part = {.radius = 1, .z_min = -0.5f, .z_max = 1, .phi_max = 5};
    const Quadric disk = {.radius = 2, .inner_radius = 1, .phi_max = 6.28318531f};
    const Quadric tube = {.radius = 0.4f, .z_min = -0.2f, .z_max = 0.4f, .phi_max = 6.28318531f};
    static const double uniform[16] = {0, 2, 0, 0, 1.2, 0, -1.6, 0, 1.6, 0, 1.2, 0, 0, 0, 0, 1};
    float texels[3 * 128];
    const double scene = 4.0 * M_PI; /* area of the bounding sphere's disc */
    double power = 0.0, mean = 0.0;
    fixture_init(f);
    f->scene.frame.scene.world_radius = 2.0f;
    f->scene.frame.scene.world_center = vec3(0.0f, 0.0f, -2.0f);
    switch (which) {
    case SQUARE:
        fixture_add_polygon(f, square, 4, NULL, 0, 0);
        power = 4.0 * M_PI;
        break;
    case PATCH:
        fixture_add_polygon(f, bent, 4, NULL, 0, LIGHT_TWO_SIDED);
        break;
    case TRIANGLE:
        fixture_add_polygon(f, square, 3, NULL, 0, LIGHT_TWO_SIDED);
        power = 4.0 * M_PI;
        break;
    case SPHERE:
        fixture_add_sphere(f, 0.7f, 0.1, 0.2, 0.3, 1.0f, 0);
        power = 4.0 * M_PI * M_PI * 0.49;
        break;
    case PART:
        fixture_add_quadric(f, PRIMITIVE_SPHERE, part, turned, 1.0f, 0, LIGHT_TWO_SIDED);
        break;
    case DISK:
        fixture_add_quadric(f, PRIMITIVE_DISK, disk, turned, 1.0f, SHAPE_FLIP_NORMAL, 0);
        power = M_PI * M_PI * 3.0 * 1.5;
        break;
    case CYLINDER:
        fixture_add_quadric(f, PRIMITIVE_CYLINDER, tube, uniform, 1.0f, 0, 0);
        power = M_PI * 4.0 * (2.0 * M_PI * 0.4 * 0.6);
        break;
    case POINT:
        fixture_add_light(f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}});
        power = 4.0 * M_PI;
        break;
    case SPOT:
        fixture_add_light(f, (LightData){.kind = LIGHT_SPOT,
                                         .emission = {1, 1, 1},
                                         .detail.direction = {0.36f, 0.48f, -0.8f},
                                         .detail.cos_total = CONE_TOTAL,
                                         .detail.cos_falloff = CONE_FALLOFF});
        power = 2.0 * M_PI * (1.0 - 0.5 * (0.5 + 0.8));
        break;
    case GONIOMETRIC:
    case PROJECTION:
        power = add_intensity(f, which == PROJECTION);
        break;
    case DISTANT:
        fixture_add_light(
            f, (LightData){.kind = LIGHT_DISTANT, .emission = {1, 1, 1}, .detail.direction = {0.36f, 0.48f, -0.8f}});
        power = scene;
        break;
    case CONSTANT:
        fixture_add_light(f, (LightData){.kind = LIGHT_INFINITE, .emission = {1, 1, 1}});
        power = 4.0 * M_PI * scene;
        break;
    default:
        for (uint i = 0; i < 64; ++i) {
            texels[3 * i] = texels[3 * i + 1] = texels[3 * i + 2] = fixture_random(3, i).x;
            mean += (double)texels[3 * i] / 64.0;
        }
        fixture_add_environment(f, texels, 8, 8, 0, identity);
        power = mean * 4.0 * M_PI * scene;
    }
    fixture_finish(f);
    return power;
}

typedef struct Estimate {
    double mean, error;
} Estimate;

static Estimate estimate(double sum, double squares, double count)
{
    double mean = sum / count;
    return (Estimate){mean, sqrt(fmax(0.0, squares / count - mean * mean) / count)};
}

/* Openings above the receiver, one of which light comes through from both sides, and one beside it. */
static void add_openings(LightFixture *f, int which)
{
    const float side = which == DISTANT ? 0.0f : 1.0f;
    f->scene.frame.openings = (OpeningParams){.count = 3,
                                              .frame = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                              .each = {{0, 2, -1.5f, -0.4f, -1.2f, 1.3f, 0.2f, side, 0.3f},
                                                       {0, 2, -0.9f, -1.5f, -1.5f, 1.5f, 1.5f, 0.0f, 0.15f},
                                                       {0, 0, 0.7f, -0.9f, -2.5f, 0.6f, -0.5f, side, 0.1f}}};
}

/* Cases from 2 LIGHT_CASES on, which are for light from infinity: with openings, and from 3 on with aims, too. Cases
 * from LIGHT_CASES on: with aims, one in part of the receiver, one wide above it; for lights that are in the
 * scene also one around them, and one behind. */
static double setup_aimed(LightFixture *f, int which)
{
    static const Aim AIMS[] = {{{0.5f, 0.3f, -2.0f}, 0.3f},
                               {{-0.3f, 0.2f, -1.5f}, 0.9f},
                               {{0.1f, 0.0f, 0.1f}, 1.0f},
                               {{0.3f, -0.5f, 1.5f}, 0.2f}};
    double power = setup(f, which % LIGHT_CASES);
    if (which >= 2 * LIGHT_CASES)
        add_openings(f, which % LIGHT_CASES);
    if (which / LIGHT_CASES % 2 == 0)
        return power;
    Error error = {0};
    const uint count = which % LIGHT_CASES >= DISTANT ? 2 : 4;
    memcpy(array_grow(&f->scene.aims, count, &error), AIMS, count * sizeof *AIMS);
    f->view.aims = f->scene.aims.data;
    f->scene.frame.scene.aim_count = count;
    return power;
}

/* The area of a patch or a partial sphere comes from the scene's own quadrature. */
START_TEST(test_power)
{
    enum { SAMPLES = 100000 };
    LightFixture f;
    double sum = 0.0, squares = 0.0, expected = setup_aimed(&f, _i);
    if (!(expected > 0.0))
        expected = 2.0 * M_PI * scene_primitive_area(&f.scene, 0);
    ck_assert_double_eq_tol(f.scene.light_power / expected, 1.0, 2e-3);
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e;
        if (!light_emit_aimed(&f.view, 0, fixture_random(14, i).x, fixture_random(2, i), fixture_random(9, i), &e))
            continue;
        double value = (double)e.radiance.x * (double)e.cosine / ((double)e.pdf_p * (double)e.pdf_w);
        sum += value;
        squares += value * value;
    }
    Estimate got = estimate(sum, squares, SAMPLES);
    ck_assert_msg(fabs(got.mean - expected) <= 4.0 * got.error + 2e-5 * expected, "light %d: power %g, not %g +- %g",
                  _i, got.mean, expected, got.error);
    ck_assert_msg(got.error < 0.01 * expected, "light %d: noise %g of %g", _i, got.error, expected);
    fixture_destroy(&f);
}
END_TEST

/* A round receiver below the lights. */
static const Vec3 RECEIVER = {0.2f, -0.3f, -2.0f};
static const Vec3 RECEIVER_N = {0.0f, 0.28f, 0.96f};
#define RECEIVER_RADIUS 1.2

/* Mean irradiance over the receiver, from the rays leaving the light that hit its front. */
static Estimate irradiance_by_shooting(const LightFixture *f, uint samples)
{
    double sum = 0.0, squares = 0.0, area = M_PI * RECEIVER_RADIUS * RECEIVER_RADIUS;
    for (uint i = 0; i < samples; ++i) {
        LightEmission e;
        if (!light_emit_aimed(&f->view, 0, fixture_random(14, i).x, fixture_random(2, i), fixture_random(9, i), &e))
            continue;
        double cosine = (double)vec3_dot(e.w, RECEIVER_N);
        double t = (double)vec3_dot(vec3_sub(RECEIVER, e.p), RECEIVER_N) / cosine;
        Vec3 hit = vec3_mad(e.p, (float)t, e.w);
        if (!(cosine < 0.0) || !(t > 0.0) || (double)vec3_length(vec3_sub(hit, RECEIVER)) > RECEIVER_RADIUS)
            continue;
        double value = (double)e.radiance.x * (double)e.cosine / ((double)e.pdf_p * (double)e.pdf_w) / area;
        sum += value;
        squares += value * value;
    }
    return estimate(sum, squares, samples);
}

/* The same by sampling the light from points on the receiver. */
static Estimate irradiance_by_sampling(const LightFixture *f, uint samples)
{
    double sum = 0.0, squares = 0.0;
    Frame frame = frame_from_normal(RECEIVER_N);
    for (uint i = 0; i < samples; ++i) {
        LightSample s;
        Vec2 d = warp_disk_concentric(fixture_random(11, i));
        Vec3 at = vec3_scale(vec3(d.x, d.y, 0.0f), (float)RECEIVER_RADIUS);
        Vec3 ref = vec3_add(RECEIVER, frame_to_world(frame, at));
        if (!light_sample(&f->view, 0, ref, fixture_random(12, i), &s))
            continue;
        double value = (double)s.radiance.x * fmax(0.0, (double)vec3_dot(s.wi, RECEIVER_N)) / (double)s.pdf_w;
        sum += value;
        squares += value * value;
    }
    return estimate(sum, squares, samples);
}

START_TEST(test_irradiance)
{
    LightFixture f;
    setup_aimed(&f, _i);
    Estimate shot = irradiance_by_shooting(&f, 300000), sampled = irradiance_by_sampling(&f, 100000);
    double error = hypot(shot.error, sampled.error);
    ck_assert_msg(fabs(shot.mean - sampled.mean) <= 4.0 * error, "light %d: %g by shooting, %g by sampling, +- %g", _i,
                  shot.mean, sampled.mean, error);
    ck_assert_msg(error < 0.01 * sampled.mean, "light %d: noise %g of %g", _i, error, sampled.mean);
    fixture_destroy(&f);
}
END_TEST

TCase *emit_power_case(void)
{
    TCase *tcase = tcase_create("power");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_power, 0, 2 * LIGHT_CASES);
    tcase_add_loop_test(tcase, test_irradiance, 0, 2 * LIGHT_CASES);
    for (int with = 2 * LIGHT_CASES; with <= 3 * LIGHT_CASES; with += LIGHT_CASES) {
        tcase_add_loop_test(tcase, test_power, with + DISTANT, with + LIGHT_CASES);
        tcase_add_loop_test(tcase, test_irradiance, with + DISTANT, with + LIGHT_CASES);
    }
    return tcase;
}
