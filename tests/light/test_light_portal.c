/* Infinite lights with a portal: the window that a point sees, densities against quadrature over the portal, and rays
 * that leave it. */
#include "light/aim.h"
#include "light/test_light.h"
#include "scene/portal_setup.h"
#include "support/light_fixture.h"

static const double ROTATION[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6};

/* A window of 3 x 2 in the plane x = 2, lit from x > 2. */
static const double CORNERS[4][3] = {{2, -1, 0.5}, {2, -1, 2.5}, {2, 2, 2.5}, {2, 2, 0.5}};
enum { WIDTH = 3, HEIGHT = 2 };

/* In front of the window, beside it, close to it, far away. */
static const Vec3 POINTS[] = {{0, 0.5f, 1.5f}, {-1, 5, -3}, {1.5f, -0.8f, 0.7f}, {-40, 3, 2}};
enum { POINT_COUNT = sizeof POINTS / sizeof *POINTS };

/* What is seen behind the portal: the same from all directions, random texels in either mapping, or a single bright
 * texel. */
enum { CONSTANT, OCTAHEDRAL, LATLONG, HOT, SKIES };

static void portal_add(LightFixture *f)
{
    Error error = {0};
    Portal portal;
    Light *light = &ARRAY_AT(&f->scene.lights, Light, f->scene.lights.count - 1);
    ck_assert_msg(portal_make(CORNERS, &portal, &error), "%s", error.message);
    ck_assert(scene_add_portal(&f->scene, &portal, &scene_light_detail(&f->scene, light)->portal, &error));
    light->flags = (light->flags & ~LIGHT_KIND_MASK) | LIGHT_PORTAL;
}

static void setup(LightFixture *f, int sky)
{
    enum { SIDE = 16 };
    float texels[3 * 2 * SIDE * SIDE] = {0.0f};
    fixture_init(f);
    f->scene.frame.scene.world_radius = 4.0f;
    f->scene.frame.scene.world_center = vec3(0.0f, 0.5f, 1.0f);
    for (uint i = 0; i < 3 * 2 * SIDE * SIDE; ++i) {
        Vec2 r = fixture_random(21, i / 3);
        texels[i] = sky == HOT || r.x < 0.3f ? 0.0f : r.y * r.y;
    }
    if (sky == HOT) {
        Vec2 uv = sphere_to_octahedral(vec3(0.36f, 0.48f, -0.8f)); /* which the rotation takes to (1, 0, 0) */
        for (int k = 0; k < 3; ++k)
            texels[3 * ((uint)(uv.y * SIDE) * SIDE + (uint)(uv.x * SIDE)) + (uint)k] = 1e4f;
    }
    if (sky == CONSTANT)
        fixture_add_light(f, (LightData){.detail.image = NONE, .emission = {2, 2, 2}});
    else
        fixture_add_environment(f, texels, sky == LATLONG ? 2 * SIDE : SIDE, SIDE,
                                sky == LATLONG ? LIGHT_EQUIRECTANGULAR : 0, ROTATION);
    portal_add(f);
    fixture_finish(f);
}

/* Point (x, y) of n x n on the portal. */
static Vec3 portal_point(int x, int y, int n)
{
    return vec3(2.0f, -1.0f + WIDTH * ((float)x + 0.5f) / (float)n, 0.5f + HEIGHT * ((float)y + 0.5f) / (float)n);
}

/* The direction from p to q, and the solid angle per area of the portal there. */
static Vec3 towards(Vec3 p, Vec3 q, double *solid_angle)
{
    Vec3 d = vec3_sub(q, p);
    double square = (double)vec3_length_squared(d), length = sqrt(square);
    *solid_angle = (double)d.x / (length * square);
    return vec3_scale(d, 1.0f / (float)length);
}

