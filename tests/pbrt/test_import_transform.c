/* Transforms: the matrix of each directive, observed through the position of a sphere's centre or a triangle. */
#include "pbrt/test_import.h"

#include "base/matrix.h"

#include <string.h>

static void assert_matrix(const Matrix *m, const double wanted[16])
{
    for (int i = 0; i < 16; ++i)
        ck_assert_double_eq_tol(m->m[i], wanted[i], 1e-12);
}

START_TEST(elementary_matrices)
{
    static const double Y90[3] = {0, 2, 0};
    Matrix t = matrix_translate(1, 2, 3), s = matrix_scale(4, 5, 6), r = matrix_rotate(90, Y90);
    assert_matrix(&t, (const double[16]){1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1});
    assert_matrix(&s, (const double[16]){4, 0, 0, 0, 0, 5, 0, 0, 0, 0, 6, 0, 0, 0, 0, 1});
    assert_matrix(&r, (const double[16]){0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1});
    Matrix ts = matrix_multiply(&t, &s);
    assert_matrix(&ts, (const double[16]){4, 0, 0, 1, 0, 5, 0, 2, 0, 0, 6, 3, 0, 0, 0, 1});
}
END_TEST

START_TEST(rotation_axes)
{
    static const double AXES[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    /* About x, y goes to z; about y, z to x; about z, x to y. */
    for (int k = 0; k < 3; ++k) {
        Matrix r = matrix_rotate(90, AXES[k]);
        double out[3];
        matrix_vector(&r, AXES[(k + 1) % 3], out);
        for (int i = 0; i < 3; ++i)
            ck_assert_double_eq_tol(out[i], AXES[(k + 2) % 3][i], 1e-12);
    }
}
END_TEST

START_TEST(inverses)
{
    uint64_t state = 7;
    for (int n = 0; n < 200; ++n) {
        Matrix m = matrix_identity(), inverse;
        for (int i = 0; i < 12; ++i) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            m.m[i] = (double)(int32_t)(state >> 32) * 0x1p-28;
        }
        if (!matrix_inverse(&m, &inverse))
            continue;
        Matrix product = matrix_multiply(&m, &inverse), identity = matrix_identity();
        for (int i = 0; i < 16; ++i)
            ck_assert_double_eq_tol(product.m[i], identity.m[i], 1e-9);
    }
    Matrix flat = matrix_scale(1, 0, 1), out;
    ck_assert(!matrix_inverse(&flat, &out));
    Matrix mirror = matrix_scale(1, -1, 1);
    ck_assert(matrix_swaps_handedness(&mirror));
}
END_TEST

START_TEST(look_at_is_left_handed)
{
    Matrix m;
    static const double EYE[3] = {0, 0, -5}, LOOK[3] = {0, 0, 0}, UP[3] = {0, 1, 0};
    ck_assert(matrix_look_at(EYE, LOOK, UP, &m));
    /* From -z toward the origin: x right, y up, depth along z; no axis changes sign. */
    assert_matrix(&m, (const double[16]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5, 0, 0, 0, 1});
    static const double UP_TILTED[3] = {0, 3, 1};
    ck_assert(matrix_look_at(EYE, LOOK, UP_TILTED, &m));
    assert_matrix(&m, (const double[16]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5, 0, 0, 0, 1});
}
END_TEST

/* The positions of (0,0,0), (1,0,0) and (0,1,0) after the directives, in coordinates of the file. */
static void triangle_positions(const char *directives, Vec3 out[3])
{
    char text[1024];
    Scene scene;
    snprintf(text, sizeof text, "%s Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]", directives);
    import_world(text, &scene);
    ck_assert_uint_eq(scene.positions.count, 3);
    for (size_t i = 0; i < 3; ++i)
        out[i] = vec3_add(ELEMENT(&scene, positions, Vec3, i), scene.origin);
    scene_destroy(&scene);
}

