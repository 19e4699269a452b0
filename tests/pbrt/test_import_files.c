/* Include and Import, limits against hostile files, public scenes, and the folders of bad and of fuzzed files. */
#include "pbrt/test_import.h"
#include "base/file_read.h"
#include "base/gzip.h"
#include "support/test_files.h"

#include <string.h>
#include <zlib.h>

static void file_write(const char *name, const char *text)
{
    test_file_write(test_path(name), text, strlen(text));
}

START_TEST(include_shares_the_state)
{
    Scene scene;
    file_write("part.inc", "Translate 1 0 0\nMaterial \"dielectric\"\nShape \"sphere\"");
    import_text_in("WorldBegin Include \"part.inc\" \"float radius\" 2 Shape \"sphere\"", test_folder, false, &scene);
    /* As in pbrt, the parameter list at the end of the included file continues in the including file. */
    ASSERT_FLOAT(ELEMENT(&scene, quadrics, Quadric, 0).radius, 2.0f);
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 1).center, 1, 0, 0, 0.0f);
    ck_assert_uint_eq(scene.materials.count, 1);
    scene_destroy(&scene);
}
END_TEST

START_TEST(import_has_its_own_state)
{
    Scene scene;
    file_write("part.inc", "Translate 1 0 0\nMakeNamedMaterial \"m\" \"string type\" \"dielectric\"\n"
                           "ReverseOrientation Include \"inner.inc\" Shape \"sphere\"");
    file_write("inner.inc", "Translate 2 0 0");
    import_text_in("WorldBegin Translate 0 5 0 Import \"part.inc\" NamedMaterial \"m\" Shape \"sphere\"", test_folder,
                   false, &scene);
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 0).center, 3, 5, 0, 0.0f);
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 1).center, 0, 5, 0, 0.0f);
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 1).flags, 0);
    const Material *m = &ELEMENT(&scene, materials, Material, ELEMENT(&scene, shapes, Shape, 1).material);
    ck_assert_uint_eq(m->kind, MATERIAL_DIELECTRIC);
    scene_destroy(&scene);
}
END_TEST

START_TEST(cycles_end)
{
    Error error;
    Scene scene;
    ImportOptions options = {.lenient = true};
    file_write("a.pbrt", "WorldBegin Include \"b.inc\"");
    file_write("b.inc", "\n  Include \"a.pbrt\"");
    scene_init(&scene);
    ck_assert(!pbrt_import(test_path("a.pbrt"), &options, &scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "b.inc:2:11: error: "));
    ck_assert_ptr_nonnull(strstr(error.message, "a.pbrt includes itself"));
    scene_destroy(&scene);
}
END_TEST

START_TEST(nesting_is_bounded)
{
    enum { DEEP = 70000 };
    char *text = malloc(16 * DEEP + 64);
    size_t n = (size_t)sprintf(text, "WorldBegin\n");
    for (int i = 0; i < DEEP; ++i)
        n += (size_t)sprintf(text + n, "AttributeBegin\n");
    ck_assert_str_eq(import_error(text), "test.pbrt:65538:1: error: AttributeBegin is nested more than 65536 deep");
    free(text);
}
END_TEST

START_TEST(includes_are_bounded)
{
    Error error;
    Scene scene;
    ImportOptions options = {.lenient = true};
    for (int i = 0; i < 70; ++i) {
        char name[32], text[64];
        snprintf(name, sizeof name, "%d", i);
        snprintf(text, sizeof text, "Include \"%d\"", i + 1);
        file_write(name, text);
    }
    scene_init(&scene);
    ck_assert(!pbrt_import_text("Include \"0\"", 11, "t", test_folder, &options, &scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "/62:1:9: error: files include each other more than 64 deep"));
    scene_destroy(&scene);
}
END_TEST

START_TEST(devices_are_refused)
{
    ck_assert_ptr_nonnull(strstr(import_error("Include \"/dev/zero\""), "error: cannot read /dev/zero"));
    ck_assert_ptr_nonnull(strstr(import_error("Include \"/tmp\""), "Is a directory"));
}
END_TEST

static void gzip_write(const char *name, const char *text)
{
    gzFile file = gzopen(test_path(name), "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_eq(gzwrite(file, text, (unsigned)strlen(text)), (int)strlen(text));
    ck_assert_int_eq(gzclose(file), Z_OK);
}

/* Scenes and what they include may be compressed; places in messages are those of the text. */
START_TEST(compressed_files)
{
    Error error;
    Scene scene;
    ImportOptions options = {.lenient = false};
    gzip_write("main.pbrt.gz", "WorldBegin\nInclude \"part.pbrt.gz\" Shape \"sphere\"");
    gzip_write("part.pbrt.gz", "Translate 1 0 0\nShape \"sphere\"\n");
    scene_init(&scene);
    ck_assert_msg(pbrt_import(test_path("main.pbrt.gz"), &options, &scene, &error), "%s", error.message);
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 1).center, 1, 0, 0, 0.0f);
    scene_destroy(&scene);
    gzip_write("part.pbrt.gz", "\nShape \"sphere\" \"float radius\" -1");
    scene_init(&scene);
    ck_assert(!pbrt_import(test_path("main.pbrt.gz"), &options, &scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "part.pbrt.gz:2:16: error: "));
    scene_destroy(&scene);
    file_write("part.pbrt.gz", "\x1f\x8b\x08nothing that can be decompressed");
    scene_init(&scene);
    ck_assert(!pbrt_import(test_path("main.pbrt.gz"), &options, &scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "main.pbrt.gz:2:9: error: cannot read "));
    ck_assert_ptr_nonnull(strstr(error.message, "the gzip'd data are damaged or incomplete"));
    scene_destroy(&scene);
}
END_TEST

