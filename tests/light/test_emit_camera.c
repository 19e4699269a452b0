/* Connections to the lens: camera_connect as the inverse of camera_ray, and its density against finite differences of
 * rays. */
#include "camera/camera.h"
#include "light/test_emit.h"
#include "scene/camera_setup.h"
#include "support/light_fixture.h"

typedef struct CameraCase {
    uint kind;
    float lens_radius;
    int transform; /* 0: rotation and translation; 1: also scaled by 2.5; 2: stretched and sheared */
    float window[4];
    bool has_window;
    int width, height, crop[4];
    float filter_radius;
} CameraCase;

static const CameraCase CASES[] = {
    {CAMERA_PERSPECTIVE, 0.0f, 0, {0}, false, 160, 120, {0, 0, 160, 120}, 0.5f},
    {CAMERA_PERSPECTIVE, 0.3f, 0, {0}, false, 160, 120, {20, 30, 90, 60}, 2.0f},
    {CAMERA_PERSPECTIVE, 0.0f, 1, {-1.0f, 0.5f, -0.2f, 1.0f}, true, 100, 300, {0, 0, 100, 300}, 1.5f},
    {CAMERA_PERSPECTIVE, 0.4f, 2, {1.0f, -0.5f, -0.2f, 0.7f}, true, 64, 32, {3, 4, 60, 31}, 4.0f},
    {CAMERA_ORTHOGRAPHIC, 0.0f, 0, {0}, false, 160, 120, {0, 0, 160, 120}, 0.5f},
    {CAMERA_ORTHOGRAPHIC, 0.2f, 1, {0}, false, 120, 160, {10, 20, 30, 100}, 2.0f},
    {CAMERA_ORTHOGRAPHIC, 0.3f, 2, {-3.0f, 1.0f, 2.0f, 0.5f}, true, 64, 32, {3, 4, 60, 31}, 0.3f},
};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

#define FOCAL_DISTANCE 7.0f

static FrameParams setup(const CameraCase *c)
{
    static const double ROTATED[12] = {0.6, 0.0, 0.8, 3.0, 0.0, 1.0, 0.0, -1.0, -0.8, 0.0, 0.6, 2.0};
    static const double SHEARED[12] = {1.2, 0.3, 0.4, 3.0, -0.2, 0.7, 0.1, -1.0, -0.8, 0.5, 2.0, 2.0};
    CameraSettings settings = {.kind = c->kind,
                               .fov = 50.0f,
                               .has_screen_window = c->has_window,
                               .lens_radius = c->lens_radius,
                               .focal_distance = FOCAL_DISTANCE};
    Error error = {0};
    memcpy(settings.screen_window, c->window, sizeof c->window);
    memcpy(settings.world_from_camera, c->transform == 2 ? SHEARED : ROTATED, sizeof ROTATED);
    settings.world_from_camera[15] = 1.0;
    for (int i = 0; i < 12; ++i)
        settings.world_from_camera[i] *= c->transform == 1 && i % 4 < 3 ? 2.5 : 1.0;
    test_matrix_inverse(settings.world_from_camera, settings.camera_from_world);
    FrameParams frame = {.film.width = (uint)c->width,
                         .film.height = (uint)c->height,
                         .film.crop_x0 = (uint)c->crop[0],
                         .film.crop_y0 = (uint)c->crop[1],
                         .film.crop_x1 = (uint)c->crop[2],
                         .film.crop_y1 = (uint)c->crop[3],
                         .film.filter = {.radius_x = c->filter_radius, .radius_y = c->filter_radius}};
    ck_assert_msg(camera_setup(&settings, c->width, c->height, &frame.camera, &error), "%s", error.message);
    return frame;
}

static Ray ray_at(const FrameParams *frame, Vec2 film, Vec2 u_lens)
{
    return camera_ray(&frame->camera, film, (float)frame->film.width, (float)frame->film.height, u_lens);
}

/* A film position uniform over the crop window. */
static Vec2 crop_point(const FrameParams *frame, Vec2 u)
{
    return vec2((float)frame->film.crop_x0 + u.x * (float)(frame->film.crop_x1 - frame->film.crop_x0),
                (float)frame->film.crop_y0 + u.y * (float)(frame->film.crop_y1 - frame->film.crop_y0));
}

