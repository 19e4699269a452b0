/* Directions of rays leaving lights at a point and infinite lights, and the origins of the latter. */
#include "light/emit.h"
#include "light/test_emit.h"
#include "support/light_fixture.h"

enum { CELLS = 12, SUB = 24, SAMPLES = 40000 };

static const double ROTATION[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6};

enum {
    POINT,
    WIDE_SPOT,
    NARROW_SPOT,
    HARD_SPOT,
    GONIOMETRIC,
    PROJECTION,
    STRETCHED_PROJECTION,
    CONSTANT,
    LATLONG,
    OCTAHEDRAL,
    STRETCHED,
    DISTANT,
    LIGHT_CASES
};

/* Half extents of a projection at distance 1. */
static const double EXTENT[2] = {0.9, 0.5};

/* Eleven chi-square tests of directions, five of points on the disc (Sidak: 1e-3 overall). */
#define P_MIN (1e-3 / 16.0)

static LightData spot(double total, double falloff)
{
    return (LightData){.kind = LIGHT_SPOT,
                       .emission = {2, 2, 2},
                       .detail.position = {1, 2, 3},
                       .detail.direction = {0.48f, 0.64f, -0.6f},
                       .detail.cos_total = (float)cos(total),
                       .detail.cos_falloff = (float)cos(falloff)};
}

static void add_image(LightFixture *f, uint flags)
{
    float texels[3 * 128];
    for (uint i = 0; i < 128; ++i) {
        Vec2 r = fixture_random(21, i);
        texels[3 * i] = texels[3 * i + 1] = texels[3 * i + 2] = r.x < 0.3f ? 1e-3f : 1e-3f + r.y * r.y;
    }
    fixture_add_environment(f, texels, flags != 0u ? 16 : 8, 8, flags, ROTATION);
}

/* The transform from the image's directions to the world's becomes S R with S = diag(2, 1, 1/2). */
static void stretch(LightFixture *f)
{
    static const float SCALE[3] = {2.0f, 1.0f, 0.5f};
    LightDetail *light = &ARRAY_AT(&f->scene.light_details, LightDetail, 0);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            light->world_from_light.m[4 * i + j] *= SCALE[i];
            light->light_from_world.m[4 * j + i] /= SCALE[i];
        }
}

static void setup(LightFixture *f, int which)
{
    fixture_init(f);
    f->scene.frame.scene.world_radius = 3.0f;
    f->scene.frame.scene.world_center = vec3(1.0f, -2.0f, 5.0f);
    switch (which) {
    case POINT:
        fixture_add_light(f, (LightData){.kind = LIGHT_POINT, .emission = {2, 2, 2}, .detail.position = {1, 2, 3}});
        break;
    case WIDE_SPOT:
        fixture_add_light(f, spot(2.5, 0.3));
        break;
    case NARROW_SPOT:
        fixture_add_light(f, spot(0.02, 0.015));
        break;
    case HARD_SPOT:
        fixture_add_light(f, spot(0.5, 0.5));
        break;
    case CONSTANT:
        fixture_add_light(f, (LightData){.kind = LIGHT_INFINITE, .emission = {2, 2, 2}});
        break;
    case DISTANT:
        fixture_add_light(
            f, (LightData){.kind = LIGHT_DISTANT, .emission = {2, 2, 2}, .detail.direction = {0.6f, 0.0f, -0.8f}});
        break;
    default:
        add_image(f, which == LATLONG ? LIGHT_EQUIRECTANGULAR : 0u);
    }
    if (which >= GONIOMETRIC && which <= STRETCHED_PROJECTION)
        fixture_to_intensity(f, which == GONIOMETRIC ? LIGHT_GONIOMETRIC : LIGHT_PROJECTION, vec3(1.0f, 2.0f, 3.0f),
                             EXTENT);
    if (which == STRETCHED || which == STRETCHED_PROJECTION)
        stretch(f);
    fixture_finish(f);
}

/* Cells of directions by azimuth and cosine about an axis, down to the cosine `low`. */
typedef struct Cells {
    Frame frame;
    double low;
} Cells;

