/* Spherical cameras: directions of film positions as in pbrt, the film positions of a direction, and the density. */
#include "camera/view.h"
#include "light/test_emit.h"
#include "scene/camera_setup.h"
#include "support/light_fixture.h"

typedef struct SphericalCase {
    uint kind;
    bool sheared;
    int width, height, crop[4];
    float filter_radius;
} SphericalCase;

static const SphericalCase CASES[] = {
    {CAMERA_EQUAL_AREA, false, 64, 64, {0, 0, 64, 64}, 0.5f},
    {CAMERA_EQUAL_AREA, true, 12, 7, {0, 0, 12, 7}, 4.0f},
    {CAMERA_EQUAL_AREA, false, 9, 8, {0, 3, 5, 8}, 2.0f},
    {CAMERA_EQUAL_AREA, false, 2, 2, {0, 0, 2, 2}, 4.0f},
    {CAMERA_EQUIRECTANGULAR, false, 64, 32, {0, 0, 64, 32}, 0.5f},
    {CAMERA_EQUIRECTANGULAR, true, 12, 7, {0, 0, 12, 7}, 4.0f},
    {CAMERA_EQUIRECTANGULAR, false, 9, 8, {4, 0, 9, 5}, 2.0f},
    {CAMERA_EQUIRECTANGULAR, false, 2, 2, {0, 0, 2, 2}, 4.0f},
};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

