/* Poses: skins, and weights of morph targets that nodes have. */
#include "gltf/test_gltf.h"

#include "pbrt/import.h"
#include "support/test_files.h"

#include <math.h>
#include <string.h>

/* ---- files ------------------------------------------------------------------------------------------------------- */

/* An accessor, in a view of its own. */
typedef struct SkinData {
    const char *type; /* "VEC3" */
    int component; /* GLTF's number */
    int count;
    const void *data;
    size_t size;
    const char *more; /* members of the accessor: ",\"normalized\":true" */
} SkinData;

#define FLOATS(type, count, data)                                                                                      \
    {                                                                                                                  \
        type, 5126, count, data, sizeof(data), ""                                                                      \
    }
#define BYTES(type, count, data)                                                                                       \
    {                                                                                                                  \
        type, 5121, count, data, sizeof(data), ""                                                                      \
    }
#define SHORTS(type, count, data)                                                                                      \
    {                                                                                                                  \
        type, 5123, count, data, sizeof(data), ""                                                                      \
    }

/* Writes NAME.gltf and NAME.gltf.bin: accessor i is data[i], in view i. Returns its path. */
static const char *skin_write(const char *name, const SkinData *data, int count, const char *members)
{
    static char json[1 << 14], bytes[1 << 14];
    char views[4096] = "", accessors[4096] = "";
    size_t used = 0;
    for (int i = 0; i < count; ++i) {
        const char *comma = i > 0 ? "," : "";
        ck_assert_uint_le(used + data[i].size, sizeof bytes);
        memcpy(bytes + used, data[i].data, data[i].size);
        snprintf(views + strlen(views), sizeof views - strlen(views),
                 "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", comma, used, data[i].size);
        snprintf(accessors + strlen(accessors), sizeof accessors - strlen(accessors),
                 "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"%s}", comma, i,
                 data[i].component, data[i].count, data[i].type, data[i].more);
        used += (data[i].size + 3) / 4 * 4;
    }
    int length = snprintf(json, sizeof json,
                          "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu,\"uri\":\"%s.bin\"}],"
                          "\"bufferViews\":[%s],\"accessors\":[%s],%s}",
                          used, name, views, accessors, members);
    ck_assert_int_lt(length, (int)sizeof json);
    char binary[64];
    snprintf(binary, sizeof binary, "%s.bin", name);
    test_file_write(gltf_path(binary), bytes, used);
    const char *path = gltf_path(name);
    test_file_write(path, json, (size_t)length);
    return path;
}

static void skin_scene(const SkinData *data, int count, const char *members, Scene *scene)
{
    const ImportOptions options = {0};
    Error error = {{0}, {0}};
    gltf_log();
    Gltf *gltf = gltf_open(skin_write("skin.gltf", data, count, members), &error);
    scene_init(scene);
    ck_assert_msg(gltf && gltf_import(gltf, &options, scene, &error), "%s", error.message);
    gltf_close(gltf);
}

static void skin_fails(const SkinData *data, int count, const char *members, const char *message)
{
    const char *got = gltf_error(skin_write("bad.gltf", data, count, members));
    ck_assert_msg(strstr(got, message) != NULL, "\"%s\" is not in: %s", message, got);
}

static Vec3 position(const Scene *scene, size_t i)
{
    return vec3_add(scene->origin, ELEMENT(scene, positions, Vec3, i));
}

/* ---- a cylinder with two bones ----------------------------------------------------------------------------------- */

/* Rings of vertices around the y axis, at heights from 0 to 2. */
enum { AROUND = 8, RINGS = 5, VERTICES = AROUND * RINGS, CORNERS = 6 * AROUND * (RINGS - 1) };

typedef struct Cylinder {
    float positions[3 * VERTICES], normals[3 * VERTICES], weights[4 * VERTICES];
    unsigned char joints[4 * VERTICES];
    unsigned short indices[CORNERS];
} Cylinder;

