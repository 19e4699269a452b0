/* Openings: the rectangles that are fitted to rays through windows, those found for a room, and that its picture is the
 * same with them but for less noise. */
#include "support/geometry_fixture.h"
#include "support/render_fixture.h"
#include "support/room_scene.h"
#include "support/test_util.h"

#include "backend_cpu.h"
#include "render/opening_fit.h"
#include "render/opening_frame.h"
#include "render/openings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RAYS = 1200, MOST = 6 };
#define RADIUS 12.0f

/* A window perpendicular to an axis, seen from the origin's side. */
typedef struct Window {
    int axis;
    double at, low[2], high[2];
} Window;

static float between(double low, double high, unsigned short state[3])
{
    return (float)(low + (high - low) * erand48(state));
}

/* Rays from uniform places in the cube [-2, 2]^3 through the window. */
static void rays_through(const Window *window, FarRay *rays, size_t count, unsigned short state[3])
{
    for (size_t i = 0; i < count; ++i) {
        float to[3];
        to[window->axis] = (float)window->at;
        for (int k = 0; k < 2; ++k)
            to[(window->axis + 1 + k) % 3] = between(window->low[k], window->high[k], state);
        Vec3 from = vec3(between(-2, 2, state), between(-2, 2, state), between(-2, 2, state));
        rays[i] = (FarRay){from, vec3_normalize(vec3_sub(vec3(to[0], to[1], to[2]), from)), 1.0f, 0};
    }
}

static double area_of(const Opening *opening)
{
    return ((double)opening->u_high - (double)opening->u_low) * ((double)opening->v_high - (double)opening->v_low);
}

/* Whether the opening is the window, to within a part of its extent. */
static bool is_window(const Opening *opening, const Window *window, double part)
{
    const double found[4] = {(double)opening->u_low, (double)opening->v_low, (double)opening->u_high,
                             (double)opening->v_high};
    const double extent = fmax(window->high[0] - window->low[0], window->high[1] - window->low[1]) * part;
    return (int)opening->axis == window->axis && fabs((double)opening->at - window->at) < extent &&
           fabs(found[0] - window->low[0]) < extent && fabs(found[1] - window->low[1]) < extent &&
           fabs(found[2] - window->high[0]) < extent && fabs(found[3] - window->high[1]) < extent;
}

static const Window WINDOWS[] = {
    {0, 3.0, {-1.0, 0.5}, {0.5, 1.5}}, {1, -2.5, {0.0, -1.0}, {1.0, 1.0}}, {2, 2.2, {0.5, -0.6}, {1.1, 0.2}}};

/* One window is found, with all but the part of the rays that is left for light not seen, and its outer side. */
START_TEST(test_window)
{
    FarRay rays[RAYS];
    Opening openings[MOST];
    Error error = {0};
    size_t count;
    unsigned short state[3] = {(unsigned short)_i, 3, 5};
    const Window *window = &WINDOWS[_i];
    rays_through(window, rays, RAYS, state);
    ck_assert(openings_fit(rays, RAYS, RADIUS, openings, MOST, &count, &error));
    ck_assert_uint_eq(count, 1);
    ck_assert_msg(is_window(&openings[0], window, 0.1), "axis %u at %g, [%g %g] x [%g %g]", openings[0].axis,
                  (double)openings[0].at, (double)openings[0].u_low, (double)openings[0].u_high,
                  (double)openings[0].v_low, (double)openings[0].v_high);
    ck_assert_double_eq_tol((double)openings[0].share, 0.85, 1e-6);
    ck_assert_double_eq((double)openings[0].side, window->at > 0.0 ? 1.0 : -1.0);
}
END_TEST

/* Three windows, of different walls: most rays pass small rectangles, in proportion to what comes through each. */
START_TEST(test_windows)
{
    FarRay rays[RAYS];
    Opening openings[MOST];
    Error error = {0};
    size_t count;
    unsigned short state[3] = {1, 2, 3};
    rays_through(&WINDOWS[0], rays, RAYS / 2, state);
    rays_through(&WINDOWS[1], rays + RAYS / 2, RAYS / 4, state);
    rays_through(&WINDOWS[2], rays + RAYS * 3 / 4, RAYS / 4, state);
    ck_assert(openings_fit(rays, RAYS, RADIUS, openings, MOST, &count, &error));
    double shares = 0.0, density = 0.0;
    for (size_t i = 0; i < count; ++i) {
        shares += (double)openings[i].share;
        density += (double)openings[i].share / area_of(&openings[i]);
    }
    ck_assert_uint_ge(count, 3);
    ck_assert_double_le(shares, 0.85 + 1e-6);
    ck_assert_double_gt(shares, 0.7);
    ck_assert_double_gt(density, 0.35); /* .44 by the windows themselves; 1 / 452 on the disc */
}
END_TEST

