/* The aims of light subpaths: which spheres are chosen for a scene, how many rays go through each, and that the
 * densities are what later evaluations find. tests/light/test_emit_power.c has what the rays carry. */
#include "light/aim.h"
#include "light/test_emit.h"
#include "scene/aim_setup.h"
#include "support/light_fixture.h"

/* ---- the choice of aims ------------------------------------------------------------------------------------------ */

static uint add_material(LightFixture *f, uint kind, float roughness)
{
    Error error = {0};
    Material material = {.kind = kind, .flags = MATERIAL_CONDUCTOR_REFLECTANCE, .eta = 1.5f, .normal_map = NONE};
    uint index = NONE;
    material.color0.program = material.color1.program = material.displacement.program = NONE;
    material.roughness_u = material.roughness_v = (FloatParam){roughness, NONE};
    ck_assert(scene_add_material(&f->scene, &material, &index, &error));
    return index;
}

static void add_ball(LightFixture *f, uint material, double x, double y, double z, float radius)
{
    const double matrix[16] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
    const double inverse[16] = {1, 0, 0, -x, 0, 1, 0, -y, 0, 0, 1, -z, 0, 0, 0, 1};
    const Quadric quadric = {.radius = radius, .z_min = -radius, .z_max = radius, .phi_max = 6.28318531f};
    const QuadricData data = {PRIMITIVE_SPHERE, quadric, matrix, inverse};
    Shape shape = fixture_shape(0);
    Error error = {0};
    shape.material = material;
    ck_assert(scene_add_quadric(&f->scene, &data, shape, NULL, 0, &error));
}

static void choose(LightFixture *f)
{
    Error error = {0};
    ARRAY_AT(&f->scene.objects, Object, 0).primitive_count = (uint)f->scene.primitives.count;
    f->view = (SceneView){.positions = f->scene.positions.data,
                          .primitives = f->scene.primitives.data,
                          .shapes = f->scene.shapes.data,
                          .patches = f->scene.patches.data,
                          .quadrics = f->scene.quadrics.data};
    ck_assert_msg(aim_setup(&f->scene, &f->view, &error), "%s", error.message);
    ck_assert_uint_eq(f->scene.frame.scene.aim_count, f->scene.aims.count);
}

static bool aimed_at(const LightFixture *f, double x, double y, double z, double radius)
{
    for (size_t i = 0; i < f->scene.aims.count; ++i) {
        Aim aim = ARRAY_AT(&f->scene.aims, Aim, i);
        double far = hypot(hypot((double)aim.center.x - x, (double)aim.center.y - y), (double)aim.center.z - z);
        if (far + radius <= (double)aim.radius)
            return true;
    }
    return false;
}

static void begin(LightFixture *f)
{
    Error error = {0};
    fixture_init(f);
    ck_assert(f->scene.objects.count > 0 || array_grow(&f->scene.objects, 1, &error));
}

/* Without smooth specular surfaces there are none, and nothing is aimed. */
START_TEST(test_none)
{
    LightFixture f;
    begin(&f);
    add_ball(&f, add_material(&f, MATERIAL_DIFFUSE, 0.0f), 0, 0, 0, 1.0f);
    add_ball(&f, add_material(&f, MATERIAL_CONDUCTOR, 0.3f), 4, 0, 0, 1.0f);
    add_ball(&f, NONE, 8, 0, 0, 1.0f);
    choose(&f);
    ck_assert_uint_eq(f.scene.aims.count, 0);
    fixture_destroy(&f);
}
END_TEST

/* Every smooth ball is in an aim, none is around all, and a small one that is far from the others has one of its
 * own. */
