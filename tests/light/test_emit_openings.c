/* Light subpaths that start through openings: how many through each, from which side, with the densities that later
 * evaluations find; and how they are divided among lights. tests/light/test_emit_power.c has what the rays carry. */
#include "light/aim.h"
#include "light/test_emit.h"
#include "support/light_fixture.h"

enum { DISTANT, CONSTANT, IMAGE, LIGHT_CASES };

static const Opening OPENINGS[] = {
    {.light = 1, .axis = 0, .at = 20.0f, .u_low = -1.0f, .v_low = 0.0f, .u_high = 0.0f, .v_high = 2.0f, .share = 0.9f},
    {.light = 0, .axis = 0, .at = 20.0f, .u_low = -1.0f, .v_low = 0.0f, .u_high = 0.0f, .v_high = 2.0f, .share = 0.4f},
    {.light = 0, .axis = 1, .at = -20.0f, .u_low = 1.0f, .v_low = 0.5f, .u_high = 1.5f, .v_high = 0.9f, .share = 0.3f},
    {.light = 0,
     .axis = 2,
     .at = 20.0f,
     .u_low = 0.5f,
     .v_low = -2.0f,
     .u_high = 0.9f,
     .v_high = -1.8f,
     .share = 0.2f}};
enum { OPENING_COUNT = sizeof OPENINGS / sizeof *OPENINGS };
static const float SIDES[OPENING_COUNT] = {0.0f, 1.0f, -1.0f, 0.0f};

/* The openings' frame. */
static Frame turned(void)
{
    Frame frame = frame_from_normal(vec3_normalize(vec3(0.3f, -0.2f, 0.8f)));
    Vec3 t = vec3_add(vec3_scale(frame.t, 0.8f), vec3_scale(frame.b, 0.6f));
    return (Frame){t, vec3_cross(frame.n, t), frame.n};
}

static void setup(LightFixture *f, int which)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    float texels[3 * 64];
    fixture_init(f);
    f->scene.frame.scene.world_radius = 40.0f;
    if (which == DISTANT)
        fixture_add_light(f, (LightData){.kind = LIGHT_DISTANT,
                                         .emission = {1, 1, 1},
                                         .detail.direction = frame_to_world(turned(), vec3(-0.6f, 0.64f, -0.48f))});
    else if (which == CONSTANT)
        fixture_add_light(f, (LightData){.kind = LIGHT_INFINITE, .emission = {1, 1, 1}});
    for (uint i = 0; i < 64; ++i)
        texels[3 * i] = texels[3 * i + 1] = texels[3 * i + 2] = 0.1f + fixture_random(3, i).x;
    if (which == IMAGE)
        fixture_add_environment(f, texels, 8, 8, 0, identity);
    fixture_finish(f);
    f->scene.frame.openings.count = OPENING_COUNT;
    f->scene.frame.openings.frame = turned();
    for (uint i = 0; i < OPENING_COUNT; ++i) {
        f->scene.frame.openings.each[i] = OPENINGS[i];
        f->scene.frame.openings.each[i].side = which == DISTANT ? 0.0f : SIDES[i];
    }
}

static double coordinate(Vec3 v, uint axis)
{
    return axis == 0 ? (double)v.x : axis == 1 ? (double)v.y : (double)v.z;
}

/* Whether the ray's line crosses the opening. */
static bool passes(const Opening *opening, Vec3 p_world, Vec3 w_world)
{
    Vec3 p = frame_to_local(turned(), p_world), w = frame_to_local(turned(), w_world);
    uint u = (opening->axis + 1) % 3, v = (opening->axis + 2) % 3;
    double along = ((double)opening->at - coordinate(p, opening->axis)) / coordinate(w, opening->axis);
    double at_u = coordinate(p, u) + along * coordinate(w, u), at_v = coordinate(p, v) + along * coordinate(w, v);
    return at_u > (double)opening->u_low - 1e-4 && at_u < (double)opening->u_high + 1e-4 &&
           at_v > (double)opening->v_low - 1e-4 && at_v < (double)opening->v_high + 1e-4;
}

/* As many rays pass each opening of the light as its share says, hardly another does, and those drawn through one
 * with an outer side come from there. Every ray has the density that is evaluated for it in the scene. */
START_TEST(test_shares)
{
    enum { SAMPLES = 60000 };
    LightFixture f;
    int through[OPENING_COUNT] = {0}, inner[OPENING_COUNT] = {0}, differ = 0, dim = 0, lost = 0;
    setup(&f, _i);
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e = {0};
        if (!light_emit_aimed(&f.view, 0, fixture_random(14, i).x, fixture_random(2, i), fixture_random(9, i), &e)) {
            ++lost;
            continue;
        }
        for (int k = 1; k < OPENING_COUNT; ++k)
            if (passes(&OPENINGS[k], e.p, e.w)) {
                ++through[k];
                inner[k] += coordinate(frame_to_local(turned(), e.w), OPENINGS[k].axis) * (double)SIDES[k] > 0.0;
            }
        Vec3 passed = vec3_mad(e.p, 39.0f, e.w);
        differ += fabs((double)light_aimed_pdf_disc(&f.view, 0, passed, e.w) / (double)e.pdf_p - 1.0) > 1e-3;
        if (_i == IMAGE) {
            Vec3 d = vec3_negate(e.w);
            dim += fabs((double)environment_beyond(&f.view, 0, d).x / (double)e.radiance.x - 1.0) > 1e-3 ||
                   fabs((double)environment_pdf_w(&f.view, 0, d) / (double)e.pdf_w - 1.0) > 1e-3;
        }
    }
    for (int k = 1; k < OPENING_COUNT; ++k) {
        const double share = (double)OPENINGS[k].share;
        ck_assert_double_eq_tol(through[k], share * SAMPLES, 4.0 * sqrt(share * (1.0 - share) * SAMPLES) + 60.0);
        ck_assert_msg(_i == DISTANT || SIDES[k] == 0.0f || inner[k] < 40, "%d: %d from inside", k, inner[k]);
    }
    ck_assert_int_lt(lost, 40); /* as good as parallel to their opening */
    ck_assert_msg(differ <= SAMPLES / 500 && dim <= SAMPLES / 500, "%d and %d differ", differ, dim);
    fixture_destroy(&f);
}
END_TEST