static Cells cells_make(const LightFixture *f, int which)
{
    Cells cells = {frame_from_normal(vec3(0.0f, 0.0f, 1.0f)), -1.0};
    const LightDetail *light = &ARRAY_AT(&f->scene.light_details, LightDetail, 0);
    uint kind = light_kind(f->view.lights);
    if (kind == LIGHT_SPOT) {
        cells.frame = frame_from_normal(light->direction);
        cells.low = which == WIDE_SPOT ? -1.0 : 2.0 * (double)light->cos_total - 1.0; /* wider than the cone */
    }
    if (kind == LIGHT_PROJECTION) { /* about its axis, a little further than the corners */
        cells = (Cells){frame_from_normal(projection_direction(light, vec2(0.5f, 0.5f))), 1.0};
        for (int i = 0; i < 4; ++i) {
            Vec3 corner = projection_direction(light, vec2((float)(i & 1), (float)(i >> 1)));
            cells.low = fmin(cells.low, (double)vec3_dot(corner, cells.frame.n) - 0.02);
        }
    }
    return cells;
}

static Vec3 cells_direction(const Cells *cells, double a, double b)
{
    double versine = (1.0 - cells->low) * a, r = sqrt(versine * (2.0 - versine));
    Vec3 w = vec3((float)(r * cos(2.0 * M_PI * b)), (float)(r * sin(2.0 * M_PI * b)), (float)(1.0 - versine));
    return frame_to_world(cells->frame, w);
}

static int cells_find(const Cells *cells, Vec3 d)
{
    Vec3 w = frame_to_local(cells->frame, d);
    double x = (double)w.x, y = (double)w.y, phi = atan2(y, x) / (2.0 * M_PI);
    double sine2 = x * x + y * y, versine = w.z > 0.0f ? sine2 / (1.0 + (double)w.z) : 1.0 - (double)w.z;
    int i = (int)fmin(versine / (1.0 - cells->low) * CELLS, CELLS - 1);
    return i * CELLS + (int)fmin((phi < 0.0 ? phi + 1.0 : phi) * CELLS, CELLS - 1);
}

/* light_emit_pdf_w integrates to 1, and directions are distributed accordingly. */
START_TEST(test_directions)
{
    double expected[CELLS * CELLS] = {0.0}, observed[CELLS * CELLS] = {0.0}, total = 0.0;
    const int n = CELLS * SUB;
    LightFixture f;
    setup(&f, _i);
    Cells cells = cells_make(&f, _i);
    double share = 2.0 * M_PI * (1.0 - cells.low) / ((double)n * n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            Vec3 d = cells_direction(&cells, (y + 0.5) / n, (x + 0.5) / n);
            double mass = (double)light_emit_pdf_w(&f.view, 0, vec3(0, 0, 0), d) * share;
            expected[y / SUB * CELLS + x / SUB] += mass;
            total += mass;
        }
    ck_assert_msg(fabs(total - 1.0) < 4e-3, "case %d: the density integrates to %g", _i, total);
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e;
        TEST_TRUE(light_emit(&f.view, 0, fixture_random(2, i), fixture_random(9, i), &e));
        observed[cells_find(&cells, e.w)] += 1.0;
    }
    for (int i = 0; i < CELLS * CELLS; ++i)
        expected[i] *= SAMPLES / total;
    double p = test_chi_square(observed, expected, CELLS * CELLS);
    ck_assert_msg(p > P_MIN, "case %d: chi-square p = %g", _i, p);
    fixture_destroy(&f);
}
END_TEST

/* The LightEmission agrees with the functions that evaluate it later, except for directions that rounding moves across
 * a texel's border. */
START_TEST(test_records)
{
    LightFixture f;
    int differs = 0, count = 5000;
    setup(&f, _i);
    uint kind = light_kind(f.view.lights);
    bool far = !light_has_position(kind);
    for (uint i = 0; i < (uint)count; ++i) {
        LightEmission e;
        if (!light_emit(&f.view, 0, fixture_random(2, i), fixture_random(9, i), &e))
            continue;
        TEST_NEAR(vec3_length(e.w), 1.0, 1e-6);
        TEST_TRUE(e.infinite == far && e.cosine == 1.0f && vec3_is_zero(e.ng));
        TEST_TRUE(e.delta_position == !far);
        TEST_TRUE(e.delta_direction == (kind == LIGHT_DISTANT));
        TEST_TRUE(light_emit_pdf_p(&f.view, 0, NULL) == e.pdf_p);
        TEST_TRUE(e.pdf_p == (far ? light_emit_pdf_disc(&f.view) : 1.0f));
        differs += fabs((double)light_emit_pdf_w(&f.view, 0, e.ng, e.w) / (double)e.pdf_w - 1.0) > 1e-4;
        if (kind >= LIGHT_INFINITE)
            differs += fabs((double)environment_radiance(&f.view, vec3_splat(0.0f), vec3_negate(e.w)).y /
                                (double)e.radiance.y -
                            1.0) > 1e-3;
        if (far)
            continue;
        /* intensity, as light_sample finds it at distance 1 */
        LightSample s;
        TEST_TRUE(light_sample(&f.view, 0, vec3_add(e.p, e.w), vec2(0.5f, 0.5f), &s));
        /* A narrow spot's edge is 8.7e-5 wide in the cosine, of which rounding takes 1.2e-7. */
        differs += fabs((double)(s.radiance.x - e.radiance.x)) > (_i == NARROW_SPOT ? 0.02 : 1e-3);
    }
    ck_assert_msg(differs <= count / 500, "case %d: %d of %d differ", _i, differs, count);
    fixture_destroy(&f);
}
END_TEST

