#include "geometry/bvh_scenes.h"

/* ---- parts ------------------------------------------------------------------------------------------------------- */

static void add_mesh(TestScene *test, TestMesh mesh, float scale, Vec3 shift)
{
    mesh_map(&mesh, scale, shift);
    test_scene_mesh(test, &mesh, 0);
    mesh_destroy(&mesh);
}

/* Patches with four random corners each, hardly any of them planar. */
static void add_patches(TestScene *test, TestRandom *random, uint count)
{
    Error error = {0};
    Vec3 corners[4 * 64];
    uint indices[4 * 64];
    for (uint i = 0; i < count; ++i) {
        Vec3 middle = vec3_scale(random_direction(random), random_unit(random));
        for (uint k = 0; k < 4; ++k) {
            Vec3 corner = vec3(k & 1 ? 0.3f : -0.3f, k & 2 ? 0.3f : -0.3f, 0.0f);
            corners[4 * i + k] = vec3_add(middle, vec3_mad(corner, 0.15f, random_direction(random)));
            indices[4 * i + k] = 4 * i + k;
        }
    }
    MeshData data = {
        .positions = &corners[0].x, .vertex_count = 4 * count, .indices = indices, .triangle_count = count};
    Shape shape = {.alpha = NONE, .first_light = NONE};
    ck_assert_msg(scene_add_patches(&test->scene, &data, shape, NULL, 0, &error), "%s", error.message);
}

/* A checkered float texture with `count` squares per side: opaque ones, and ones that stop a fraction `alpha` of the
 * rays. */
static uint add_squares(TestScene *test, float count, float alpha)
{
    Error error = {0};
    uint first = (uint)test->scene.texture_ops.count;
    TextureOp *ops = array_grow(&test->scene.texture_ops, 4, &error);
    ck_assert_msg(ops != NULL, "%s", error.message);
    ops[0] = (TextureOp){.code = TEXTURE_CONSTANT, .value = {1.0f, 1.0f, 1.0f}, .scale = 1.0f};
    ops[1] = (TextureOp){.code = TEXTURE_CONSTANT, .value = {alpha, alpha, alpha}, .scale = 1.0f};
    ops[2] = (TextureOp){.code = TEXTURE_CHECKERBOARD, .mapping = MAPPING_UV, .uv_map = {count, count}};
    ops[3] = (TextureOp){.code = TEXTURE_END};
    return first;
}

/* A curtain of triangles with texture coordinates and the alpha texture `program`. */
static void add_curtain(TestScene *test, TestRandom *random, uint side, uint program)
{
    Error error = {0};
    TestMesh mesh = mesh_create((size_t)(side + 1) * (side + 1), 2 * (size_t)side * side);
    Vec2 *uvs = calloc((size_t)(side + 1) * (side + 1), sizeof *uvs);
    ck_assert(uvs != NULL);
    Frame frame = frame_from_normal(random_direction(random));
    for (uint i = 0; i <= side; ++i)
        for (uint j = 0; j <= side; ++j) {
            float u = (float)i / (float)side, v = (float)j / (float)side;
            Vec3 p = vec3(2.0f * u - 1.0f, 2.0f * v - 1.0f, 0.1f * sinf(9.0f * u) + 0.4f * random_unit(random));
            uvs[mesh.vertex_count] = vec2(u, v);
            mesh_vertex(&mesh, frame_to_world(frame, p));
        }
    for (uint i = 0; i < side; ++i)
        for (uint j = 0; j < side; ++j) {
            uint a = i * (side + 1) + j;
            mesh_triangle(&mesh, a, a + 1, a + side + 2);
            mesh_triangle(&mesh, a, a + side + 2, a + side + 1);
        }
    MeshData data = {.positions = &mesh.positions[0].x,
                     .uvs = &uvs[0].x,
                     .vertex_count = mesh.vertex_count,
                     .indices = mesh.indices,
                     .triangle_count = mesh.triangle_count};
    Shape shape = {.alpha = program, .first_light = NONE, .flags = SHAPE_HAS_UV};
    ck_assert_msg(scene_add_mesh(&test->scene, &data, shape, NULL, 0, &error), "%s", error.message);
    mesh_destroy(&mesh);
    free(uvs);
}

/* ---- scenes ------------------------------------------------------------------------------------------------------ */

static void make_star(TestScene *test)
{
    test_scene_init(test);
    add_mesh(test, mesh_star(9, 12, 0.3f, 1), 1.0f, vec3_splat(0.0f));
    test_scene_finish(test);
}

static void make_huge(TestScene *test)
{
    test_scene_init(test);
    add_mesh(test, mesh_star(400, 400, 0.01f, 2), 1.0f, vec3_splat(0.0f));
    test_scene_finish(test);
}

static void make_slivers(TestScene *test)
{
    test_scene_init(test);
    add_mesh(test, mesh_slivers(150, 1.5f, 1e-3f, 3), 1.0f, vec3_splat(0.0f));
    add_mesh(test, mesh_slivers(150, 2.0f, 1e-5f, 4), 1.0f, vec3(0.1f, 0.2f, -0.1f));
    add_mesh(test, mesh_star(5, 6, 0.2f, 6), 2.0f, vec3_splat(0.0f));
    test_scene_finish(test);
}