/* The density per area perpendicular to a direction integrates to what that direction has more of because of mirroring:
 * for a constant light, 1 + the shares of openings that it comes from outside of, less those of the others. */
START_TEST(test_integral)
{
    enum { SAMPLES = 2000000 };
    LightFixture f;
    double sum = 0.0, squares = 0.0, extent = 30.0;
    const Vec3 w = frame_to_world(turned(), vec3_normalize(vec3(-0.5f, 0.4f, -0.7f)));
    setup(&f, CONSTANT);
    const double rest = 1.0 - 0.4 - 0.3 - 0.2, disc = M_PI * 40.0 * 40.0;
    Frame frame = frame_from_normal(w);
    for (uint i = 0; i < SAMPLES; ++i) {
        Vec2 u = fixture_random(5, i);
        Vec3 p = frame_to_world(frame, vec3((float)(extent * (2.0 * (double)u.x - 1.0)),
                                            (float)(extent * (2.0 * (double)u.y - 1.0)), 0.0f));
        double value = 4.0 * extent * extent * (double)light_aimed_pdf_disc(&f.view, 0, p, w);
        sum += value / SAMPLES;
        squares += value * value / SAMPLES;
    }
    const double expected = rest * 4.0 * extent * extent / disc + 2.0 * 0.4 + 2.0 * 0.3 + 0.2;
    ck_assert_double_eq_tol(sum, expected, 4.0 * sqrt((squares - sum * sum) / SAMPLES));
    const Vec3 from_inside = vec3_negate(w);
    const Vec3 through = frame_to_world(turned(), vec3(20.0f, -0.5f, 1.0f));
    const double alone = (double)light_aimed_pdf_disc(&f.view, 0, through, from_inside);
    ck_assert_double_eq_tol(alone / (rest / disc), 1.0, 1e-4);
    fixture_destroy(&f);
}
END_TEST

/* Light subpaths start as often from each light as light_start_pdf says, those of lights that are divided anew
 * according to their shares, and the number that is left over is uniform. Connections choose as they did. */
START_TEST(test_division)
{
    enum { SAMPLES = 200000, LIGHTS = 4 };
    LightFixture f;
    double count[LIGHTS] = {0}, rest[LIGHTS] = {0}, pdf_sum = 0.0;
    fixture_init(&f);
    for (int i = 0; i < 3; ++i)
        fixture_add_light(
            &f,
            (LightData){.kind = LIGHT_DISTANT, .emission = {1.0f + (float)i, 1, 1}, .detail.direction = {0, 0, -1}});
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}});
    fixture_finish(&f);
    const float both =
        f.scene.frame.scene.light_count == LIGHTS ? f.view.lights[2].select_pdf + f.view.lights[0].select_pdf : 0.0f;
    OpeningParams *openings = &f.scene.frame.openings;
    openings->light_count = 2;
    openings->lights[0] = 2;
    openings->lights[1] = 0;
    openings->light_shares[0] = 0.125f;
    openings->light_shares[1] = 0.875f;
    openings->light_pdfs[0] = 0.125f * both;
    openings->light_pdfs[1] = 0.875f * both;
    for (uint i = 0; i < SAMPLES; ++i) {
        Vec2 u;
        uint light = light_start_point(&f.view, random_four(i, 0, 0, 0, 21, 1), &u);
        ck_assert(light < LIGHTS && u.x >= 0.0f && u.x < 1.0f && u.y >= 0.0f && u.y < 1.0f);
        ++count[light];
        rest[light] += (double)u.x;
    }
    for (uint i = 0; i < LIGHTS; ++i) {
        double pdf = (double)light_start_pdf(&f.view, i), sigma = sqrt(pdf * (1.0 - pdf) / SAMPLES);
        pdf_sum += pdf;
        ck_assert_double_eq_tol(count[i] / SAMPLES, pdf, 4.0 * sigma);
        ck_assert_double_eq_tol(rest[i] / count[i], 0.5, 4.0 / sqrt(12.0 * count[i]));
        TEST_NEAR(light_choice_ratio(&f.view, i, vec3_splat(0.2f), vec3_splat(0.0f)) * light_start_pdf(&f.view, i),
                  light_choice_pdf(&f.view, i, vec3_splat(0.2f), vec3_splat(0.0f)), 1e-6);
    }
    ck_assert_double_eq_tol(pdf_sum, 1.0, 1e-6);
    TEST_TRUE(light_start_pdf(&f.view, 1) == f.view.lights[1].select_pdf);
    fixture_destroy(&f);
}
END_TEST

TCase *emit_openings_case(void)
{
    TCase *tcase = tcase_create("openings");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_shares, 0, LIGHT_CASES);
    tcase_add_test(tcase, test_integral);
    tcase_add_test(tcase, test_division);
    return tcase;
}