/* There are none where light comes from all sides, by few rays or by none; and no more than there is room for. */
START_TEST(test_none)
{
    static const Window sky = {2, 0.0, {-9.0, -9.0}, {9.0, 9.0}};
    FarRay rays[RAYS];
    Opening openings[MOST];
    Error error = {0};
    size_t count = 7;
    unsigned short state[3] = {1, 2, 3};
    ck_assert(openings_fit(rays, 0, RADIUS, openings, MOST, &count, &error));
    ck_assert_uint_eq(count, 0);
    rays_through(&WINDOWS[0], rays, 20, state);
    ck_assert(openings_fit(rays, 20, RADIUS, openings, MOST, &count, &error));
    ck_assert_uint_eq(count, 0);
    for (int i = 0; i < RAYS; ++i) {
        Vec3 d = vec3(between(-1, 1, state), between(-1, 1, state), between(0.1, 1, state));
        rays_through(&sky, &rays[i], 1, state);
        rays[i].origin = vec3(between(-9, 9, state), between(-9, 9, state), between(-1, 1, state));
        rays[i].direction = vec3_normalize(d);
    }
    ck_assert(openings_fit(rays, RAYS, RADIUS, openings, MOST, &count, &error));
    ck_assert_uint_eq(count, 0);
    for (int i = 0; i < 3; ++i)
        rays_through(&WINDOWS[i], rays + RAYS / 3 * i, RAYS / 3, state);
    ck_assert(openings_fit(rays, RAYS, RADIUS, openings, 2, &count, &error));
    ck_assert_uint_le(count, 2);
}
END_TEST

/* ---- the frame --------------------------------------------------------------------------------------------------- */

/* Normals of walls in a frame, turned from the world's by 33 degrees (_i 0) or not at all (1), and as many of round
 * things: it is found again, the world's exactly. With nothing but a floor (2), that is perpendicular to an axis;
 * without surfaces (3) the frame is the world's. */
START_TEST(test_frame)
{
    const Vec3 axis = vec3_normalize(vec3(1.0f, 2.0f, 3.0f));
    const float angle = _i == 0 || _i == 2 ? (float)(33.0 * M_PI / 180.0) : 0.0f;
    Vec3 normals[RAYS], axes[3];
    TestRandom random = {.seed = 4};
    for (int k = 0; k < 3; ++k) { /* Rodrigues */
        Vec3 v = vec3(k == 0 ? 1.0f : 0.0f, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f);
        Vec3 turned = vec3_add(vec3_scale(v, cosf(angle)), vec3_scale(vec3_cross(axis, v), sinf(angle)));
        axes[k] = angle > 0.0f ? vec3_mad(turned, (1.0f - cosf(angle)) * vec3_dot(axis, v), axis) : v;
    }
    for (size_t i = 0; i < RAYS; ++i) {
        Vec3 wall = vec3_scale(axes[_i == 2 ? 2 : i % 3], i % 4 < 2 ? 1.0f : -1.0f);
        normals[i] = _i == 3 ? vec3_splat(0.0f) : _i < 2 && i % 7 < 4 ? random_direction(&random) : wall;
    }
    Frame frame = opening_frame(normals, RAYS);
    const Vec3 found[3] = {frame.t, frame.b, frame.n};
    for (int k = 0; k < 3; ++k) {
        TEST_NEAR(vec3_dot(found[k], found[k]), 1.0, 1e-5);
        TEST_NEAR(vec3_dot(vec3_cross(found[k], found[(k + 1) % 3]), found[(k + 2) % 3]), 1.0, 1e-5);
        if (_i != 2 || k == 2)
            ck_assert_double_gt((double)vec3_dot(found[k], axes[k]), _i == 0 ? 0.9999 : 0.999999);
        ck_assert(_i == 0 || _i == 2 || memcmp(&found[k], &axes[k], sizeof(Vec3)) == 0);
    }
}
END_TEST

/* ---- a room ------------------------------------------------------------------------------------------------------ */

static double relative_noise(const RenderedImage *a, const RenderedImage *b)
{
    double sum = 0.0;
    int count = 3 * a->width * a->height;
    for (int i = 0; i < count; ++i) {
        double x = (double)a->rgb[i], y = (double)b->rgb[i];
        sum += (x - y) * (x - y) / (0.25 * (x + y) * (x + y) + 1e-4);
    }
    return sum / count;
}

/* Means agree, and two pictures by openings differ much less from each other than without. */
START_TEST(test_room)
{
    RenderSetup setup = {.text = ROOM_SCENE, .samples = 48, .threads = 2, .integrator = integrator_bdpt()};
    RenderedImage images[2][2];
    double mean[2], spread = 0.0;
    for (int with = 0; with < 2; ++with) {
        setup.no_openings = with == 0;
        for (int i = 0; i < 2; ++i) {
            setup.seed = (uint64_t)(1 + i);
            fixture_render(&setup, &images[with][i]);
            ck_assert_uint_eq(images[with][i].result.openings, with == 0 ? 0 : 2);
        }
        double a = fixture_mean(&images[with][0]), b = fixture_mean(&images[with][1]);
        mean[with] = 0.5 * (a + b);
        spread = fmax(spread, fabs(a - b));
    }
    double noise[2] = {relative_noise(&images[0][0], &images[0][1]), relative_noise(&images[1][0], &images[1][1])};
    ck_assert_msg(fabs(mean[1] - mean[0]) < 3.0 * spread + 0.01 * mean[0], "mean %g by openings, %g without", mean[1],
                  mean[0]);
    ck_assert_msg(noise[1] < 0.5 * noise[0], "noise %g by openings, %g without", noise[1], noise[0]);
    for (int i = 0; i < 4; ++i)
        fixture_destroy(&images[i / 2][i % 2]);
}
END_TEST