/* Origins are uniform on the disc that touches the bounding sphere. */
START_TEST(test_disc)
{
    double observed[CELLS * CELLS] = {0.0}, expected[CELLS * CELLS];
    LightFixture f;
    setup(&f, _i);
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e;
        TEST_TRUE(light_emit(&f.view, 0, fixture_random(2, i), fixture_random(9, i), &e));
        Vec3 local = frame_to_local(frame_from_normal(e.w), vec3_sub(e.p, f.scene.frame.scene.world_center));
        TEST_NEAR(local.z, -3.0, 1e-5);
        double x = (double)local.x / 3.0, y = (double)local.y / 3.0, square = x * x + y * y;
        TEST_TRUE(square < 1.00001);
        int row = (int)fmin(square * CELLS, CELLS - 1);
        observed[row * CELLS + (int)fmin((atan2(y, x) / (2.0 * M_PI) + 0.5) * CELLS, CELLS - 1)] += 1.0;
    }
    for (int i = 0; i < CELLS * CELLS; ++i)
        expected[i] = (double)SAMPLES / (CELLS * CELLS);
    double p = test_chi_square(observed, expected, CELLS * CELLS);
    ck_assert_msg(p > P_MIN, "case %d: chi-square p = %g", _i, p);
    ck_assert_double_eq_tol((double)light_emit_pdf_disc(&f.view), 1.0 / (9.0 * M_PI), 1e-6);
    fixture_destroy(&f);
}
END_TEST

/* A spot's intensity over its density varies by at most 9/8: light paths of all directions have about the same weight.
 * A spot with no opening angle, and infinite lights in an empty scene, emit nothing. */
START_TEST(test_bounds)
{
    LightFixture f;
    LightEmission e;
    setup(&f, WIDE_SPOT);
    double integral = 2.0 * M_PI * (double)spot_emit_integral(f.view.light_details);
    for (uint i = 0; i < 5000; ++i) {
        TEST_TRUE(light_emit(&f.view, 0, fixture_random(2, i), fixture_random(9, i), &e));
        TEST_TRUE((double)e.radiance.x / (double)e.pdf_w < 1.1251 * 2.0 * integral);
    }
    LightDetail *spot = &ARRAY_AT(&f.scene.light_details, LightDetail, 0);
    spot->cos_falloff = spot->cos_total = 1.0f;
    ck_assert(!light_emit(&f.view, 0, vec2(0.5f, 0.5f), vec2(0.5f, 0.5f), &e));
    fixture_destroy(&f);
    for (int which = CONSTANT; which <= DISTANT; ++which) {
        setup(&f, which);
        f.scene.frame.scene.world_radius = 0.0f;
        ck_assert(!light_emit(&f.view, 0, vec2(0.5f, 0.5f), vec2(0.3f, 0.4f), &e));
        fixture_destroy(&f);
    }
}
END_TEST

/* Spots that emit in nearly all directions: sampled directions are unit vectors, also next to the edge. */
START_TEST(test_wide_spots)
{
    for (int k = 1; k < 20000; ++k)
        for (int j = 1; j < 5; ++j) {
            LightDetail spot = {.direction = {0.0f, 0.0f, 1.0f}, .cos_total = -1.0f};
            spot.cos_falloff = -1.0f + (float)k * 0x1p-24f;
            Vec3 w = spot_emit_direction(&spot, vec2(1.0f - (float)j * 0x1p-24f, 0.3f));
            TEST_NEAR(vec3_length(w), 1.0, 1e-5);
        }
}
END_TEST

TCase *emit_direction_case(void)
{
    TCase *tcase = tcase_create("other lights");
    tcase_add_test(tcase, test_wide_spots);
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_directions, 0, DISTANT);
    tcase_add_loop_test(tcase, test_records, 0, LIGHT_CASES);
    tcase_add_loop_test(tcase, test_disc, CONSTANT, LIGHT_CASES);
    tcase_add_test(tcase, test_bounds);
    return tcase;
}
