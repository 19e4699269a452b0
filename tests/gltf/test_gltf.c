/* Reading glTF: every feature against the values in the file. */
#include "gltf/test_gltf.h"

#include "base/log.h"
#include "support/test_files.h"

#include <dirent.h>
#include <stdint.h>
#include <string.h>

/* ---- files ------------------------------------------------------------------------------------------------------- */

static const float SQUARE[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const float NORMALS[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static const float COORDINATES[] = {0, 1, 1, 1, 1, 0, 0, 0};
static const uint16_t INDICES[] = {0, 1, 2, 0, 2, 3};
static const float STRIP[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

/* A PNG of 2 x 2 pixels RGBA, stored without compression. */
static const unsigned char PNG[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x06, 0x00, 0x00, 0x00, 0x72, 0xb6, 0x0d, 0x24, 0x00, 0x00, 0x00,
    0x1d, 0x49, 0x44, 0x41, 0x54, 0x78, 0x01, 0x01, 0x12, 0x00, 0xed, 0xff, 0x00, 0xff, 0x00, 0x00, 0xff, 0x00,
    0xff, 0x00, 0x80, 0x00, 0x00, 0x00, 0xff, 0x40, 0x80, 0x40, 0x20, 0x00, 0x3a, 0x21, 0x05, 0x9d, 0xd2, 0xa7,
    0xa8, 0xf0, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/* Offsets of the buffer views in the buffer. */
enum {
    AT_SQUARE = 0,
    AT_NORMALS = 48,
    AT_COORDINATES = 96,
    AT_INDICES = 128,
    AT_PNG = 140,
    AT_STRIP = 232,
    BUFFER = 280
};

static void buffer_make(unsigned char buffer[BUFFER])
{
    memset(buffer, 0, BUFFER);
    memcpy(buffer + AT_SQUARE, SQUARE, sizeof SQUARE);
    memcpy(buffer + AT_NORMALS, NORMALS, sizeof NORMALS);
    memcpy(buffer + AT_COORDINATES, COORDINATES, sizeof COORDINATES);
    memcpy(buffer + AT_INDICES, INDICES, sizeof INDICES);
    memcpy(buffer + AT_PNG, PNG, sizeof PNG);
    memcpy(buffer + AT_STRIP, STRIP, sizeof STRIP);
}

static void word_put(unsigned char *at, uint32_t word)
{
    for (int i = 0; i < 4; ++i)
        at[i] = (unsigned char)(word >> 8 * i);
}

const char *gltf_write_with(const char *name, const char *accessors, const char *members)
{
    static unsigned char file[1 << 16];
    char *json = (char *)file + 20;
    int length = snprintf(json, sizeof file - 1024,
                          "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%d}],\"bufferViews\":["
                          "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":48},"
                          "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":48},"
                          "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":32},"
                          "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":12},"
                          "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d},"
                          "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":48}],%s,%s}",
                          BUFFER, AT_SQUARE, AT_NORMALS, AT_COORDINATES, AT_INDICES, AT_PNG, (int)sizeof PNG, AT_STRIP,
                          accessors, members);
    ck_assert_int_lt(length, (int)sizeof file - 1024);
    for (; length % 4 != 0; ++length)
        json[length] = ' ';
    memcpy(file, "glTF", 4);
    word_put(file + 4, 2);
    word_put(file + 8, (uint32_t)(20 + length + 8 + BUFFER));
    word_put(file + 12, (uint32_t)length);
    memcpy(file + 16, "JSON", 4);
    word_put(file + 20 + length, BUFFER);
    memcpy(file + 24 + length, "BIN\0", 4);
    buffer_make(file + 28 + length);
    const char *path = test_path(name);
    test_file_write(path, file, (size_t)(28 + length + BUFFER));
    return path;
}

const char *gltf_path(const char *name)
{
    return test_path(name);
}

const char *gltf_write(const char *name, const char *members)
{
    return gltf_write_with(name, GLTF_ACCESSORS, members);
}

void gltf_folder_remove(const char *path)
{
    DIR *folder = opendir(path);
    ck_assert_ptr_nonnull(folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    rmdir(path);
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static char log_text[8192];

static void log_collect(const char *line, void *context)
{
    (void)context;
    size_t used = strlen(log_text);
    snprintf(log_text + used, sizeof log_text - used, "%s\n", line);
}

const char *gltf_log(void)
{
    static char copy[sizeof log_text];
    memcpy(copy, log_text, sizeof copy);
    log_text[0] = '\0';
    return copy;
}

void gltf_says(const char *text)
{
    ck_assert_msg(strstr(log_text, text) != NULL, "no \"%s\" in:\n%s", text, log_text);
}

void gltf_scene(const char *members, Scene *scene)
{
    const ImportOptions options = {0};
    Error error = {{0}, {0}};
    gltf_log();
    Gltf *gltf = gltf_open(gltf_write("scene.glb", members), &error);
    scene_init(scene);
    ck_assert_msg(gltf && gltf_import(gltf, &options, scene, &error), "%s", error.message);
    gltf_close(gltf);
}

const char *gltf_error(const char *path)
{
    static Error error;
    Scene scene;
    error = (Error){{0}, {0}};
    gltf_log();
    scene_init(&scene);
    bool good = scene_file_load(path, false, &scene, &error);
    scene_destroy(&scene);
    ck_assert_msg(!good, "accepted: %s", path);
    ck_assert_msg(strncmp(error.message, path, strlen(path)) == 0, "without the file's name: %s", error.message);
    return error.message + strlen(path) + 2;
}

const Material *gltf_material(const Scene *scene, size_t shape)
{
    return &ELEMENT(scene, materials, Material, ELEMENT(scene, shapes, Shape, shape).material);
}

void assert_vec3(Vec3 a, double x, double y, double z, double tolerance)
{
    bool near =
        fabs((double)a.x - x) <= tolerance && fabs((double)a.y - y) <= tolerance && fabs((double)a.z - z) <= tolerance;
    ck_assert_msg(near, "(%.9g %.9g %.9g), not (%.9g %.9g %.9g)", (double)a.x, (double)a.y, (double)a.z, x, y, z);
}

TCase *gltf_case(const char *name)
{
    TCase *tests = tcase_create(name);
    tcase_add_unchecked_fixture(tests, test_folder_make, test_folder_remove);
    tcase_set_timeout(tests, 60.0);
    return tests;
}

int main(void)
{
    Suite *suite = suite_create("gltf");
    log_sink_set(log_collect, NULL);
    suite_add_tcase(suite, gltf_scene_case());
    suite_add_tcase(suite, gltf_skins_case());
    suite_add_tcase(suite, gltf_materials_case());
    suite_add_tcase(suite, gltf_textures_case());
    suite_add_tcase(suite, gltf_bad_case());
    suite_add_tcase(suite, gltf_convert_case());
    return test_run(suite);
}