/* Integrals over the directions through the portal from p: of the density, and of radiance times the cosine with n. */
static void quadrature(const LightFixture *f, Vec3 p, Vec3 n, double *density, double *irradiance)
{
    const int count = 800;
    *density = *irradiance = 0.0;
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) {
            double solid_angle, area = WIDTH * HEIGHT / ((double)count * count);
            Vec3 d = towards(p, portal_point(x, y, count), &solid_angle);
            double cosine = (double)vec3_dot(d, n);
            *density += (double)light_pdf_w(&f->view, 0, p, d, NULL) * solid_angle * area;
            if (cosine > 0.0)
                *irradiance += cosine * (double)environment_radiance(&f->view, p, d).x * solid_angle * area;
        }
}

/* The density of light_sample integrates to 1 over the window, which is all that is lit, and its samples give the
 * irradiance. The quadrature cuts the few cells of the bright texel to within 1 %. */
START_TEST(test_density)
{
    const Vec3 n = vec3_normalize(vec3(1.0f, 0.3f, 0.2f));
    LightFixture f;
    setup(&f, _i);
    for (int i = 0; i < POINT_COUNT; ++i) {
        double density, irradiance, error;
        quadrature(&f, POINTS[i], n, &density, &irradiance);
        ck_assert_msg(fabs(density - 1.0) < (_i == HOT ? 0.015 : 2e-3),
                      "sky %d, point %d: the density integrates to %g", _i, i, density);
        double sampled = fixture_irradiance(&f, 0, POINTS[i], n, 7, 300, &error);
        ck_assert_msg(fabs(sampled - irradiance) <= 3.0 * error + 2e-3 * irradiance,
                      "sky %d, point %d: irradiance %g, not %g +- %g", _i, i, sampled, irradiance, error);
    }
    fixture_destroy(&f);
}
END_TEST

/* Samples pass the portal, and their density and radiance are those of their direction, except where rounding moves it
 * across a cell's border. */
START_TEST(test_samples)
{
    const int count = 5000;
    LightFixture f;
    setup(&f, _i);
    for (int i = 0; i < POINT_COUNT; ++i) {
        int differ = 0, drawn = 0;
        for (uint k = 0; k < (uint)count; ++k) {
            LightSample s = {0};
            if (!light_sample(&f.view, 0, POINTS[i], fixture_random(4, k), &s))
                continue;
            ++drawn;
            TEST_TRUE(s.infinite == 1u && s.delta == 0u);
            TEST_NEAR(vec3_length(s.wi), 1.0, 1e-6);
            float along = (2.0f - POINTS[i].x) / s.wi.x, y = POINTS[i].y + along * s.wi.y,
                  z = POINTS[i].z + along * s.wi.z;
            TEST_TRUE(s.wi.x > 0.0f && y > -1.001f && y < 2.001f && z > 0.499f && z < 2.501f);
            double pdf = (double)light_pdf_w(&f.view, 0, POINTS[i], s.wi, NULL) / (double)s.pdf_w;
            double emit = (double)environment_pdf_w(&f.view, 0, s.wi) / (double)s.pdf_emit;
            double radiance = (double)environment_radiance(&f.view, POINTS[i], s.wi).x / (double)s.radiance.x;
            differ += fabs(pdf - 1.0) > 1e-3 || fabs(emit - 1.0) > 1e-3 || fabs(radiance - 1.0) > 1e-3;
        }
        ck_assert_msg(differ < count / 200, "sky %d, point %d: %d of %d differ", _i, i, differ, drawn);
        ck_assert(_i == HOT || drawn > count / 10);
    }
    fixture_destroy(&f);
}
END_TEST