/* The openings that are found for a scene. */
static OpeningParams found(const char *text)
{
    RenderSetup setup = {.text = text, .threads = 2};
    const RenderOptions options = {.samples = 1, .max_depth = 5, .seed = 3};
    Scene scene;
    Error error = {0};
    fixture_scene(&setup, &scene);
    RenderRun run = {.interface = backend_cpu(), .backend = fixture_open(&setup, &scene, &error), .options = &options};
    ck_assert(run.backend != NULL);
    render_frame(integrator_bdpt(), &scene, &options, &run.frame);
    ck_assert_msg(openings_find(&run, &scene, &error), "%s", error.message);
    run.interface->close(run.backend);
    scene_destroy(&scene);
    return run.frame.openings;
}

/* In a room that is turned in the world, they are in its frame; in another, in the world's. Both lights have the
 * window; light subpaths are divided by the light that they bring, which a brighter sun's is more of, beside what they
 * have anyway. */
START_TEST(test_room_found)
{
    static const Window window = {0, 2.0, {-0.4, 1.0}, {0.4, 1.8}};
    double ratio[2];
    for (int bright = 0; bright < 2; ++bright) {
        OpeningParams openings = found(bright ? ROOM_SCENE_BRIGHT : _i == 0 ? ROOM_SCENE : ROOM_SCENE_TURNED);
        TEST_NEAR(openings.frame.t.x, bright || _i == 0 ? 1.0 : 0.85, 1e-3);
        ck_assert_uint_eq(openings.count, 2);
        ck_assert_uint_eq(openings.light_count, 2);
        for (uint i = 0; i < 2; ++i) {
            const Opening *opening = &openings.each[i];
            if (opening->light == 0) { /* any plane will do for parallel rays */
                const double cosines[3] = {5.0 / sqrt(45.0), 2.0 / sqrt(45.0), 4.0 / sqrt(45.0)};
                double area = area_of(opening) * cosines[opening->axis], of_window = 0.64 * cosines[0];
                ck_assert_msg(area > 0.9 * of_window && area < 2.0 * of_window, "%g, the window %g", area, of_window);
                continue;
            }
            ck_assert_msg(is_window(opening, &window, 0.3), "axis %u at %g, [%g %g] x [%g %g]", opening->axis,
                          (double)opening->at, (double)opening->u_low, (double)opening->u_high, (double)opening->v_low,
                          (double)opening->v_high);
            ck_assert_double_eq((double)opening->side, 1.0);
        }
        TEST_NEAR(openings.light_shares[0] + openings.light_shares[1], 1.0, 1e-6);
        TEST_NEAR(openings.light_pdfs[0] + openings.light_pdfs[1], bright ? 0.5 : 1.0, 1e-6); /* half for the lamp */
        double sun = (double)openings.light_shares[openings.lights[0] == 0 ? 0 : 1];
        ck_assert_double_gt(sun, 0.05);
        ratio[bright] = sun / (1.0 - sun);
    }
    ck_assert_double_gt(ratio[1], 2.0 * ratio[0]);
}
END_TEST

/* Out of doors connections find the light, and there are none; nor are there without lights at infinity. */
START_TEST(test_open_found)
{
    static const char *const SCENES[] = {
        ROOM_HEAD
        "LightSource \"infinite\" \"rgb L\" [0.6 0.8 1] Translate 1 1 0.4 Shape \"sphere\" \"float radius\" 0.4 "
        "Translate -1 -1 -0.4 " ROOM_WALL("-90 -90 0 90 -90 0 -90 90 0 90 90 0"),
        ROOM_HEAD "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 0 2] " ROOM_WALL(
            "-90 -90 0 90 -90 0 -90 90 0 90 90 0")};
    ck_assert_uint_eq(found(SCENES[_i]).count, 0);
    ck_assert_uint_eq(found(SCENES[_i]).light_count, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("openings");
    TCase *fit = tcase_create("fit"), *room = tcase_create("room");
    tcase_add_loop_test(fit, test_window, 0, 3);
    tcase_add_test(fit, test_windows);
    tcase_add_test(fit, test_none);
    tcase_add_loop_test(fit, test_frame, 0, 4);
    tcase_set_timeout(fit, 30);
    tcase_add_test(room, test_room);
    tcase_add_loop_test(room, test_room_found, 0, 2);
    tcase_add_loop_test(room, test_open_found, 0, 2);
    tcase_set_timeout(room, 60);
    suite_add_tcase(suite, fit);
    suite_add_tcase(suite, room);
    return test_run(suite);
}