static Cylinder cylinder_make(void)
{
    Cylinder cylinder = {0};
    unsigned short *corner = cylinder.indices;
    for (int i = 0; i < VERTICES; ++i) {
        const int ring = i / AROUND;
        double angle = 2.0 * M_PI * (i % AROUND) / AROUND, height = 0.5 * ring;
        float *p = cylinder.positions + 3 * i, *n = cylinder.normals + 3 * i;
        n[0] = (float)cos(angle);
        n[2] = (float)sin(angle);
        p[0] = 0.3f * n[0];
        p[1] = (float)height;
        p[2] = 0.3f * n[2];
        cylinder.joints[4 * i] = 1;
        cylinder.weights[4 * i] = (float)(height / 2.0);
        cylinder.weights[4 * i + 1] = (float)(1.0 - height / 2.0);
    }
    for (int i = 0; i < AROUND * (RINGS - 1); ++i) {
        int right = i % AROUND == AROUND - 1 ? i + 1 - AROUND : i + 1;
        const int quad[6] = {i, i + AROUND, right, right, i + AROUND, right + AROUND};
        for (int k = 0; k < 6; ++k)
            *corner++ = (unsigned short)quad[k];
    }
    return cylinder;
}

#define CYLINDER(cylinder)                                                                                             \
    FLOATS("VEC3", VERTICES, (cylinder).positions), FLOATS("VEC3", VERTICES, (cylinder).normals),                      \
        SHORTS("SCALAR", CORNERS, (cylinder).indices), BYTES("VEC4", VERTICES, (cylinder).joints),                     \
        FLOATS("VEC4", VERTICES, (cylinder).weights)
#define CYLINDER_MESH                                                                                                  \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"JOINTS_0\":3,\"WEIGHTS_0\":4},"       \
    "\"indices\":2}]}]"

/* The lower bone stays and the upper one, which begins at height 1, is turned by 90 degrees about z and made `wide`
 * times as wide along z; all is moved by (3, 0, 0). The mesh's own node is far away, which does not matter. */
static void bent_check(const Scene *scene, const Cylinder *cylinder, double wide)
{
    for (int i = 0; i < VERTICES; ++i) {
        const float *p = cylinder->positions + 3 * i, *n = cylinder->normals + 3 * i;
        double x = (double)p[0], y = (double)p[1], z = (double)p[2], w = y / 2.0, nx = (double)n[0], nz = (double)n[2];
        assert_vec3(position(scene, (size_t)i), 3.0 + (1.0 - w) * x + w * (1.0 - y), (1.0 - w) * y + w * (1.0 + x),
                    (1.0 - w) * z + w * wide * z, 1e-6);
        /* In x and y the matrix turns, and scales by the square root of a; along z it is b. */
        double a = (1.0 - w) * (1.0 - w) + w * w, b = 1.0 - w + w * wide;
        double m[3] = {(1.0 - w) * nx / a, w * nx / a, nz / b}, length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        assert_vec3(ELEMENT(scene, normals, Vec3, (size_t)i), m[0] / length, m[1] / length, m[2] / length, 1e-6);
    }
}

#define BENT_NODES(scale)                                                                                              \
    "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[100,50,0],\"scale\":[2,3,-4]},"                                \
    "{\"translation\":[3,0,0],\"children\":[2]},"                                                                      \
    "{\"translation\":[0,1,0],\"rotation\":[0,0,0.70710678118654752,0.70710678118654752],\"scale\":[1,1," scale "]}]"
#define BENT_BINDS                                                                                                     \
    {                                                                                                                  \
        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1                \
    }

#define BENT(scale) CYLINDER_MESH ",\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":5}]," BENT_NODES(scale)