START_TEST(test_groups)
{
    LightFixture f;
    begin(&f);
    uint glass = add_material(&f, MATERIAL_DIELECTRIC, 0.0f), wall = add_material(&f, MATERIAL_DIFFUSE, 0.0f);
    const int count = 400;
    for (int i = 0; i < count; ++i) {
        Vec2 at = fixture_random(31, (uint)i);
        add_ball(&f, glass, 10.0 * (double)at.x, 4.0 * (double)at.y, 0.0, 0.1f);
    }
    add_ball(&f, glass, 100, 100, 0, 0.01f);
    add_ball(&f, wall, -500, 0, 0, 50.0f);
    choose(&f);
    ck_assert_uint_ge(f.scene.aims.count, 2);
    ck_assert_uint_le(f.scene.aims.count, AIMS_MAX);
    for (int i = 0; i < count; ++i) {
        Vec2 at = fixture_random(31, (uint)i);
        TEST_TRUE(aimed_at(&f, 10.0 * (double)at.x, 4.0 * (double)at.y, 0.0, 0.1));
    }
    TEST_TRUE(aimed_at(&f, 100, 100, 0, 0.01));
    double area = 0.0;
    for (size_t i = 0; i < f.scene.aims.count; ++i) {
        Aim aim = ARRAY_AT(&f.scene.aims, Aim, i);
        TEST_TRUE(aim.radius < 6.0f);
        TEST_TRUE((aim.center.x < 90.0f) == (aim.radius > 0.02f));
        area += (double)aim.radius * (double)aim.radius;
    }
    ck_assert_double_lt(area, 5.2 * 5.2 + 2.2 * 2.2); /* of one sphere around the field of balls */
    fixture_destroy(&f);
}
END_TEST

/* ---- rays -------------------------------------------------------------------------------------------------------- */

enum { BALL, LAMP, BOTH_SIDES, POINT, SPOT, DISTANT, CONSTANT, LIGHT_CASES };

static const Aim AIMS[] = {{{3.0f, 1.0f, -2.0f}, 0.05f}, {{-2.0f, 0.5f, -3.0f}, 0.02f}, {{0.0f, 0.0f, 0.0f}, 2.0f}};
enum { AIM_COUNT = sizeof AIMS / sizeof *AIMS };

static void setup(LightFixture *f, int which)
{
    static const float SQUARE[12] = {-1, -1, 0, -1, 1, 0, 1, -1, 0, 1, 1, 0};
    Error error = {0};
    fixture_init(f);
    f->scene.frame.scene.world_radius = 400.0f;
    f->scene.frame.scene.world_center = vec3(10.0f, 20.0f, 0.0f);
    if (which == BALL)
        fixture_add_sphere(f, 0.3f, 0.1, 0.2, 0.3, 1.0f, 0);
    else if (which == LAMP || which == BOTH_SIDES)
        fixture_add_polygon(f, SQUARE, 4, NULL, 0, which == LAMP ? 0 : LIGHT_TWO_SIDED);
    else if (which == CONSTANT)
        fixture_add_light(f, (LightData){.kind = LIGHT_INFINITE, .emission = {1, 1, 1}});
    else
        fixture_add_light(f, (LightData){.kind = which == POINT  ? LIGHT_POINT
                                                 : which == SPOT ? LIGHT_SPOT
                                                                 : LIGHT_DISTANT,
                                         .emission = {1, 1, 1},
                                         .detail.direction = {0, 0, -1},
                                         .detail.cos_total = -0.5f,
                                         .detail.cos_falloff = 0.5f});
    fixture_finish(f);
    memcpy(array_grow(&f->scene.aims, AIM_COUNT, &error), AIMS, sizeof AIMS);
    f->view.aims = f->scene.aims.data;
    f->scene.frame.scene.aim_count = AIM_COUNT;
}

/* Of all rays, AIM_PART goes through the aims, which are so small that hardly another does: as many through each. The
 * last is around the lights with a position, whose rays are then drawn as if it were not there. */