/* A distant world is moved before its points are rounded, and messages are not repeated by the second reading. */
START_TEST(far_world_is_moved)
{
    Scene scene;
    Error error = {{0}, {0}};
    import_text(
        "LookAt 100000 0 -4 100000 0 0 0 1 0 Camera \"perspective\" WorldBegin Translate 100000 0 0\n"
        "LightSource \"point\" \"point3 from\" [ 0.001 0.5 0.5 ]\n"
        "Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
        "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 0.001 1 0 1 -1 0 ] \"integer indices\" [ 0 1 2 1 1 3 ]\n"
        "Shape \"sphere\" \"float radius\" 0.5\nIdentity ObjectBegin \"o\" Shape \"disk\" ObjectEnd\n"
        "Translate 100000 0 0 Translate 0.001 0 0 ObjectInstance \"o\"",
        &scene);
    const char *log = import_log(), *said = strstr(log, "of zero area");
    ck_assert_ptr_nonnull(said);
    ck_assert_ptr_null(strstr(said + 1, "of zero area"));
    ck_assert_uint_eq(scene.counts.degenerate_triangles, 1);
    assert_vec3(scene.origin, 100000, 0, 0, 0.0f);
    assert_vec3(ELEMENT(&scene, positions, Vec3, 2), 0.001f, 1, 0, 1e-9f);
    assert_vec3(ELEMENT(&scene, light_details, LightDetail, 0).position, 0.001f, 0.5f, 0.5f, 1e-9f);
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 0).center, 0, 0, 0, 0.0f);
    ASSERT_FLOAT(ELEMENT(&scene, quadrics, Quadric, 1).center.x, 0.0f); /* within the object: not moved */
    ASSERT_NEAR(ELEMENT(&scene, instances, Instance, 0).world_from_object.m[3], 0.001f, 1e-9f);
    ASSERT_FLOAT(ELEMENT(&scene, texture_ops, TextureOp, 2).texture_from_world.m[3], 0.0f);
    ck_assert_double_eq(scene.camera_settings.world_from_camera[3], 0.0);
    ck_assert_double_eq(scene.camera_settings.camera_from_world[3], 0.0);
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    ASSERT_FLOAT(scene.bounds_min[0], 99999.0f);
    ASSERT_FLOAT(scene.bounds_max[0], 100001.0f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(directives_compose)
{
    static const struct {
        const char *directives;
        float p[3][3];
    } cases[] = {
        {"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
        {"Translate 1 2 3 Scale 2 3 4", {{1, 2, 3}, {3, 2, 3}, {1, 5, 3}}},
        {"Scale 2 3 4 Translate 1 2 3", {{2, 6, 12}, {4, 6, 12}, {2, 9, 12}}},
        {"Rotate 90 0 0 1", {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}}},
        {"Translate 5 5 5 Identity", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
        {"Translate 5 0 0 Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 7 8 9 1 ]", {{7, 8, 9}, {8, 8, 9}, {7, 9, 9}}},
        {"Translate 5 0 0 ConcatTransform [ 0 2 0 0 1 0 0 0 0 0 1 0 7 8 9 1 ]", {{12, 8, 9}, {12, 10, 9}, {13, 8, 9}}},
        {"Transform [ 2 0 0 0 0 2 0 0 0 0 2 0 2 4 6 2 ]", {{1, 2, 3}, {2, 2, 3}, {1, 3, 3}}},
        {"LookAt 0 0 -5 0 0 0 0 1 0", {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}}},
        {"AttributeBegin Translate 1 1 1 AttributeEnd", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
        {"TransformBegin Translate 1 1 1 TransformEnd", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
        {"Translate 1 0 0 CoordinateSystem \"a\" Identity CoordSysTransform \"a\"", {{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}},
        {"Translate 1 0 0 CoordSysTransform \"world\"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
        {"ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 1 0 0 ActiveTransform All",
         {{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Vec3 p[3];
        triangle_positions(cases[i].directives, p);
        for (int k = 0; k < 3; ++k)
            assert_vec3(p[k], cases[i].p[k][0], cases[i].p[k][1], cases[i].p[k][2], 1e-5f);
    }
}
END_TEST

START_TEST(camera_transform)
{
    Scene scene;
    import_text("LookAt 1 2 3  1 2 4  0 1 0 Camera \"perspective\" WorldBegin\n"
                "CoordSysTransform \"camera\" Shape \"sphere\"",
                &scene);
    const CameraSettings *camera = &scene.camera_settings;
    ck_assert_double_eq_tol(camera->camera_from_world[3], -1.0, 1e-12);
    ck_assert_double_eq_tol(camera->camera_from_world[11], -3.0, 1e-12);
    ck_assert_double_eq_tol(camera->world_from_camera[3], 1.0, 1e-12);
    ck_assert_double_eq_tol(camera->world_from_camera[7], 2.0, 1e-12);
    /* "camera" is camera space: a sphere there is centred at the eye. */
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 0).center, 1, 2, 3, 1e-6f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(world_begin_resets)
{
    Scene scene;
    import_text("Translate 9 9 9 ActiveTransform EndTime Camera \"perspective\" WorldBegin Shape \"sphere\"", &scene);
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 0).center, 0, 0, 0, 0.0f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(motion_is_refused_or_frozen)
{
    static const char MOVING[] = "WorldBegin Translate 1 0 0 ActiveTransform EndTime Translate 5 0 0 Shape \"sphere\"";
    Scene scene;
    ck_assert_str_eq(import_error(MOVING),
                     "test.pbrt:1:68: error: motion (a transform that differs between StartTime and EndTime) is not "
                     "supported");
    import_text_in(MOVING, "", true, &scene);
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 0).center, 1, 0, 0, 0.0f);
    ck_assert_uint_eq(scene.counts.substitutions, 1);
    scene_destroy(&scene);
}
END_TEST

TCase *import_transform_case(void)
{
    TCase *tcase = tcase_create("transform");
    tcase_add_test(tcase, elementary_matrices);
    tcase_add_test(tcase, rotation_axes);
    tcase_add_test(tcase, inverses);
    tcase_add_test(tcase, look_at_is_left_handed);
    tcase_add_test(tcase, far_world_is_moved);
    tcase_add_test(tcase, directives_compose);
    tcase_add_test(tcase, camera_transform);
    tcase_add_test(tcase, world_begin_resets);
    tcase_add_test(tcase, motion_is_refused_or_frozen);
    return tcase;
}
