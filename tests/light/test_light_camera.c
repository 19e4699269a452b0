/* Cameras: rays against a model in double and known properties of pbrt-v4, and projection as their inverse. */
#include "camera/camera.h"
#include "light/test_light.h"
#include "scene/camera_setup.h"
#include "support/light_fixture.h"
#include "support/test_files.h"

/* As pbrt's LookAt would make it: a left-handed frame of scale 1. Row-major world from camera. */
static const double WORLD_FROM_CAMERA[16] = {0.6, 0.0, 0.8, 3.0, 0.0, 1.0, 0.0, -1.0, -0.8, 0.0, 0.6, 2.0, 0, 0, 0, 1};

static CameraSettings settings_identity(uint kind, float fov)
{
    CameraSettings settings = {.kind = kind, .fov = fov, .focal_distance = 1e6f};
    for (int i = 0; i < 4; ++i)
        settings.world_from_camera[5 * i] = settings.camera_from_world[5 * i] = 1.0;
    return settings;
}

static CameraSettings settings_placed(uint kind, float fov)
{
    CameraSettings settings = settings_identity(kind, fov);
    memcpy(settings.world_from_camera, WORLD_FROM_CAMERA, sizeof WORLD_FROM_CAMERA);
    test_matrix_inverse(settings.world_from_camera, settings.camera_from_world);
    return settings;
}

static Camera make_camera(const CameraSettings *settings, int width, int height)
{
    Camera camera;
    Error error = {0};
    ck_assert_msg(camera_setup(settings, width, height, &camera, &error), "%s", error.message);
    return camera;
}

static void assert_direction(Ray ray, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    ck_assert_double_eq_tol((double)ray.d.x, x / length, 1e-6);
    ck_assert_double_eq_tol((double)ray.d.y, y / length, 1e-6);
    ck_assert_double_eq_tol((double)ray.d.z, z / length, 1e-6);
}

static const Vec2 MIDDLE = {0.5f, 0.5f};

START_TEST(test_perspective)
{
    /* fov 90 spans the shorter side: on a film of 200 x 100 the edges are at y = +-1, x = +-2; raster y points down. */
    CameraSettings settings = settings_identity(CAMERA_PERSPECTIVE, 90.0f);
    Camera camera = make_camera(&settings, 200, 100);
    assert_direction(camera_ray(&camera, vec2(100, 50), 200, 100, MIDDLE), 0, 0, 1);
    assert_direction(camera_ray(&camera, vec2(0, 0), 200, 100, MIDDLE), -2, 1, 1);
    assert_direction(camera_ray(&camera, vec2(200, 100), 200, 100, MIDDLE), 2, -1, 1);
    camera = make_camera(&settings, 100, 200);
    assert_direction(camera_ray(&camera, vec2(0, 0), 100, 200, MIDDLE), -1, 2, 1);
    settings.fov = 60.0f;
    camera = make_camera(&settings, 100, 100);
    assert_direction(camera_ray(&camera, vec2(100, 50), 100, 100, MIDDLE), tan(M_PI / 6.0), 0, 1);
    /* A frame aspect ratio squeezes the image; a screen window overrides it. */
    settings.fov = 90.0f;
    settings.frame_aspect = 0.5f;
    camera = make_camera(&settings, 100, 100);
    assert_direction(camera_ray(&camera, vec2(0, 0), 100, 100, MIDDLE), -1, 2, 1);
    settings.has_screen_window = true;
    const float window[4] = {-0.25f, 0.75f, 0.5f, 1.0f};
    memcpy(settings.screen_window, window, sizeof window);
    camera = make_camera(&settings, 100, 100);
    assert_direction(camera_ray(&camera, vec2(0, 0), 100, 100, MIDDLE), -0.25, 1.0, 1);
    assert_direction(camera_ray(&camera, vec2(100, 100), 100, 100, MIDDLE), 0.75, 0.5, 1);
}
END_TEST

START_TEST(test_orthographic)
{
    CameraSettings settings = settings_placed(CAMERA_ORTHOGRAPHIC, 90.0f);
    Camera camera = make_camera(&settings, 300, 100);
    Ray ray = camera_ray(&camera, vec2(0, 100), 300, 100, MIDDLE);
    assert_direction(ray, 0.8, 0.0, 0.6);
    /* (-3, -1, 0) in camera space. */
    ck_assert_double_eq_tol((double)ray.o.x, 3.0 - 3.0 * 0.6, 1e-6);
    ck_assert_double_eq_tol((double)ray.o.y, -2.0, 1e-6);
    ck_assert_double_eq_tol((double)ray.o.z, 2.0 + 3.0 * 0.8, 1e-6);
}
END_TEST