/* What does not fit is refused before it is in memory. */
START_TEST(compressed_files_are_bounded)
{
    Array out;
    Error error;
    FileData file;
    char *zeros = calloc(1, (size_t)1 << 20);
    memset(zeros, ' ', ((size_t)1 << 20) - 1);
    gzip_write("zeros.gz", zeros);
    free(zeros);
    ck_assert(file_read(test_path("zeros.gz"), 65536, (SourcePlace){0}, &file, &error));
    array_init(&out, 1);
    ck_assert(gzip_is(file.data, file.size));
    ck_assert(gzip_inflate(file.data, file.size, ((size_t)1 << 20) - 1, &out, &error));
    ck_assert_uint_eq(out.count, ((size_t)1 << 20) - 1);
    out.count = 0;
    ck_assert(!gzip_inflate(file.data, file.size, (size_t)1 << 19, &out, &error));
    ck_assert_uint_le(out.count, ((size_t)1 << 19) + 65536);
    ck_assert_str_eq(error_text(&error), "the gzip'd data are more than 1 GiB");
    array_destroy(&out);
    free(file.data);
}
END_TEST

static const struct {
    const char *name;
    size_t primitives, lights, materials, shapes;
    int width, height, samples, depth;
} PUBLIC[] = {{"cornell-box/scene-v4.pbrt", 36, 2, 8, 8, 64, 64, 1, 5},
              {"cornell-box/gray.pbrt", 36, 2, 8, 8, 128, 128, 16, 8},
              {"veach-mis/scene-v4.pbrt", 55, 3, 6, 9, 1280, 720, 1, 4},
              {"veach-mis/gray.pbrt", 55, 3, 6, 9, 160, 90, 16, 8},
              {"veach-bidir/scene-v4.pbrt", 11544, 4, 4, 14, 1024, 1024, 64, 8},
              {"veach-bidir/gray.pbrt", 11544, 4, 4, 14, 128, 128, 16, 8},
              {"coffee/scene-v4.pbrt", 235047, 6, 8, 23, 800, 1000, 64, 18},
              {"coffee/gray.pbrt", 235047, 6, 8, 23, 104, 130, 16, 8}};

START_TEST(public_scenes)
{
    char path[1200];
    if (!test_public_scene(PUBLIC[_i].name, path, sizeof path))
        return;
    Scene scene;
    Error error = {{0}, {0}};
    ImportOptions options = {.lenient = false};
    scene_init(&scene);
    ck_assert_msg(pbrt_import(path, &options, &scene, &error), "%s", error.message);
    ck_assert_uint_eq(scene.primitives.count, PUBLIC[_i].primitives);
    ck_assert_uint_eq(scene.lights.count, PUBLIC[_i].lights);
    ck_assert_uint_eq(scene.materials.count, PUBLIC[_i].materials);
    ck_assert_uint_eq(scene.shapes.count, PUBLIC[_i].shapes);
    ck_assert_int_eq(scene.settings.width, PUBLIC[_i].width);
    ck_assert_int_eq(scene.settings.height, PUBLIC[_i].height);
    ck_assert_int_eq(scene.settings.samples, PUBLIC[_i].samples);
    ck_assert_int_eq(scene.settings.max_depth, PUBLIC[_i].depth);
    ck_assert_uint_eq(scene.counts.substitutions, 0);
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    scene_destroy(&scene);
}
END_TEST

TCase *import_files_case(void)
{
    TCase *tcase = tcase_create("files");
    tcase_set_timeout(tcase, 60);
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, include_shares_the_state);
    tcase_add_test(tcase, import_has_its_own_state);
    tcase_add_test(tcase, cycles_end);
    tcase_add_test(tcase, nesting_is_bounded);
    tcase_add_test(tcase, includes_are_bounded);
    tcase_add_test(tcase, devices_are_refused);
    tcase_add_test(tcase, compressed_files);
    tcase_add_test(tcase, compressed_files_are_bounded);
    tcase_add_loop_test(tcase, public_scenes, 0, (int)(sizeof PUBLIC / sizeof *PUBLIC));
    return tcase;
}
