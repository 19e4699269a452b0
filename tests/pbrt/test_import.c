#include "pbrt/test_import.h"

#include "base/log.h"

#include <string.h>

static char log_text[8192];

static void log_collect(const char *line, void *context)
{
    (void)context;
    size_t used = strlen(log_text);
    snprintf(log_text + used, sizeof log_text - used, "%s\n", line);
}

const char *import_log(void)
{
    static char copy[sizeof log_text];
    memcpy(copy, log_text, sizeof copy);
    log_text[0] = '\0';
    return copy;
}

const char *import_tests_dir(void)
{
    static char path[1024];
    snprintf(path, sizeof path, "%s/tests", test_source_folder());
    return path;
}

void import_text_in(const char *text, const char *directory, bool lenient, Scene *scene)
{
    ImportOptions options = {.lenient = lenient};
    Error error = {{0}, {0}};
    import_log();
    scene_init(scene);
    bool good = pbrt_import_text(text, strlen(text), "test.pbrt", directory, &options, scene, &error);
    ck_assert_msg(good, "%s", error.message);
}

void import_text(const char *text, Scene *scene)
{
    import_text_in(text, "/nonexistent", false, scene);
}

void import_world(const char *text, Scene *scene)
{
    size_t size = strlen(text) + 64;
    char *whole = malloc(size);
    ck_assert_ptr_nonnull(whole);
    snprintf(whole, size, "Camera \"perspective\"\nWorldBegin\n%s", text);
    import_text(whole, scene);
    free(whole);
}

const char *import_error(const char *text)
{
    static Error error;
    ImportOptions options = {.lenient = false};
    Scene scene;
    scene_init(&scene);
    error = (Error){{0}, {0}};
    bool good = pbrt_import_text(text, strlen(text), "test.pbrt", "/nonexistent", &options, &scene, &error);
    scene_destroy(&scene);
    ck_assert_msg(!good, "accepted: %s", text);
    return error.message;
}

void assert_vec3(Vec3 a, float x, float y, float z, float tolerance)
{
    bool near = fabsf(a.x - x) <= tolerance && fabsf(a.y - y) <= tolerance && fabsf(a.z - z) <= tolerance;
    ck_assert_msg(near, "(%.9g %.9g %.9g), not (%.9g %.9g %.9g)", (double)a.x, (double)a.y, (double)a.z, (double)x,
                  (double)y, (double)z);
}

int main(void)
{
    Suite *suite = suite_create("import");
    log_sink_set(log_collect, NULL);
    suite_add_tcase(suite, import_text_case());
    suite_add_tcase(suite, import_params_case());
    suite_add_tcase(suite, import_transform_case());
    suite_add_tcase(suite, import_settings_case());
    suite_add_tcase(suite, import_shapes_case());
    suite_add_tcase(suite, import_subdivide_case());
    suite_add_tcase(suite, import_objects_case());
    suite_add_tcase(suite, import_materials_case());
    suite_add_tcase(suite, import_media_case());
    suite_add_tcase(suite, import_nanovdb_case());
    suite_add_tcase(suite, import_places_case());
    suite_add_tcase(suite, import_textures_case());
    suite_add_tcase(suite, import_lights_case());
    suite_add_tcase(suite, import_ply_case());
    suite_add_tcase(suite, import_files_case());
    suite_add_tcase(suite, import_limits_case());
    suite_add_tcase(suite, import_bad_case());
    suite_add_tcase(suite, import_corpus_case());
    return test_run(suite);
}