START_TEST(cylinders_bend)
{
    static const char *const MEMBERS[] = {BENT("1"), BENT("4")};
    const Cylinder cylinder = cylinder_make();
    const float binds[32] = BENT_BINDS;
    const SkinData data[] = {CYLINDER(cylinder), FLOATS("MAT4", 2, binds)};
    for (int i = 0; i < 2; ++i) {
        Scene scene;
        skin_scene(data, 6, MEMBERS[i], &scene);
        ck_assert_uint_eq(scene.positions.count, VERTICES);
        bent_check(&scene, &cylinder, i == 0 ? 1.0 : 4.0);
        ck_assert(strstr(gltf_log(), "weights") == NULL);
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(poses_are_converted)
{
    const Cylinder cylinder = cylinder_make();
    const float binds[32] = BENT_BINDS;
    const SkinData data[] = {CYLINDER(cylinder), FLOATS("MAT4", 2, binds)};
    const ImportOptions options = {0};
    Error error = {{0}, {0}};
    Scene scene;
    const char *converted = gltf_path("bent.pbrt");
    Gltf *gltf = gltf_open(skin_write("bent.gltf", data, 6, BENT("4")), &error);
    ck_assert_msg(gltf && gltf_convert(gltf, converted, &error), "%s", error.message);
    gltf_close(gltf);
    scene_init(&scene);
    ck_assert_msg(pbrt_import(converted, &options, &scene, &error), "%s", error.message);
    bent_check(&scene, &cylinder, 4.0);
    scene_destroy(&scene);
    gltf_folder_remove(gltf_path("bent-meshes"));
}
END_TEST

/* ---- a triangle, one vertex for each way to be moved ------------------------------------------------------------- */

static const float CORNER_POINTS[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const unsigned char CORNER_JOINTS[12] = {0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
static const float CORNER_WEIGHTS[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
#define CORNERS_DATA                                                                                                   \
    FLOATS("VEC3", 3, CORNER_POINTS), BYTES("VEC4", 3, CORNER_JOINTS), FLOATS("VEC4", 3, CORNER_WEIGHTS)
#define CORNERS_MESH(more)                                                                                             \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2" more "}}]}]"
#define THREE_JOINTS "\"skins\":[{\"joints\":[1,2,3]}]"
#define THREE_NODES                                                                                                    \
    "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"translation\":[0,0,1]},{\"translation\":[0,0,2]},{\"translation\":[0,0,4]}" \
    "]"
#define THREE CORNERS_MESH("") "," THREE_JOINTS "," THREE_NODES

/* Without inverse bind matrices; bytes and shorts. */
START_TEST(weights_are_of_any_type)
{
    static const unsigned char bytes[12] = {255, 0, 0, 0, 51, 204, 0, 0, 255, 0, 0, 0};
    static const unsigned short shorts[12] = {65535, 0, 0, 0, 13107, 52428, 0, 0, 65535, 0, 0, 0};
    static const unsigned short joints[12] = {0, 0, 0, 0, 1, 2, 0, 0, 2, 0, 0, 0};
    const char *more = ",\"normalized\":true";
    const SkinData data[2][3] = {
        {FLOATS("VEC3", 3, CORNER_POINTS), SHORTS("VEC4", 3, joints), {"VEC4", 5121, 3, bytes, sizeof bytes, more}},
        {FLOATS("VEC3", 3, CORNER_POINTS), SHORTS("VEC4", 3, joints), {"VEC4", 5123, 3, shorts, sizeof shorts, more}}};
    for (int i = 0; i < 2; ++i) {
        Scene scene;
        skin_scene(data[i], 3, THREE, &scene);
        assert_vec3(position(&scene, 0), 0, 0, 1, 1e-6);
        assert_vec3(position(&scene, 1), 1, 0, 0.2 * 2 + 0.8 * 4, 1e-6);
        assert_vec3(position(&scene, 2), 0, 1, 4, 1e-6);
        ck_assert(strstr(gltf_log(), "weights") == NULL);
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(vertices_have_more_than_four_joints)
{
    static const unsigned char more_joints[12] = {2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    static const float weights[12] = {0.75f, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    static const float more_weights[12] = {0.25f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    const SkinData data[] = {FLOATS("VEC3", 3, CORNER_POINTS), BYTES("VEC4", 3, CORNER_JOINTS),
                             FLOATS("VEC4", 3, weights), BYTES("VEC4", 3, more_joints),
                             FLOATS("VEC4", 3, more_weights)};
    Scene scene;
    skin_scene(data, 5, CORNERS_MESH(",\"JOINTS_1\":3,\"WEIGHTS_1\":4") "," THREE_JOINTS "," THREE_NODES, &scene);
    assert_vec3(position(&scene, 0), 0, 0, 0.75 * 1 + 0.25 * 4, 1e-6);
    assert_vec3(position(&scene, 1), 1, 0, 2, 1e-6);
    scene_destroy(&scene);
}
END_TEST

/* Weights that a sparse accessor replaces; those that are too large are scaled; without any, a vertex follows its first
 * joint. */
START_TEST(weights_need_not_add_up)
{
    static const unsigned char joints[12] = {0, 2, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
    static const float weights[12] = {1, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, none[4] = {0, 0, 0, 0};
    static const unsigned char which[1] = {2};
    const SkinData data[] = {FLOATS("VEC3", 3, CORNER_POINTS),
                             BYTES("VEC4", 3, joints),
                             {"VEC4", 5126, 3, weights, sizeof weights,
                              ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":3,\"componentType\":5121},"
                              "\"values\":{\"bufferView\":4}}"},
                             BYTES("SCALAR", 1, which),
                             FLOATS("VEC4", 1, none)};
    Scene scene;
    skin_scene(data, 5, THREE, &scene);
    gltf_says("the skin weights of meshes[0].primitives[0] do not add up to 1 at 1 vertices");
    gltf_says("1 vertices of meshes[0].primitives[0] have no skin weights");
    assert_vec3(position(&scene, 0), 0, 0, 2.5, 1e-6);
    assert_vec3(position(&scene, 1), 1, 0, 2, 1e-6);
    assert_vec3(position(&scene, 2), 0, 1, 4, 1e-6);
    scene_destroy(&scene);
}
END_TEST

/* Another node shows the same mesh without the skin, and a mesh without joints follows the node that has a skin. */
START_TEST(each_node_has_its_pose)
{
    const SkinData data[] = {CORNERS_DATA};
    Scene scene;
    skin_scene(data, 3,
               CORNERS_MESH("") "," THREE_JOINTS
                                ",\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[9,9,9]},{\"translation\":[0,0,1]},"
                                "{\"translation\":[0,0,2]},{\"translation\":[0,0,4]},"
                                "{\"mesh\":0,\"translation\":[0,0,-5]}]",
               &scene);
    ck_assert_uint_eq(scene.positions.count, 6);
    assert_vec3(position(&scene, 1), 1, 0, 2, 1e-6);
    assert_vec3(position(&scene, 4), 1, 0, -5, 1e-6);
    scene_destroy(&scene);
    skin_scene(data, 3,
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"skins\":[{\"joints\":[1]}],"
               "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[0,0,7]},{\"translation\":[0,0,1]}]",
               &scene);
    assert_vec3(position(&scene, 1), 1, 0, 7, 1e-6);
    scene_destroy(&scene);
}
END_TEST

/* Joints that mirror a triangle exchange its corners, so that its front stays that of the mesh. */
START_TEST(mirrored_triangles_keep_their_front)
{
    const SkinData data[] = {CORNERS_DATA};
    Scene scene;
    skin_scene(data, 3,
               CORNERS_MESH("") ",\"skins\":[{\"joints\":[1,1,1]}],"
                                "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"scale\":[-1,1,1]}]",
               &scene);
    const Primitive triangle = ELEMENT(&scene, primitives, Primitive, 0);
    Vec3 a = position(&scene, triangle.a), b = position(&scene, triangle.b), c = position(&scene, triangle.c);
    ck_assert(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)).z > 0.0f);
    assert_vec3(position(&scene, 1), -1, 0, 0, 1e-6);
    scene_destroy(&scene);
}
END_TEST

/* Of two nodes that show a mesh with a morph target, one has a weight of its own. */
START_TEST(nodes_have_weights_of_morph_targets)
{
    Scene scene;
    gltf_scene(
        "\"meshes\":[{\"weights\":[0.5],\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":3,"
        "\"targets\":[{\"POSITION\":1}]}]}],\"nodes\":[{\"mesh\":0,\"weights\":[3]},{\"mesh\":0}," GLTF_LIGHT_NODE
        "]," GLTF_LIGHT,
        &scene);
    ck_assert_uint_eq(scene.positions.count, 8);
    Vec3 first = position(&scene, 0), second = position(&scene, 4);
    TEST_NEAR(fmaxf(first.z, second.z), 3, 1e-6);
    TEST_NEAR(fminf(first.z, second.z), 0.5, 1e-6);
    scene_destroy(&scene);
}
END_TEST

/* ---- bad files --------------------------------------------------------------------------------------------------- */

static void corners_fail(const unsigned char *joints, const float *weights, const char *members, const char *message)
{
    const SkinData data[] = {FLOATS("VEC3", 3, CORNER_POINTS),
                             {"VEC4", 5121, 3, joints, 12, ""},
                             {"VEC4", 5126, 3, weights, 48, ""},
                             FLOATS("VEC4", 2, CORNER_WEIGHTS)};
    skin_fails(data, 4, members, message);
}

START_TEST(bad_vertices_are_refused)
{
    static const unsigned char far_joint[12] = {0, 0, 0, 0, 3, 0, 0, 0, 2, 0, 0, 0};
    float weights[12];
    corners_fail(far_joint, CORNER_WEIGHTS, THREE, "joint 3 at vertex 1, but its skin has 3 joints");
    static const struct {
        float weight;
        const char *message;
    } BAD[] = {{-0.5f, "a skin weight of -0.5 at vertex 2"},
               {NAN, "a skin weight of nan at vertex 2"},
               {INFINITY, "a skin weight of inf at vertex 2"}};
    for (int i = 0; i < 3; ++i) {
        memcpy(weights, CORNER_WEIGHTS, sizeof weights);
        weights[9] = BAD[i].weight;
        corners_fail(CORNER_JOINTS, weights, THREE, BAD[i].message);
    }
    /* Without weights a vertex follows its first joint. */
    const SkinData data[] = {FLOATS("VEC3", 3, CORNER_POINTS), BYTES("VEC4", 3, far_joint), FLOATS("VEC4", 3, weights)};
    memset(weights, 0, sizeof weights);
    skin_fails(data, 3, THREE, "joint 3 at vertex 1");
}
END_TEST

START_TEST(bad_skins_are_refused)
{
    static const struct {
        const char *members, *message;
    } BAD[] = {
        {CORNERS_MESH("") ",\"skins\":[{\"joints\":[1,9]}]," THREE_NODES, "joints"},
        {CORNERS_MESH("") ",\"skins\":[{}]," THREE_NODES, "skins[0] has no joints"},
        {CORNERS_MESH("") "," THREE_NODES, "skin"},
        {CORNERS_MESH("") ",\"skins\":[{\"joints\":[1,2,3],\"inverseBindMatrices\":0}]," THREE_NODES, "MAT4"},
        {CORNERS_MESH(",\"JOINTS_1\":1") "," THREE_JOINTS "," THREE_NODES, "has JOINTS_1 without WEIGHTS_1"},
        {CORNERS_MESH(",\"JOINTS_1\":1,\"WEIGHTS_1\":3") "," THREE_JOINTS "," THREE_NODES,
         "WEIGHTS_1 has 2 elements for 3 vertices"},
        {CORNERS_MESH(",\"JOINTS_1\":2,\"WEIGHTS_1\":2") "," THREE_JOINTS "," THREE_NODES, "component type 5126"},
        {CORNERS_MESH("") "," THREE_JOINTS ",\"nodes\":[{\"mesh\":0,\"skin\":0},{\"children\":[2]},{\"children\":[3]},"
                          "{\"children\":[1]}]",
         "the nodes have a cycle"},
        {CORNERS_MESH("") ",\"nodes\":[{\"mesh\":0,\"weights\":[\"much\"]}]", "nodes[0].weights[0] must be a number"},
    };
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; ++i)
        corners_fail(CORNER_JOINTS, CORNER_WEIGHTS, BAD[i].members, BAD[i].message);
}
END_TEST

START_TEST(sets_are_limited)
{
    char sets[1024] = "", members[2048];
    for (int i = 1; i <= 16; ++i)
        snprintf(sets + strlen(sets), sizeof sets - strlen(sets), ",\"JOINTS_%d\":1,\"WEIGHTS_%d\":2", i, i);
    snprintf(members, sizeof members, CORNERS_MESH("%s") "," THREE_JOINTS "," THREE_NODES, sets);
    corners_fail(CORNER_JOINTS, CORNER_WEIGHTS, members, "has more than 16 sets of joints");
}
END_TEST

/* Three hundred million vertices in a few bytes. */
START_TEST(poses_are_limited)
{
    const char *path = gltf_write_with(
        "many.glb",
        "\"accessors\":[{\"componentType\":5126,\"count\":300000000,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"
        "\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":1}}}]",
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,\"weights\":[1]}]");
    const char *got = gltf_error(path);
    ck_assert_msg(strstr(got, "have more than 268435456 vertices and joints") != NULL, "%s", got);
}
END_TEST

START_TEST(matrices_are_checked)
{
    float binds[32] = BENT_BINDS;
    const SkinData data[] = {CORNERS_DATA, FLOATS("MAT4", 2, binds)};
    skin_fails(data, 4, CORNERS_MESH("") ",\"skins\":[{\"joints\":[1,2,3],\"inverseBindMatrices\":3}]," THREE_NODES,
               "skins[0] has 3 joints, but only 2 inverseBindMatrices");
    binds[0] = NAN;
    skin_fails(data, 4, CORNERS_MESH("") ",\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":3}]," THREE_NODES,
               "joint 2 at vertex 2");
    const SkinData one[] = {CORNERS_DATA, {"MAT4", 5126, 1, binds, 64, ""}};
    static const unsigned char first[12] = {0};
    const SkinData rigid[] = {one[0], {"VEC4", 5121, 3, first, sizeof first, ""}, one[2], one[3]};
    skin_fails(rigid, 4, CORNERS_MESH("") ",\"skins\":[{\"joints\":[1],\"inverseBindMatrices\":3}]," THREE_NODES,
               "has vertices that are not finite");
}
END_TEST

TCase *gltf_skins_case(void)
{
    TCase *tests = gltf_case("skins");
    tcase_add_test(tests, cylinders_bend);
    tcase_add_test(tests, poses_are_converted);
    tcase_add_test(tests, weights_are_of_any_type);
    tcase_add_test(tests, vertices_have_more_than_four_joints);
    tcase_add_test(tests, weights_need_not_add_up);
    tcase_add_test(tests, each_node_has_its_pose);
    tcase_add_test(tests, mirrored_triangles_keep_their_front);
    tcase_add_test(tests, nodes_have_weights_of_morph_targets);
    tcase_add_test(tests, bad_vertices_are_refused);
    tcase_add_test(tests, bad_skins_are_refused);
    tcase_add_test(tests, sets_are_limited);
    tcase_add_test(tests, poses_are_limited);
    tcase_add_test(tests, matrices_are_checked);
    return tests;
}
