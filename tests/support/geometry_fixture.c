#include "support/geometry_fixture.h"

#include "math/warp.h"

#include <string.h>

float random_unit(TestRandom *random)
{
    Random4 four = random_four(random->next++, 0u, 0u, 0u, random->seed, 0x67656f6du);
    return random_float(four.x[0]);
}

float random_between(TestRandom *random, float low, float high)
{
    return low + (high - low) * random_unit(random);
}

Vec3 random_direction(TestRandom *random)
{
    float x = random_unit(random), y = random_unit(random);
    return warp_sphere(vec2(x, y));
}

uint random_below(TestRandom *random, uint n)
{
    return (uint)(random_unit(random) * (float)n) % n;
}

/* ---- meshes ------------------------------------------------------------------------------------------------------ */

TestMesh mesh_create(size_t vertices, size_t triangles)
{
    TestMesh mesh = {.positions = calloc(vertices, sizeof(Vec3)), .indices = calloc(3 * triangles, sizeof(uint))};
    ck_assert(mesh.positions && mesh.indices);
    return mesh;
}

void mesh_destroy(TestMesh *mesh)
{
    free(mesh->positions);
    free(mesh->indices);
    *mesh = (TestMesh){0};
}

uint mesh_vertex(TestMesh *mesh, Vec3 p)
{
    mesh->positions[mesh->vertex_count] = p;
    return (uint)mesh->vertex_count++;
}