/* All rays of a film position meet in the plane of focus where the pinhole's ray intersects it; their origins fill the
 * lens. */
START_TEST(test_lens)
{
    for (uint kind = CAMERA_PERSPECTIVE; kind <= CAMERA_ORTHOGRAPHIC; ++kind) {
        CameraSettings settings = settings_placed(kind, 50.0f);
        Camera pinhole = make_camera(&settings, 160, 120);
        settings.lens_radius = 0.3f;
        settings.focal_distance = 7.0f;
        Camera camera = make_camera(&settings, 160, 120);
        double inside_half = 0.0, count = 4096.0;
        for (uint i = 0; i < 4096; ++i) {
            Vec2 film = vec2(160.0f * fixture_random(1, i / 64).x, 120.0f * fixture_random(1, i / 64).y);
            Ray sharp = camera_ray(&pinhole, film, 160, 120, MIDDLE);
            Ray ray = camera_ray(&camera, film, 160, 120, fixture_random(2, i));
            Vec3 o = affine_point(camera.camera_from_world, ray.o), d = affine_vector(camera.camera_from_world, ray.d);
            Vec3 so = affine_point(camera.camera_from_world, sharp.o);
            Vec3 sd = affine_vector(camera.camera_from_world, sharp.d);
            Vec3 focus = vec3_mad(o, (7.0f - o.z) / d.z, d), wanted = vec3_mad(so, (7.0f - so.z) / sd.z, sd);
            ck_assert_double_lt((double)vec3_length(vec3_sub(focus, wanted)), 1e-5);
            double r = (double)vec3_length(vec3_sub(o, so));
            ck_assert_double_lt(r, 0.3 + 1e-5);
            inside_half += r < 0.15;
        }
        /* a quarter of the lens; five standard deviations */
        ck_assert_double_lt(fabs(inside_half / count - 0.25), 5.0 * sqrt(0.25 * 0.75 / count));
    }
}
END_TEST

/* Against the model in double, for random film positions and cameras far from the origin. */
START_TEST(test_double_model)
{
    CameraSettings settings = settings_placed(CAMERA_PERSPECTIVE, 35.0f);
    Camera camera = make_camera(&settings, 1920, 1080);
    double scale = tan(35.0 * M_PI / 360.0), worst = 0.0;
    for (uint i = 0; i < 10000; ++i) {
        Vec2 film = fixture_random(6, i);
        film = vec2(film.x * 1920.0f, film.y * 1080.0f);
        double x = (2.0 * (double)film.x / 1920.0 - 1.0) * scale * 16.0 / 9.0;
        double y = (1.0 - 2.0 * (double)film.y / 1080.0) * scale, length = sqrt(x * x + y * y + 1.0), d[3];
        for (int k = 0; k < 3; ++k)
            d[k] = (WORLD_FROM_CAMERA[4 * k] * x + WORLD_FROM_CAMERA[4 * k + 1] * y + WORLD_FROM_CAMERA[4 * k + 2]) /
                   length;
        Ray ray = camera_ray(&camera, film, 1920, 1080, MIDDLE);
        worst = fmax(worst, fabs((double)ray.d.x - d[0]));
        worst = fmax(worst, fabs((double)ray.d.y - d[1]));
        worst = fmax(worst, fabs((double)ray.d.z - d[2]));
    }
    ck_assert_double_lt(worst, 3e-7);
}
END_TEST

static FrameParams whole_film(const Camera *camera, uint width, uint height)
{
    return (FrameParams){.camera = *camera,
                         .film.filter = {.kind = PIXEL_FILTER_BOX, .radius_x = 0.5f, .radius_y = 0.5f, .weight = 1.0f},
                         .film.width = width,
                         .film.height = height,
                         .film.crop_x1 = width,
                         .film.crop_y1 = height};
}