/* Behind the portal and beside it nothing is seen, from within the window's bounds everything is. */
START_TEST(test_masked)
{
    LightFixture f;
    LightSample s = {0};
    setup(&f, CONSTANT);
    const Vec3 p = POINTS[0], outside = vec3(3.0f, 0.5f, 1.5f), ahead = vec3(1.0f, 0.0f, 0.0f);
    TEST_TRUE(environment_radiance(&f.view, p, ahead).x == 2.0f);
    TEST_TRUE(environment_radiance(&f.view, p, vec3_negate(ahead)).x == 0.0f);
    TEST_TRUE(environment_radiance(&f.view, outside, ahead).x == 0.0f);
    TEST_TRUE(environment_radiance(&f.view, outside, vec3_negate(ahead)).x == 0.0f);
    TEST_TRUE(!light_sample(&f.view, 0, outside, vec2(0.5f, 0.5f), &s));
    TEST_TRUE(light_pdf_w(&f.view, 0, outside, ahead, NULL) == 0.0f);
    for (int k = 0; k < 4; ++k) { /* just inside of each side, and just outside */
        const float sides[4][2] = {{-1.0f, 1.5f}, {2.0f, 1.5f}, {0.5f, 0.5f}, {0.5f, 2.5f}};
        for (int in = 0; in < 2; ++in) {
            float step = (in ? -0.01f : 0.01f) * (k % 2 ? 1.0f : -1.0f);
            Vec3 q = vec3(2.0f, sides[k][0] + (k < 2 ? step : 0.0f), sides[k][1] + (k < 2 ? 0.0f : step));
            Vec3 d = vec3_normalize(vec3_sub(q, p));
            TEST_TRUE((environment_radiance(&f.view, p, d).x > 0.0f) == (in == 1));
            TEST_TRUE((light_pdf_w(&f.view, 0, p, d, NULL) > 0.0f) == (in == 1));
        }
    }
    fixture_destroy(&f);
}
END_TEST

/* ---- rays that leave it ------------------------------------------------------------------------------------------ */

/* A receiver in the plane x = 0, of half sides 0.5 around (0, 0.5, 1.5). */
static double receiver_flux(const LightFixture *f)
{
    double sum = 0.0;
    for (int i = 0; i < 36; ++i) {
        double density, irradiance;
        Vec3 p = vec3(0.0f, (float)(i % 6) / 6.0f + 0.0833f, (float)(i / 6) / 6.0f + 1.0833f);
        sum += (quadrature(f, p, vec3(1, 0, 0), &density, &irradiance), irradiance) / 36.0;
    }
    return sum;
}

/* Rays begin outside of the scene, pass the portal, have the densities that are evaluated later, and bring the receiver
 * the light that it sees; with aims, too, one of which is partly hidden by the wall around the portal. */
START_TEST(test_emission)
{
    enum { SAMPLES = 200000 };
    static const Aim AIMS[] = {{{0.5f, 0.3f, 1.4f}, 0.3f}, {{-0.3f, 4.0f, -1.0f}, 3.0f}};
    const bool aimed = _i >= SKIES;
    LightFixture f;
    Error error = {0};
    double sum = 0.0, squares = 0.0;
    int differ = 0;
    setup(&f, _i % SKIES);
    if (aimed) {
        memcpy(array_grow(&f.scene.aims, 2, &error), AIMS, sizeof AIMS);
        f.view.aims = f.scene.aims.data;
        f.scene.frame.scene.aim_count = 2;
    }
    for (uint i = 0; i < SAMPLES; ++i) {
        LightEmission e = {0};
        if (!light_emit_aimed(&f.view, 0, fixture_random(11, i).x, fixture_random(2, i), fixture_random(9, i), &e))
            continue;
        Vec3 d = vec3_negate(e.w), p = vec3_mad(e.p, (0.0f - e.p.x) / e.w.x, e.w);
        TEST_TRUE(e.infinite == 1u && e.w.x < 0.0f);
        TEST_NEAR(vec3_dot(vec3_sub(e.p, f.scene.frame.scene.world_center), d), 4.0, 1e-3);
        differ += !environment_reaches(&f.view, 0, p, d) ||
                  fabs((double)light_aimed_pdf_disc(&f.view, 0, p, e.w) / (double)e.pdf_p - 1.0) > 1e-3 ||
                  fabs((double)environment_pdf_w(&f.view, 0, d) / (double)e.pdf_w - 1.0) > 1e-3;
        if (fabsf(p.y - 0.5f) >= 0.5f || fabsf(p.z - 1.5f) >= 0.5f)
            continue;
        double value = (double)e.radiance.x / ((double)e.pdf_p * (double)e.pdf_w);
        sum += value;
        squares += value * value;
    }
    double mean = sum / SAMPLES, deviation = sqrt((squares / SAMPLES - mean * mean) / SAMPLES);
    double expected = receiver_flux(&f);
    ck_assert_msg(fabs(mean - expected) <= 4.0 * deviation + 4e-3 * expected && deviation < 0.05 * expected,
                  "case %d: flux %g, not %g +- %g", _i, mean, expected, deviation);
    ck_assert_msg(differ < SAMPLES / 200, "case %d: %d differ", _i, differ);
    fixture_destroy(&f);
}
END_TEST