void mesh_triangle(TestMesh *mesh, uint a, uint b, uint c)
{
    uint *out = mesh->indices + 3 * mesh->triangle_count++;
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

TestMesh mesh_star(uint rings, uint sectors, float rough, uint seed)
{
    TestRandom random = {.seed = seed};
    TestMesh mesh = mesh_create(2 + (size_t)(rings - 1) * sectors, 2 * (size_t)(rings - 1) * sectors);
    for (uint i = 1; i < rings; ++i)
        for (uint j = 0; j < sectors; ++j) {
            float theta = PI * (float)i / (float)rings, phi = 2.0f * PI * (float)j / (float)sectors;
            float r = 1.0f + rough * random_between(&random, -1.0f, 1.0f);
            mesh_vertex(&mesh, vec3(r * sinf(theta) * cosf(phi), r * sinf(theta) * sinf(phi), r * cosf(theta)));
        }
    uint north = mesh_vertex(&mesh, vec3(0.0f, 0.0f, 1.0f)), south = mesh_vertex(&mesh, vec3(0.0f, 0.0f, -1.0f));
    for (uint j = 0; j < sectors; ++j) {
        uint k = (j + 1) % sectors, last = (rings - 2) * sectors;
        mesh_triangle(&mesh, north, j, k);
        mesh_triangle(&mesh, last + j, south, last + k);
        for (uint i = 0; i + 2 < rings; ++i) {
            mesh_triangle(&mesh, i * sectors + j, (i + 1) * sectors + j, i * sectors + k);
            mesh_triangle(&mesh, i * sectors + k, (i + 1) * sectors + j, (i + 1) * sectors + k);
        }
    }
    return mesh;
}

TestMesh mesh_slivers(size_t count, float length, float width, uint seed)
{
    TestRandom random = {.seed = seed};
    TestMesh mesh = mesh_create(3 * count, count);
    for (size_t i = 0; i < count; ++i) {
        Vec3 p = vec3(random_between(&random, -1.0f, 1.0f), random_between(&random, -1.0f, 1.0f),
                      random_between(&random, -1.0f, 1.0f));
        Vec3 along = random_direction(&random), across = random_direction(&random);
        uint a = mesh_vertex(&mesh, vec3_mad(p, 0.5f * length, along));
        uint b = mesh_vertex(&mesh, vec3_mad(p, -0.5f * length, along));
        uint c = mesh_vertex(&mesh, vec3_mad(vec3_mad(p, 0.5f * length, along), width, across));
        mesh_triangle(&mesh, a, b, c);
    }
    return mesh;
}

static void mesh_grid(TestMesh *mesh, uint side, bool flipped)
{
    uint first = (uint)mesh->vertex_count;
    for (uint i = 0; i <= side; ++i)
        for (uint j = 0; j <= side; ++j)
            mesh_vertex(mesh, vec3(2.0f * (float)i / (float)side - 1.0f, 2.0f * (float)j / (float)side - 1.0f, 0.0f));
    for (uint i = 0; i < side; ++i)
        for (uint j = 0; j < side; ++j) {
            uint a = first + i * (side + 1) + j, b = a + 1, c = a + side + 1, d = c + 1;
            mesh_triangle(mesh, a, b, flipped ? c : d);
            mesh_triangle(mesh, flipped ? b : a, d, c);
        }
}

static void mesh_box(TestMesh *mesh)
{
    static const uint faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                     {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    uint v[8];
    for (uint k = 0; k < 8; ++k)
        v[k] = mesh_vertex(mesh, vec3(k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f, k & 4 ? 1.0f : -1.0f));
    for (uint f = 0; f < 6; ++f) {
        mesh_triangle(mesh, v[faces[f][0]], v[faces[f][1]], v[faces[f][2]]);
        mesh_triangle(mesh, v[faces[f][0]], v[faces[f][2]], v[faces[f][3]]);
    }
}

TestMesh mesh_coplanar(uint side, uint layers, uint seed)
{
    TestMesh mesh = mesh_create((size_t)layers * (side + 1) * (side + 1) + 8, (size_t)layers * 2 * side * side + 12);
    for (uint l = 0; l < layers; ++l)
        mesh_grid(&mesh, side, (l + seed) % 2 == 1);
    mesh_box(&mesh);
    return mesh;
}

void mesh_map(TestMesh *mesh, float scale, Vec3 shift)
{
    for (size_t i = 0; i < mesh->vertex_count; ++i)
        mesh->positions[i] = vec3_mad(shift, scale, mesh->positions[i]);
}

/* ---- scenes ------------------------------------------------------------------------------------------------------ */

static Shape shape_plain(uint flags)
{
    return (Shape){.alpha = NONE, .first_light = NONE, .flags = flags};
}

void test_scene_init(TestScene *test)
{
    Error error = {0};
    Material material = {.kind = MATERIAL_DIFFUSE,
                         .color0.program = NONE,
                         .color1.program = NONE,
                         .roughness_u.program = NONE,
                         .roughness_v.program = NONE,
                         .amount.program = NONE,
                         .displacement.program = NONE,
                         .normal_map = NONE,
                         .coat_table = NONE};
    LightData light = {
        .kind = LIGHT_POINT, .emission = {1.0f, 1.0f, 1.0f}, .detail.image = NONE, .detail.distribution = NONE};
    uint index;
    scene_init(&test->scene);
    ck_assert(scene_add_material(&test->scene, &material, &index, &error));
    ck_assert(scene_add_light(&test->scene, &light, &error));
}

void test_scene_mesh(TestScene *test, const TestMesh *mesh, uint flags)
{
    Error error = {0};
    MeshData data = {.positions = &mesh->positions[0].x,
                     .vertex_count = mesh->vertex_count,
                     .indices = mesh->indices,
                     .triangle_count = mesh->triangle_count};
    ck_assert_msg(scene_add_mesh(&test->scene, &data, shape_plain(flags), NULL, 0, &error), "%s", error.message);
}

void test_scene_quadric(TestScene *test, uint kind, Quadric quadric, const double world_from_object[16])
{
    Error error = {0};
    double inverse[16];
    test_matrix_inverse(world_from_object, inverse);
    const QuadricData data = {kind, quadric, world_from_object, inverse};
    ck_assert_msg(scene_add_quadric(&test->scene, &data, shape_plain(0), NULL, 0, &error), "%s", error.message);
}

void test_scene_quadrics(TestScene *test, TestRandom *random, uint count)
{
    for (uint i = 0; i < count; ++i) {
        double m[16];
        bool disk = i % 3 == 2;
        matrix_random(random, 0.2f, i % 2 == 0 ? 0.2f : 0.6f, true, vec3_scale(random_direction(random), 0.8f), m);
        Quadric quadric = {.radius = 0.5f, .z_min = -0.5f, .z_max = i % 4 == 1 ? 0.2f : 0.5f, .phi_max = 2.0f * PI};
        if (i % 5 == 1)
            quadric.phi_max = 4.0f;
        if (disk) {
            quadric.z_min = 0.1f;
            quadric.inner_radius = i % 2 == 0 ? 0.2f : 0.0f;
        }
        uint round = i % 6 == 4 || i % 6 == 1 ? PRIMITIVE_CYLINDER : PRIMITIVE_SPHERE;
        test_scene_quadric(test, disk ? PRIMITIVE_DISK : round, quadric, m);
    }
}

void test_scene_curves(TestScene *test, const Curve *curves, size_t count, uint levels, uint type)
{
    Error error = {0};
    const CurveData data = {.curves = curves, .count = count, .levels = levels, .type = type};
    ck_assert_msg(scene_add_curves(&test->scene, &data, shape_plain(0), &error), "%s", error.message);
}

void test_scene_curves_random(TestScene *test, TestRandom *random, uint count)
{
    for (uint i = 0; i < count; ++i) {
        Vec3 center = vec3_scale(random_direction(random), 0.8f * random_unit(random));
        Curve curve = {.width = {random_between(random, 0.01f, 0.1f), i % 3 == 0 ? 0.0f : 0.05f}};
        for (uint k = 0; k < 4; ++k)
            curve.p[k] = vec3_mad(center, random_between(random, 0.2f, 1.0f), random_direction(random));
        if (i % 7 == 0)
            curve.p[1] = curve.p[2];
        if (i % 11 == 0)
            curve.p[1] = curve.p[0];
        test_scene_curves(test, &curve, 1, i % 4, i % 2 == 0 ? CURVE_FLAT : CURVE_ROUND);
    }
}

void test_scene_instances(TestScene *test, TestRandom *random, uint object, uint count, float size)
{
    Error error = {0};
    for (uint i = 0; i < count; ++i) {
        double m[16], inverse[16];
        matrix_random(random, 0.3f * size, size, true, vec3_scale(random_direction(random), 2.5f), m);
        test_matrix_inverse(m, inverse);
        ck_assert(scene_add_instance(&test->scene, object, m, inverse, &error));
    }
}

void test_scene_finish(TestScene *test)
{
    Error error = {0};
    Scene *scene = &test->scene;
    ck_assert_msg(scene_finish(scene, &error), "%s", error.message);
    /* Not needed by any material here, but by the tests. */
    scene_features_set(scene, scene->features | FEATURE_TANGENTS | FEATURE_TEXTURE);
    test->backend = scene_backend_view(scene);
    test->view = scene_view(test->backend.frame, test->backend.geometry, test->backend.tables, test->backend.texels);
}

void test_scene_destroy(TestScene *test)
{
    scene_destroy(&test->scene);
}

void matrix_random(TestRandom *random, float low, float high, bool mirror, Vec3 shift, double out[16])
{
    Frame frame = frame_from_normal(random_direction(random));
    const Vec3 columns[3] = {frame.t, frame.b, frame.n};
    const float shifts[3] = {shift.x, shift.y, shift.z};
    memset(out, 0, 16 * sizeof *out);
    for (int j = 0; j < 3; ++j) {
        float scale = random_between(random, low, high);
        scale = mirror && random_unit(random) < 0.5f ? -scale : scale;
        const float column[3] = {columns[j].x, columns[j].y, columns[j].z};
        for (int i = 0; i < 3; ++i)
            out[4 * i + j] = (double)(column[i] * scale);
    }
    for (int i = 0; i < 3; ++i)
        out[4 * i + 3] = (double)shifts[i];
    out[15] = 1.0;
}

/* ---- the reference ----------------------------------------------------------------------------------------------- */

static void brute_force_object(const TestScene *test, uint object, uint instance, const RayQuery *query, Hit *best)
{
    Object record = test->view.objects[object];
    for (uint i = 0; i < record.primitive_count; ++i)
        primitive_intersect(&test->view, record.first_primitive + i, instance, query, best);
}

Hit brute_force(const TestScene *test, const Ray *ray)
{
    RayQuery query = ray_query(*ray);
    Hit best = hit_none(ray->t_max);
    brute_force_object(test, 0, NONE, &query, &best);
    for (uint i = 0; i < test->backend.instance_count; ++i) {
        RayQuery inner = ray_query_transform(test->view.instances[i].object_from_world, &query);
        brute_force_object(test, test->view.instances[i].object, i, &inner, &best);
    }
    return best;
}

bool triangle_intersect(Vec3 a, Vec3 b, Vec3 c, const Ray *ray, float *t, float *u, float *v)
{
    RayQuery query = ray_query(*ray);
    Hit hit = {0};
    bool found = triangle_query(a, b, c, &query, &hit);
    *t = hit.t;
    *u = hit.u;
    *v = hit.v;
    return found;
}

bool hit_same(const Hit *a, const Hit *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}