START_TEST(test_inverse)
{
    FrameParams frame = setup(&CASES[_i]);
    double worst = 0.0;
    for (uint i = 0; i < 4096; ++i) {
        Vec2 u = fixture_random(2, i), film = crop_point(&frame, fixture_random(1, i));
        if (!camera_film_covered(&frame, film))
            continue; /* at the border, with a filter narrower than a pixel */
        Ray ray = ray_at(&frame, film, u);
        float distance = 1.0f + 20.0f * fixture_random(3, i).x;
        CameraConnection c;
        TEST_TRUE(camera_connect(&frame, vec3_mad(ray.o, distance, ray.d), u, &c));
        worst = fmax(worst, hypot((double)(c.film.x - film.x), (double)(c.film.y - film.y)));
        TEST_TRUE(vec3_length(vec3_sub(c.p, ray.o)) < 1e-5f);
        TEST_TRUE(vec3_length(vec3_add(c.wi, ray.d)) < 5e-6f);
        TEST_NEAR((double)camera_pdf(&frame, ray.o, ray.d, distance) / (double)c.pdf, 1.0, 2e-5);
        TEST_TRUE(!camera_connect(&frame, vec3_mad(ray.o, -1.0f, ray.d), u, &c));
        TEST_TRUE(camera_pdf(&frame, ray.o, vec3_negate(ray.d), distance) == 0.0f);
    }
    ck_assert_msg(worst < 3e-4, "case %d: %g pixels off", _i, worst);
}
END_TEST

/* Where the ray of a film position intersects the plane through p perpendicular to d. */
static void meet(const FrameParams *frame, Vec2 film, Vec2 u, Vec3 p, Vec3 d, double out[3])
{
    Ray ray = ray_at(frame, film, u);
    const double o[3] = {(double)ray.o.x, (double)ray.o.y, (double)ray.o.z};
    const double w[3] = {(double)ray.d.x, (double)ray.d.y, (double)ray.d.z};
    const double q[3] = {(double)p.x, (double)p.y, (double)p.z}, n[3] = {(double)d.x, (double)d.y, (double)d.z};
    double along = 0.0, cosine = 0.0;
    for (int k = 0; k < 3; ++k) {
        along += (q[k] - o[k]) * n[k];
        cosine += w[k] * n[k];
    }
    for (int k = 0; k < 3; ++k)
        out[k] = o[k] + along / cosine * w[k];
}

/* How far inside the area reached by the filters of the crop window's pixels the position is, in pixels along the worse
 * axis; negative outside. */
static double reach_margin(const FrameParams *frame, Vec2 film)
{
    double rx = (double)frame->film.filter.radius_x, ry = (double)frame->film.filter.radius_y;
    double x = fmin((double)film.x - (frame->film.crop_x0 + 0.5 - rx), frame->film.crop_x1 - 0.5 + rx - (double)film.x);
    double y = fmin((double)film.y - (frame->film.crop_y0 + 0.5 - ry), frame->film.crop_y1 - 0.5 + ry - (double)film.y);
    return fmin(x, y);
}

/* One over the density is the area perpendicular to the ray that is seen by a unit square of the film, times the number
 * of pixels of the crop window; also for film positions up to the filter's radius outside. */
START_TEST(test_density)
{
    FrameParams frame = setup(&CASES[_i]);
    double pixels =
        (double)(frame.film.crop_x1 - frame.film.crop_x0) * (double)(frame.film.crop_y1 - frame.film.crop_y0);
    for (uint i = 0; i < 2000; ++i) {
        const float h = 0.25f;
        Vec2 u = fixture_random(2, i), r = fixture_random(1, i);
        Vec2 film = crop_point(&frame, vec2(1.4f * r.x - 0.2f, 1.4f * r.y - 0.2f));
        Ray ray = ray_at(&frame, film, u);
        float distance = 3.0f + 5.0f * fixture_random(3, i).x;
        Vec3 p = vec3_mad(ray.o, distance, ray.d);
        double x0[3], x1[3], y0[3], y1[3], cross = 0.0;
        meet(&frame, vec2(film.x - h, film.y), u, p, ray.d, x0);
        meet(&frame, vec2(film.x + h, film.y), u, p, ray.d, x1);
        meet(&frame, vec2(film.x, film.y - h), u, p, ray.d, y0);
        meet(&frame, vec2(film.x, film.y + h), u, p, ray.d, y1);
        for (int k = 0; k < 3; ++k) {
            int l = (k + 1) % 3, m = (k + 2) % 3;
            double c = (x1[l] - x0[l]) * (y1[m] - y0[m]) - (x1[m] - x0[m]) * (y1[l] - y0[l]);
            cross += c * c;
        }
        double area = sqrt(cross) / (4.0 * (double)h * (double)h) * pixels;
        TEST_NEAR((double)camera_pdf(&frame, ray.o, ray.d, distance) * area, 1.0, 2e-3);
        CameraConnection c = {.pdf = 0.0f};
        double margin = reach_margin(&frame, film);
        bool connected = camera_connect(&frame, p, u, &c);
        TEST_TRUE(connected == (margin > 0.0) || fabs(margin) < 1e-3);
        TEST_NEAR((double)c.pdf * area, 1.0, 2e-3);
    }
}
END_TEST