static void make_many_slivers(TestScene *test)
{
    test_scene_init(test);
    add_mesh(test, mesh_slivers(20000, 0.5f, 1e-4f, 5), 100.0f, vec3(3.0f, -50.0f, 1e3f));
    add_mesh(test, mesh_star(5, 6, 0.2f, 6), 200.0f, vec3(3.0f, -50.0f, 1e3f));
    test_scene_finish(test);
}

static void make_coplanar(TestScene *test)
{
    test_scene_init(test);
    add_mesh(test, mesh_coplanar(5, 6, 5), 0.7f, vec3(-0.3f, 11.0f, 0.25f));
    test_scene_finish(test);
}

static void make_far(TestScene *test)
{
    test_scene_init(test);
    add_mesh(test, mesh_star(40, 50, 0.1f, 7), 1.0f, vec3(1e4f, -1e4f, 1e4f));
    test_scene_finish(test);
}

static void make_tiny(TestScene *test)
{
    test_scene_init(test);
    add_mesh(test, mesh_star(8, 11, 0.3f, 8), 3e-10f, vec3_splat(0.0f));
    test_scene_finish(test);
}

static void make_curved(TestScene *test)
{
    TestRandom random = {.seed = 9};
    test_scene_init(test);
    add_mesh(test, mesh_star(6, 7, 0.2f, 9), 2.0f, vec3_splat(0.0f));
    test_scene_quadrics(test, &random, 30);
    add_patches(test, &random, 30);
    test_scene_finish(test);
}

static void make_alpha(TestScene *test)
{
    TestRandom random = {.seed = 10};
    test_scene_init(test);
    add_mesh(test, mesh_star(6, 7, 0.2f, 10), 2.0f, vec3_splat(0.0f));
    for (uint i = 0; i < 4; ++i)
        add_curtain(test, &random, 6, add_squares(test, 5.0f, i % 2 == 0 ? 0.0f : 0.5f));
    test_scene_finish(test);
}

/* Every kind of primitive in the world and in objects; mirrored, stretched and overlapping instances; an empty
 * object. */
static void make_instances(TestScene *test)
{
    Error error = {0};
    TestRandom random = {.seed = 11};
    uint object[3];
    test_scene_init(test);
    add_mesh(test, mesh_star(6, 7, 0.2f, 30), 4.0f, vec3_splat(0.0f));
    for (uint i = 0; i < 3; ++i) {
        ck_assert(scene_object_begin(&test->scene, &object[i], &error));
        if (i < 2)
            add_mesh(test, mesh_star(5, 6 + 2 * i, 0.3f, 31 + i), 1.0f, vec3_splat(0.1f * (float)i));
        if (i == 0) {
            test_scene_quadrics(test, &random, 6);
            add_patches(test, &random, 5);
            add_curtain(test, &random, 3, add_squares(test, 3.0f, 0.3f));
        }
        ck_assert(scene_object_end(&test->scene, &error));
    }
    test_scene_quadrics(test, &random, 4);
    for (uint i = 0; i < 3; ++i)
        test_scene_instances(test, &random, object[i], 6, 1.0f);
    test_scene_finish(test);
}

/* A swarm of instances of a finer mesh, some of them coincident. */
static void make_swarm(TestScene *test)
{
    Error error = {0};
    TestRandom random = {.seed = 12};
    uint object;
    test_scene_init(test);
    ck_assert(scene_object_begin(&test->scene, &object, &error));
    add_mesh(test, mesh_star(30, 40, 0.05f, 33), 1.0f, vec3_splat(0.0f));
    ck_assert(scene_object_end(&test->scene, &error));
    add_mesh(test, mesh_star(5, 6, 0.2f, 34), 4.0f, vec3_splat(0.0f));
    test_scene_instances(test, &random, object, 2000, 0.5f);
    test_scene_finish(test);
}

static void make_curves(TestScene *test)
{
    Error error = {0};
    TestRandom random = {.seed = 13};
    uint object;
    test_scene_init(test);
    ck_assert(scene_object_begin(&test->scene, &object, &error));
    test_scene_curves_random(test, &random, 20);
    ck_assert(scene_object_end(&test->scene, &error));
    add_mesh(test, mesh_star(5, 6, 0.2f, 35), 4.0f, vec3_splat(0.0f));
    test_scene_curves_random(test, &random, 60);
    test_scene_instances(test, &random, object, 12, 1.0f);
    test_scene_finish(test);
}

const BvhCase BVH_CASES[] = {
    {"star", make_star, 120000, true},         {"huge", make_huge, 140000, false},
    {"slivers", make_slivers, 100000, true},   {"many slivers", make_many_slivers, 50000, false},
    {"coplanar", make_coplanar, 130000, true}, {"far", make_far, 140000, false},
    {"tiny", make_tiny, 90000, true},          {"curved", make_curved, 90000, true},
    {"alpha", make_alpha, 90000, true},        {"instances", make_instances, 70000, true},
    {"swarm", make_swarm, 50000, false},       {"curves", make_curves, 40000, true},
};
const uint BVH_CASE_COUNT = sizeof BVH_CASES / sizeof BVH_CASES[0];