static FrameParams setup(const SphericalCase *c)
{
    static const double ROTATED[12] = {0.6, 0.0, 0.8, 3.0, 0.0, 1.0, 0.0, -1.0, -0.8, 0.0, 0.6, 2.0};
    static const double SHEARED[12] = {1.2, 0.3, 0.4, 3.0, -0.2, 0.7, 0.1, -1.0, -0.8, 0.5, 2.0, 2.0};
    CameraSettings settings = {.kind = c->kind, .focal_distance = 1.0f};
    Error error = {0};
    memcpy(settings.world_from_camera, c->sheared ? SHEARED : ROTATED, sizeof ROTATED);
    settings.world_from_camera[15] = 1.0;
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

static Ray ray_at(const FrameParams *frame, Vec2 film)
{
    return spherical_ray(&frame->camera, film, (float)frame->film.width, (float)frame->film.height);
}

/* A film position that the filters of the crop window reach. */
static Vec2 reached(const FrameParams *frame, Vec2 u)
{
    float more = frame->film.filter.radius_x - 0.5f;
    float width = (float)(frame->film.crop_x1 - frame->film.crop_x0) + 2.0f * more;
    float height = (float)(frame->film.crop_y1 - frame->film.crop_y0) + 2.0f * more;
    return vec2((float)frame->film.crop_x0 - more + u.x * width, (float)frame->film.crop_y0 - more + u.y * height);
}

/* A film position is one of those of its direction; these are drawn equally often, and have the same direction. */
START_TEST(test_positions)
{
    enum { DRAWN = 1200 };
    FrameParams frame = setup(&CASES[_i]);
    for (uint i = 0; i < 200; ++i) {
        Vec2 film = reached(&frame, fixture_random(1, i));
        Ray ray = ray_at(&frame, film);
        Vec3 p = vec3_mad(ray.o, 1.0f + 9.0f * fixture_random(3, i).x, ray.d);
        int found = 0;
        CameraConnection c = {.copies = 0.0f};
        for (uint k = 0; k < DRAWN; ++k) {
            ck_assert(spherical_connect(&frame, p, fixture_random(20u + i, k).x, &c));
            TEST_TRUE(camera_film_covered(&frame, c.film));
            TEST_TRUE(vec3_length(vec3_sub(ray_at(&frame, c.film).d, ray.d)) < 2e-5f);
            TEST_TRUE(vec3_length(vec3_add(c.wi, ray.d)) < 5e-6f);
            found += hypot((double)(c.film.x - film.x), (double)(c.film.y - film.y)) < 1e-3;
        }
        double expected = DRAWN / (double)c.copies;
        ck_assert_msg(fabs(found - expected) <= 4.5 * sqrt(expected),
                      "case %d: (%g, %g) is found %d of %d times, of %g positions", _i, (double)film.x, (double)film.y,
                      found, DRAWN, (double)c.copies);
    }
}
END_TEST

/* The density is one over the solid angle of a unit of the film, times the squared distance and the crop's pixels. */
START_TEST(test_density)
{
    FrameParams frame = setup(&CASES[_i]);
    double pixels =
        (double)(frame.film.crop_x1 - frame.film.crop_x0) * (double)(frame.film.crop_y1 - frame.film.crop_y0);
    float h = 1e-3f * (float)frame.film.width;
    uint off = 0;
    for (uint i = 0; i < 2000; ++i) {
        Vec2 film = reached(&frame, fixture_random(1, i));
        Ray ray = ray_at(&frame, film);
        Vec3 dx = vec3_sub(ray_at(&frame, vec2(film.x + h, film.y)).d, ray_at(&frame, vec2(film.x - h, film.y)).d);
        Vec3 dy = vec3_sub(ray_at(&frame, vec2(film.x, film.y + h)).d, ray_at(&frame, vec2(film.x, film.y - h)).d);
        double angle = (double)vec3_length(vec3_cross(dx, dy)) / (4.0 * (double)h * (double)h);
        off += fabs((double)spherical_pdf(&frame, ray.d, 2.0f) * 4.0 * angle * pixels - 1.0) > 5e-3 ? 1u : 0u;
    }
    ck_assert_uint_lt(off, 60); /* differences across creases of the octahedron, and close to the poles */
}
END_TEST

/* Over all directions, the density of positions in the crop window integrates to one. */
START_TEST(test_integral)
{
    enum { N = 400 };
    FrameParams frame = setup(&CASES[_i]);
    double sum = 0.0;
    frame.film.filter.radius_x = frame.film.filter.radius_y = 0.5f;
    for (uint i = 0; i < N * N; ++i) {
        CameraConnection c;
        Vec3 d = warp_sphere(fixture_stratified(5, i, N));
        Vec3 p = vec3_mad(ray_at(&frame, vec2(0.0f, 0.0f)).o, 3.0f, d);
        if (spherical_connect(&frame, p, 0.5f, &c))
            sum += (double)(c.pdf * c.copies) * 9.0 * 4.0 * M_PI / ((double)N * N);
    }
    ck_assert_msg(fabs(sum - 1.0) < 5e-3, "case %d: the density integrates to %g", _i, sum);
}
END_TEST

static void direction_check(uint kind, float x, float y, Vec3 expected)
{
    CameraSettings settings = {.kind = kind, .focal_distance = 1.0f};
    Error error = {0};
    Camera camera;
    for (int i = 0; i < 4; ++i)
        settings.world_from_camera[5 * i] = settings.camera_from_world[5 * i] = 1.0;
    ck_assert(camera_setup(&settings, 100, 50, &camera, &error));
    Vec3 d = spherical_ray(&camera, vec2(100.0f * x, 50.0f * y), 100.0f, 50.0f).d;
    ck_assert_msg(vec3_length(vec3_sub(d, expected)) < 1e-6f, "kind %u, (%g, %g): (%g, %g, %g)", kind, (double)x,
                  (double)y, (double)d.x, (double)d.y, (double)d.z);
}

/* y is the axis of both maps. */
START_TEST(test_conventions)
{
    direction_check(CAMERA_EQUAL_AREA, 0.5f, 0.5f, vec3(0.0f, 1.0f, 0.0f));
    direction_check(CAMERA_EQUAL_AREA, 1.0f, 0.5f, vec3(1.0f, 0.0f, 0.0f));
    direction_check(CAMERA_EQUAL_AREA, 0.5f, 1.0f, vec3(0.0f, 0.0f, 1.0f));
    direction_check(CAMERA_EQUAL_AREA, 0.0f, 1.0f, vec3(0.0f, -1.0f, 0.0f));
    direction_check(CAMERA_EQUIRECTANGULAR, 0.0f, 0.5f, vec3(1.0f, 0.0f, 0.0f));
    direction_check(CAMERA_EQUIRECTANGULAR, 0.25f, 0.5f, vec3(0.0f, 0.0f, 1.0f));
    direction_check(CAMERA_EQUIRECTANGULAR, 0.75f, 0.5f, vec3(0.0f, 0.0f, -1.0f));
    direction_check(CAMERA_EQUIRECTANGULAR, 0.3f, 0.0f, vec3(0.0f, 1.0f, 0.0f));
    direction_check(CAMERA_EQUIRECTANGULAR, 1.25f, 0.5f, vec3(0.0f, 0.0f, 1.0f));
    direction_check(CAMERA_EQUIRECTANGULAR, 0.75f, 1.5f, vec3(0.0f, 0.0f, 1.0f)); /* past the lower pole */
}
END_TEST

TCase *emit_spherical_case(void)
{
    TCase *tcase = tcase_create("spherical camera");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_positions, 0, CASE_COUNT);
    tcase_add_loop_test(tcase, test_density, 0, CASE_COUNT);
    tcase_add_loop_test(tcase, test_integral, 0, CASE_COUNT);
    tcase_add_test(tcase, test_conventions);
    return tcase;
}
