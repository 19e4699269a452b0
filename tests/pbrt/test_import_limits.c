/* Counts that overflow 32 bits or announce more than there is: rejected with a message before memory is allocated. */
#include "pbrt/test_import.h"

#include "pbrt/ply.h"

#include <inttypes.h>
#include <string.h>
#include <sys/resource.h>

/* Limits the address space, so that allocating the announced size would fail. Sanitizers need more than that. */
static void memory_limit(void)
{
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    struct rlimit limit = {(rlim_t)4 << 30, (rlim_t)4 << 30};
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &limit), 0);
#endif
}

static const struct {
    uint64_t vertices, primitives;
} MESHES[] = {{UINT64_C(1) << 32, 1}, {UINT64_C(4294967295), 1}, {1431655766, 1}, /* times 3 is 2 mod 2^32 */
              {UINT64_C(1) << 62, 1}, /* times 12 bytes is 0 mod 2^64 */
              {3, UINT64_C(1) << 32}, {3, 1431655766},           {3, UINT64_C(1) << 61},
              {3, 1100000000}, /* below 2^32, but at 16 bytes each more than the buffer holds */
              {800000000, 500000000}};

/* The arrays are shorter than stated: reading or copying them before the check would crash. */
START_TEST(meshes_beyond_32_bits)
{
    static const float POSITIONS[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint INDICES[4] = {0, 1, 2, 2};
    const MeshData mesh = {.positions = POSITIONS,
                           .vertex_count = MESHES[_i].vertices,
                           .indices = INDICES,
                           .triangle_count = MESHES[_i].primitives};
    const Shape shape = {.alpha = NONE};
    memory_limit();
    for (int patches = 0; patches < 2; ++patches) {
        Scene scene;
        Error error = {{0}, {0}};
        scene_init(&scene);
        ck_assert(!(patches ? scene_add_patches : scene_add_mesh)(&scene, &mesh, shape, NULL, 0u, &error));
        ck_assert_str_eq(error.message, "error: the scene needs more than 16 GiB of vertices and primitives");
        ck_assert_str_eq(error.fix, "use object instances, or split the scene");
        ck_assert_uint_eq(scene.positions.count, 0);
        scene_destroy(&scene);
    }
}
END_TEST

/* Stated counts for full arrays that are never read: the count alone decides. */
START_TEST(arrays_beyond_32_bits)
{
    static const double IDENTITY[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Scene scene;
    Error error = {{0}, {0}};
    LightData light = {0};
    Material material = {0};
    uint index;
    memory_limit();
    scene_init(&scene);
    scene.materials.count = scene.instances.count = NONE;
    scene.lights.count = LIGHTS_MAX;
    ck_assert(!scene_add_light(&scene, &light, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "the scene has more than 33554431 lights"));
    ck_assert(!scene_add_material(&scene, &material, &index, &error));
    ck_assert_ptr_nonnull(strstr(error.message, " materials"));
    ck_assert(!scene_add_instance(&scene, 0, IDENTITY, IDENTITY, &error));
    ck_assert_ptr_nonnull(strstr(error.message, " instances"));
    scene_destroy(&scene);
}
END_TEST

/* Headers followed by a body of a few bytes. */
static const struct {
    const char *format;
    uint64_t vertices;
    const char *index_type; /* of the face list: count and value */
    uint64_t faces;
    const char body[17]; /* of the faces; 12 bytes per vertex precede it */
    const char *message;
} PLYS[] = {
    {"binary_little_endian", UINT64_C(4000000000), "uchar int", 1, "", "the file ends too early"},
    {"binary_little_endian", 3, "uchar int", UINT64_C(4000000000), "\3", "the file ends too early"},
    {"binary_big_endian", 3, "uchar int", UINT64_C(4294967295), "\3", "the file ends too early"},
    {"ascii", 3, "uchar int", UINT64_C(4294967295), "3", "the file ends too early"},
    {"binary_little_endian", UINT64_C(4294967296), "uchar int", 1, "", "line 3: an element's count is not a number"},
    {"binary_little_endian", 3, "uchar int", UINT64_C(42949672959), "", "line 7: an element's count is not a number"},
    {"binary_little_endian", 3, "uint int", 1, "\377\377\377\377", "the file ends too early"},
    {"binary_little_endian", 3, "int double", 1, "\377\377\377\377", "lack a list of integers"},
    {"binary_little_endian", 3, "int int", 1, "\377\377\377\177", "the file ends too early"},
    {"binary_little_endian", 3, "short int", 1, "\377\377", "the file ends too early"},
    {"binary_little_endian", 3, "uint uint", 1, "\3\0\0\0\0\0\0\0\1\0\0\0\0\0\0\200",
     "is out of range: the file has 3"},
};

START_TEST(plys_announce_too_much)
{
    char text[512];
    bool ascii = PLYS[_i].format[0] == 'a';
    int size = snprintf(text, sizeof text,
                        "ply\nformat %s 1.0\nelement vertex %" PRIu64 "\nproperty float x\nproperty float y\nproperty "
                        "float z\nelement face %" PRIu64 "\nproperty list %s vertex_indices\nend_header\n",
                        PLYS[_i].format, PLYS[_i].vertices, PLYS[_i].faces, PLYS[_i].index_type);
    memset(text + size, ascii ? ' ' : 0, 36);
    if (ascii)
        memcpy(text + size, "0 0 0 1 0 0 0 1 0", 17);
    memcpy(text + size + 36, PLYS[_i].body, 17);
    PlyMesh mesh;
    Error error = {{0}, {0}};
    memory_limit();
    ck_assert(!ply_read_memory("a.ply", (SourcePlace){0}, text, (size_t)size + 36 + 17, &mesh, &error));
    ck_assert_msg(strstr(error.message, PLYS[_i].message) != NULL, "%s", error.message);
}
END_TEST

/* One more would be rejected: tests/command/test_hostile.sh. */
START_TEST(parameters_at_the_limit_pass)
{
    enum { UNIT = 17 };
    static char text[64 + 1024 * UNIT];
    Scene scene;
    size_t used = (size_t)sprintf(text, "WorldBegin Shape \"sphere\"");
    for (int i = 0; i < 1024; ++i, used += UNIT)
        memcpy(text + used, " \"float radius\" 1", UNIT + 1);
    import_text(text, &scene);
    ck_assert_uint_eq(scene.primitives.count, 1);
    scene_destroy(&scene);
}
END_TEST

TCase *import_limits_case(void)
{
    TCase *tcase = tcase_create("limits");
    tcase_add_loop_test(tcase, meshes_beyond_32_bits, 0, (int)(sizeof MESHES / sizeof *MESHES));
    tcase_add_test(tcase, arrays_beyond_32_bits);
    tcase_add_loop_test(tcase, plys_announce_too_much, 0, (int)(sizeof PLYS / sizeof *PLYS));
    tcase_add_test(tcase, parameters_at_the_limit_pass);
    return tcase;
}