/* The density integrates to 1 over the part of a slanted plane seen by the crop window. */
START_TEST(test_integral)
{
    enum { N = 500 };
    FrameParams frame = setup(&CASES[_i]);
    const Vec2 u = {0.3f, 0.8f};
    Ray middle = ray_at(&frame, crop_point(&frame, vec2(0.5f, 0.5f)), u);
    Vec3 p = vec3_mad(middle.o, 5.0f, middle.d);
    Vec3 n = vec3_normalize(vec3_add(middle.d, vec3(0.1f, -0.15f, 0.2f)));
    Frame plane = frame_from_normal(n);
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9}, sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        double q[3];
        meet(&frame, crop_point(&frame, vec2((float)(i & 1), (float)(i >> 1))), u, p, n, q);
        Vec3 local = frame_to_local(plane, vec3_sub(vec3((float)q[0], (float)q[1], (float)q[2]), p));
        low[0] = fmin(low[0], (double)local.x), high[0] = fmax(high[0], (double)local.x);
        low[1] = fmin(low[1], (double)local.y), high[1] = fmax(high[1], (double)local.y);
    }
    for (uint i = 0; i < N * N; ++i) {
        CameraConnection c = {.film = {-1.0f, -1.0f}};
        Vec2 s = fixture_stratified(5, i, N);
        Vec3 local = vec3((float)(low[0] + (high[0] - low[0]) * (double)s.x),
                          (float)(low[1] + (high[1] - low[1]) * (double)s.y), 0.0f);
        camera_connect(&frame, vec3_add(p, frame_to_world(plane, local)), u, &c);
        if (c.film.x >= (float)frame.film.crop_x0 && c.film.x < (float)frame.film.crop_x1 &&
            c.film.y >= (float)frame.film.crop_y0 && c.film.y < (float)frame.film.crop_y1)
            sum += (double)c.pdf * fabs((double)vec3_dot(c.wi, n));
    }
    sum *= (high[0] - low[0]) * (high[1] - low[1]) / ((double)N * N);
    ck_assert_msg(fabs(sum - 1.0) < 2e-3, "case %d: the density integrates to %g", _i, sum);
}
END_TEST

/* Closed forms: a pinhole with a film of A = 4 at z = 1, and an orthographic camera with the same window. */
START_TEST(test_formulas)
{
    for (uint kind = CAMERA_PERSPECTIVE; kind <= CAMERA_ORTHOGRAPHIC; ++kind) {
        CameraSettings settings = {.kind = kind, .fov = 90.0f, .focal_distance = 1.0f};
        for (int i = 0; i < 4; ++i)
            settings.world_from_camera[5 * i] = settings.camera_from_world[5 * i] = 1.0;
        FrameParams frame = {.film.width = 10, .film.height = 10, .film.crop_x1 = 10, .film.crop_y1 = 10};
        frame.film.filter.radius_x = frame.film.filter.radius_y = 0.5f;
        Error error = {0};
        ck_assert(camera_setup(&settings, 10, 10, &frame.camera, &error));
        CameraConnection c;
        Vec3 p = vec3(0.6f, 0.0f, 0.8f);
        ck_assert(camera_connect(&frame, p, vec2(0.5f, 0.5f), &c));
        double expected = kind == CAMERA_PERSPECTIVE ? 1.0 / (4.0 * 0.512) : 1.0 / 4.0;
        ck_assert_double_eq_tol((double)c.pdf, expected, 1e-6);
        ck_assert_double_eq_tol((double)c.film.x, kind == CAMERA_PERSPECTIVE ? 5.0 + 5.0 * 0.75 : 5.0 + 5.0 * 0.6,
                                1e-5);
    }
}
END_TEST

TCase *emit_camera_case(void)
{
    TCase *tcase = tcase_create("camera");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_inverse, 0, CASE_COUNT);
    tcase_add_loop_test(tcase, test_density, 0, CASE_COUNT);
    tcase_add_loop_test(tcase, test_integral, 0, CASE_COUNT);
    tcase_add_test(tcase, test_formulas);
    return tcase;
}