START_TEST(test_projection)
{
    for (uint kind = CAMERA_PERSPECTIVE; kind <= CAMERA_ORTHOGRAPHIC; ++kind)
        for (int lens = 0; lens < 2; ++lens) {
            CameraSettings settings = settings_placed(kind, 50.0f);
            settings.lens_radius = lens ? 0.3f : 0.0f;
            settings.focal_distance = 7.0f;
            Camera camera = make_camera(&settings, 160, 120);
            FrameParams frame = whole_film(&camera, 160, 120);
            double worst = 0.0;
            for (uint i = 0; i < 4096; ++i) {
                Vec2 r = fixture_random(1, i), u = fixture_random(2, i);
                Vec2 film = vec2(0.1f + 159.8f * r.x, 0.1f + 119.8f * r.y);
                Ray ray = camera_ray(&camera, film, 160, 120, u);
                Vec3 p = vec3_mad(ray.o, 1.0f + 9.0f * fixture_random(3, i).x, ray.d);
                CameraConnection found;
                TEST_TRUE(camera_connect(&frame, p, u, &found));
                worst = fmax(worst, hypot((double)(found.film.x - film.x), (double)(found.film.y - film.y)));
                TEST_TRUE(!camera_connect(&frame, vec3_mad(ray.o, -1.0f, ray.d), u, &found));
            }
            ck_assert_msg(worst < 1e-4, "kind %u lens %d: %g pixels off", kind, lens, worst);
        }
}
END_TEST

/* The camera matrices in an image's header project points on a pixel's ray back to that pixel, also if camera space is
 * scaled and the importer has moved the scene. */
START_TEST(test_matrices)
{
    static const double SCALES[] = {1.0, 1e-13, 37.0};
    const uint kind = _i % 2 ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE;
    const double scale = SCALES[_i / 2];
    const Vec3 origin = vec3(12.0f, -7.0f, 3.0f);
    CameraSettings settings = settings_placed(kind, 70.0f);
    for (int i = 0; i < 12; ++i) {
        settings.camera_from_world[i] *= scale;
        settings.world_from_camera[i] /= i % 4 < 3 ? scale : 1.0;
    }
    Camera camera = make_camera(&settings, 200, 100);
    float view[16], ndc[16];
    camera_matrices(&settings, &camera, origin, view, ndc);
    unsigned state = 5;
    for (int k = 0; k < 100; ++k) {
        Vec2 film = vec2(200.0f * (float)test_random_unit(&state), 100.0f * (float)test_random_unit(&state));
        Ray ray = camera_ray(&camera, film, 200, 100, MIDDLE);
        Vec3 at = vec3_add(vec3_mad(ray.o, 1.0f + 8.0f * (float)test_random_unit(&state), ray.d), origin);
        const double p[4] = {(double)at.x, (double)at.y, (double)at.z, 1.0};
        double q[4] = {0.0}, z = 0.0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                q[i] += (double)ndc[4 * i + j] * p[j];
        for (int j = 0; j < 4; ++j)
            z += (double)view[8 + j] * p[j];
        ck_assert_double_eq_tol(q[0] / q[3], (double)film.x / 200.0, 2e-5);
        ck_assert_double_eq_tol(q[1] / q[3], (double)film.y / 100.0, 2e-5);
        ck_assert(z > 0.0 || (kind == CAMERA_ORTHOGRAPHIC && scale < 1.0)); /* the window is 10^13 wide */
    }
}
END_TEST

START_TEST(test_outside_film)
{
    CameraSettings settings = settings_identity(CAMERA_PERSPECTIVE, 90.0f);
    Camera camera = make_camera(&settings, 100, 100);
    FrameParams frame = whole_film(&camera, 100, 100);
    CameraConnection c;
    ck_assert(camera_connect(&frame, vec3(-0.99f, 0.99f, 1.0f), MIDDLE, &c));
    ck_assert(!camera_connect(&frame, vec3(-1.01f, 0.0f, 1.0f), MIDDLE, &c));
    ck_assert(!camera_connect(&frame, vec3(0.0f, 1.01f, 1.0f), MIDDLE, &c));
    ck_assert(!camera_connect(&frame, vec3(0.0f, 0.0f, 0.0f), MIDDLE, &c));
}
END_TEST