START_TEST(test_shares)
{
    enum { SAMPLES = 60000 };
    LightFixture f;
    int through[AIM_COUNT] = {0};
    setup(&f, _i);
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e;
        if (!light_emit_aimed(&f.view, 0, fixture_random(14, i).x, fixture_random(2, i), fixture_random(9, i), &e))
            continue;
        for (int k = 0; k < AIM_COUNT; ++k)
            through[k] += aim_met(AIMS[k], e.p, e.w) && vec3_dot(vec3_sub(AIMS[k].center, e.p), e.w) > 0.0f;
    }
    const double share = (double)AIM_PART / AIM_COUNT, sigma = sqrt(share * (1.0 - share) * SAMPLES);
    ck_assert_double_eq_tol(through[0], share * SAMPLES, 4.0 * sigma + 20.0);
    ck_assert_double_eq_tol(through[1], share * SAMPLES, 4.0 * sigma + 20.0);
    if (_i == DISTANT)
        ck_assert_double_eq_tol(through[2], share * SAMPLES, 4.0 * sigma + 20.0);
    fixture_destroy(&f);
}
END_TEST

/* The densities of a ray are those that MIS weights evaluate later, but for rounding at the edges of aims. */
START_TEST(test_densities)
{
    enum { SAMPLES = 20000 };
    LightFixture f;
    int differs = 0;
    setup(&f, _i);
    bool far = _i == DISTANT || _i == CONSTANT;
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e;
        if (!light_emit_aimed(&f.view, 0, fixture_random(14, i).x, fixture_random(2, i), fixture_random(9, i), &e))
            continue;
        TEST_NEAR(vec3_length(e.w), 1.0, 1e-6);
        TEST_TRUE(light_aimed_pdf_w(&f.view, 0, e.p, e.ng, e.w) == e.pdf_w);
        TEST_TRUE(_i > BOTH_SIDES || vec3_dot(e.ng, e.w) == e.cosine);
        if (!far)
            continue;
        Vec3 passed = vec3_mad(e.p, 410.0f, e.w); /* in the scene; the origin is outside */
        TEST_TRUE(vec3_length(vec3_sub(e.p, f.scene.frame.scene.world_center)) > 399.9f);
        differs += fabs((double)light_aimed_pdf_disc(&f.view, 0u, passed, e.w) / (double)e.pdf_p - 1.0) > 1e-4;
    }
    ck_assert_msg(differs <= SAMPLES / 200, "case %d: %d differ", _i, differs);
    fixture_destroy(&f);
}
END_TEST

/* The density integrates to one over all directions; below a lamp's horizon, where it emits nothing, as well. */
START_TEST(test_integral)
{
    enum { SAMPLES = 400000 };
    LightFixture f;
    double sum = 0.0, squares = 0.0;
    setup(&f, _i);
    const Vec3 p = vec3(0.4f, 0.3f, 0.0f), ng = vec3(0.0f, 0.0f, _i == LAMP ? 1.0f : -1.0f);
    ARRAY_AT(&f.scene.aims, Aim, 1).radius = 1.5f;
    ARRAY_AT(&f.scene.aims, Aim, 0).radius = 1.0f;
    for (uint i = 0; i < SAMPLES; ++i) {
        double value = 4.0 * M_PI * (double)light_aimed_pdf_w(&f.view, 0, p, ng, warp_sphere(fixture_random(5, i)));
        sum += value / SAMPLES;
        squares += value * value / SAMPLES;
    }
    ck_assert_double_eq_tol(sum, 1.0, 4.0 * sqrt((squares - sum * sum) / SAMPLES));
    fixture_destroy(&f);
}
END_TEST

TCase *emit_aims_case(void)
{
    TCase *tcase = tcase_create("aims");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_none);
    tcase_add_test(tcase, test_groups);
    tcase_add_loop_test(tcase, test_shares, BOTH_SIDES, LIGHT_CASES);
    tcase_add_loop_test(tcase, test_densities, BALL, LIGHT_CASES);
    tcase_add_loop_test(tcase, test_integral, BALL, DISTANT);
    return tcase;
}