/* The power by which lights are chosen is the flux through the portal: of constant radiance, pi times its area. */
START_TEST(test_power)
{
    LightFixture f;
    setup(&f, CONSTANT);
    TEST_NEAR(f.scene.light_power, 2.0 * M_PI * WIDTH * HEIGHT, 0.01);
    fixture_destroy(&f);
}
END_TEST

START_TEST(test_rectangles)
{
    static const double BAD[][4][3] = {
        {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1.1, 0, 0}}, /* not a rectangle */
        {{0, 0, 0}, {0.1, 1, 0}, {1.1, 1, 0}, {1, 0, 0}}, /* slanted */
        {{0, 0, 0}, {0, 1, 0}, {1, 1, 0.1}, {1, 0, 0}}, /* not plane */
        {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}}, /* crossed */
        {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, /* no area */
    };
    Portal portal;
    Error error = {0};
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i)
        ck_assert_msg(!portal_make(BAD[i], &portal, &error), "rectangle %zu", i);
    ck_assert_str_eq(error_text(&error), "the four points of a portal are not the corners of a rectangle");
    ck_assert(portal_make(CORNERS, &portal, &error));
    ck_assert(portal.width == 3.0f && portal.height == 2.0f);
    ck_assert(portal.axes.n.x == 1.0f && portal.axes.t.y == 1.0f && portal.axes.b.z == 1.0f);
    for (int i = 0; i < 4; ++i) {
        Vec3 p = portal_corner(&portal, i);
        ck_assert(p.x == (float)CORNERS[i][0] && p.y == (float)CORNERS[i][1] && p.z == (float)CORNERS[i][2]);
    }
}
END_TEST

/* A scene far from the origin is moved there, and its portals with it. */
START_TEST(test_moved)
{
    static const float square[9] = {8999, -1, 0, 9001, -1, 0, 8999, 1, 0};
    static const uint indices[3] = {0, 1, 2};
    const MeshData mesh = {.positions = square, .vertex_count = 3, .indices = indices, .triangle_count = 1};
    const double corners[4][3] = {{9002, -1, 0.5}, {9002, -1, 2.5}, {9002, 2, 2.5}, {9002, 2, 0.5}};
    const Material material = {.kind = MATERIAL_DIFFUSE, .normal_map = NONE, .displacement.program = NONE};
    LightData light = {.kind = LIGHT_PORTAL, .detail.image = NONE, .emission = {1, 1, 1}};
    Portal portal;
    Scene scene;
    Error error = {0};
    uint index;
    scene_init(&scene);
    ck_assert(scene_add_material(&scene, &material, &index, &error));
    ck_assert(scene_add_mesh(&scene, &mesh, fixture_shape(0), NULL, 0, &error));
    ck_assert(portal_make(corners, &portal, &error) && scene_add_portal(&scene, &portal, &light.detail.portal, &error));
    ck_assert(scene_add_light(&scene, &light, &error));
    scene.movable = true;
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    TEST_NEAR(ARRAY_AT(&scene.portals, Portal, 0).corner.x, 2.0, 1e-3);
    TEST_NEAR(ARRAY_AT(&scene.portals, Portal, 0).corner.y, -1.0, 1e-3);
    scene_destroy(&scene);
}
END_TEST

TCase *light_portal_case(void)
{
    TCase *tcase = tcase_create("portals");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_density, 0, SKIES);
    tcase_add_loop_test(tcase, test_samples, 0, SKIES);
    tcase_add_test(tcase, test_masked);
    tcase_add_loop_test(tcase, test_emission, 0, 2 * SKIES);
    tcase_add_test(tcase, test_power);
    tcase_add_test(tcase, test_rectangles);
    tcase_add_test(tcase, test_moved);
    return tcase;
}