/* A film position is covered if and only if the filter of some pixel in the crop window reaches it. */
START_TEST(test_reach)
{
    FrameParams frame = {.film.crop_x0 = 20, .film.crop_x1 = 26, .film.crop_y0 = 30, .film.crop_y1 = 33};
    for (int narrow = 0; narrow < 2; ++narrow) {
        frame.film.filter.radius_x = narrow ? 0.75f : 2.5f;
        frame.film.filter.radius_y = narrow ? 3.25f : 0.5f;
        for (int i = 0; i < 200 * 200; ++i) {
            double x = 15.0 + 16.1 * (i % 200 + 0.5) / 200.0, y = 25.0 + 13.0 * (i / 200 + 0.5) / 200.0;
            bool reached_x = false, reached_y = false;
            for (uint pixel = 20; pixel < 26; ++pixel)
                reached_x = reached_x || fabs(x - pixel - 0.5) < (double)frame.film.filter.radius_x;
            for (uint pixel = 30; pixel < 33; ++pixel)
                reached_y = reached_y || fabs(y - pixel - 0.5) < (double)frame.film.filter.radius_y;
            TEST_TRUE(camera_film_covered(&frame, vec2((float)x, (float)y)) == (reached_x && reached_y));
        }
    }
}
END_TEST

/* A camera far from the origin sees a point exactly where a camera at the origin sees the same point relative to it:
 * positions and differences are exactly representable here, so that nothing is rounded before the rotation. */
START_TEST(test_far)
{
    CameraSettings settings = settings_placed(CAMERA_PERSPECTIVE, 90.0f);
    const double place[3] = {0x1p20, -0x1p19, 0x1p20};
    Camera cameras[2];
    for (int far = 0; far < 2; ++far) {
        for (int i = 0; i < 3; ++i)
            settings.world_from_camera[4 * i + 3] = far ? place[i] : 0.0;
        test_matrix_inverse(settings.world_from_camera, settings.camera_from_world);
        cameras[far] = make_camera(&settings, 100, 100);
    }
    FrameParams near_frame = whole_film(&cameras[0], 100, 100), far_frame = whole_film(&cameras[1], 100, 100);
    for (int i = 0; i < 1000; ++i) {
        Vec3 p = vec3((float)(i % 10) - 4.0f, (float)(i / 10 % 10) - 5.0f, (float)(i / 100) + 1.0f);
        Vec3 moved = vec3(p.x + (float)place[0], p.y + (float)place[1], p.z + (float)place[2]);
        CameraConnection near_one, far_one;
        bool seen = camera_connect(&near_frame, p, MIDDLE, &near_one);
        ck_assert(camera_connect(&far_frame, moved, MIDDLE, &far_one) == seen);
        TEST_TRUE(!seen || (near_one.film.x == far_one.film.x && near_one.film.y == far_one.film.y));
    }
}
END_TEST

static void assert_refused(CameraSettings settings, const char *word)
{
    Camera camera;
    Error error = {0};
    ck_assert(!camera_setup(&settings, 10, 10, &camera, &error));
    ck_assert_msg(strstr(error.message, word) != NULL && error.fix[0] != '\0', "%s", error.message);
}

START_TEST(test_bad_settings)
{
    CameraSettings good = settings_identity(CAMERA_PERSPECTIVE, 45.0f), s = good;
    s.fov = 180.0f;
    assert_refused(s, "field of view");
    s.fov = NAN;
    assert_refused(s, "field of view");
    s = good;
    s.frame_aspect = -1.0f;
    assert_refused(s, "aspect");
    s = good;
    s.has_screen_window = true;
    assert_refused(s, "screen window");
    s = good;
    s.lens_radius = -0.1f;
    assert_refused(s, "lens radius");
    s.lens_radius = 0.1f;
    s.focal_distance = 0.0f;
    assert_refused(s, "focal distance");
    s = good;
    s.world_from_camera[3] = (double)INFINITY;
    assert_refused(s, "transformation");
}
END_TEST

TCase *camera_case(void)
{
    TCase *tcase = tcase_create("camera");
    tcase_add_test(tcase, test_perspective);
    tcase_add_test(tcase, test_orthographic);
    tcase_add_test(tcase, test_lens);
    tcase_add_test(tcase, test_double_model);
    tcase_add_test(tcase, test_projection);
    tcase_add_test(tcase, test_outside_film);
    tcase_add_test(tcase, test_reach);
    tcase_add_test(tcase, test_far);
    tcase_add_loop_test(tcase, test_matrices, 0, 6);
    tcase_add_test(tcase, test_bad_settings);
    return tcase;
}
