#include "pbrt/import.h"

#include "base/file_read.h"
#include "base/log.h"
#include "pbrt/directives.h"
#include "pbrt/errors.h"
#include "pbrt/late.h"
#include "pbrt/media_places.h"
#include "pbrt/parser.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "scene/center.h"
#include "scene/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void import_init(PbrtImport *im, const ImportOptions *options, Scene *scene, Error *error)
{
    memset(im, 0, sizeof *im);
    im->scene = scene;
    im->options = *options;
    im->error = error;
    im->directory = "";
    param_buffer_init(&im->params);
    state_init(&im->state);
    im->world = box_empty();
    array_init(&im->saved, sizeof(StateSave));
    name_table_init(&im->coordinate_systems);
    array_init(&im->coordinate_matrices, sizeof(Matrix));
    name_table_init(&im->objects);
    array_init(&im->object_definitions, sizeof(ImportObject));
    im->open_object = -1;
    name_table_init(&im->materials);
    name_table_init(&im->late_names);
    array_init(&im->late_uses, sizeof(LateUse));
    array_init(&im->late_materials, sizeof(LateMaterial));
    name_table_init(&im->float_textures);
    name_table_init(&im->spectrum_textures);
    array_init(&im->textures, sizeof(ImportTexture));
    name_table_init(&im->media);
    array_init(&im->media_seen, sizeof(MediumSeen));
    texture_cache_init(&im->images);
    if (options->memory) {
        im->images.read = options->memory->image;
        im->images.owner = options->memory->owner;
    }
    im->default_material = NONE;
    im->iso = 100.0f;
    im->balance = vec3_splat(1.0f);
    im->shutter_close = 1.0f;
}

static void import_destroy(PbrtImport *im)
{
    parser_close_all(im);
    param_buffer_destroy(&im->params);
    array_destroy(&im->saved);
    name_table_destroy(&im->coordinate_systems);
    array_destroy(&im->coordinate_matrices);
    name_table_destroy(&im->objects);
    array_destroy(&im->object_definitions);
    name_table_destroy(&im->materials);
    name_table_destroy(&im->late_names);
    array_destroy(&im->late_uses);
    array_destroy(&im->late_materials);
    name_table_destroy(&im->float_textures);
    name_table_destroy(&im->spectrum_textures);
    array_destroy(&im->textures);
    name_table_destroy(&im->media);
    array_destroy(&im->media_seen);
    texture_cache_destroy(&im->images);
    arena_destroy(&im->arena);
}

static void counts_report(const Scene *scene)
{
    const SceneCounts *counts = &scene->counts;
    if (counts->degenerate_triangles > 0)
        log_message(LOG_WARNING, "%lu primitives of zero area were dropped", counts->degenerate_triangles);
    if (counts->zero_area_lights > 0)
        log_message(LOG_WARNING, "%lu of them were area lights", counts->zero_area_lights);
}

/* A scene file or, if `path` is NULL, a text in memory. */
typedef struct ImportSource {
    const char *path, *text;
    size_t length;
    const char *name, *directory; /* of a text */
} ImportSource;

static bool source_open(PbrtImport *im, const ImportSource *source)
{
    if (!source->path) {
        TextWindow window;
        im->directory = source->directory;
        text_window_from_memory(&window, source->text, source->length);
        return parser_open_text(im, &window, source->name);
    }
    const char *slash = strrchr(source->path, '/');
    size_t length = slash ? (size_t)(slash - source->path) + 1 : 0;
    im->directory = arena_text(&im->arena, source->path, length, im->error);
    return im->directory && parser_open_file(im, source->path, (SourcePlace){0}, false);
}

/* White balance multiplies the channels of the image. They are independent of each other, so it may as well multiply
 * those of all that emits; chains then see the brightness that the image has. */
static void balance_apply(const PbrtImport *im)
{
    Vec3 b = im->balance;
    if (b.x == 1.0f && b.y == 1.0f && b.z == 1.0f)
        return;
    for (size_t i = 0; i < im->scene->lights.count; ++i) {
        Light *light = &ARRAY_AT(&im->scene->lights, Light, i);
        light->emission = vec3_mul(light->emission, b);
    }
    for (size_t i = 0; i < im->scene->media.count; ++i) {
        Medium *medium = &ARRAY_AT(&im->scene->media, Medium, i);
        medium->emission = vec3_mul(medium->emission, b);
    }
}

/* Reads the scene with *offset subtracted. *offset becomes the offset that should be subtracted; 0: none. */
static bool source_read(const ImportSource *source, const ImportOptions *options, Vec3 *offset, Scene *scene,
                        Error *error)
{
    PbrtImport im;
    import_init(&im, options, scene, error);
    im.offset = scene->origin = *offset;
    media_places_reset(&im);
    bool good = source_open(&im, source) && directives_read(&im) && late_materials_finish(&im) && media_check(&im) &&
                media_places_names(&im);
    good = errors_end(&im) && good;
    balance_apply(&im);
    camera_move(&scene->camera_settings, im.offset);
    scene->movable = true;
    *offset = good && !box_is_empty(&im.world) ? scene_center_offset(&im.world) : vec3_splat(0.0f);
    import_destroy(&im);
    return good;
}

/* The world's position is known only after reading. A world far from the origin is read again, without repeating
 * messages. */
static bool source_import(const ImportSource *source, const ImportOptions *options, Scene *scene, Error *error)
{
    Vec3 offset = vec3_splat(0.0f);
    if (!source_read(source, options, &offset, scene, error))
        return false;
    if (!vec3_is_zero(offset)) {
        scene_destroy(scene);
        scene_init(scene);
        log_mute(true);
        bool good = source_read(source, options, &offset, scene, error);
        log_mute(false);
        if (!good)
            return false;
    }
    counts_report(scene);
    return true;
}

bool pbrt_import(const char *path, const ImportOptions *options, Scene *scene, Error *error)
{
    const ImportSource source = {.path = path};
    return source_import(&source, options, scene, error);
}

bool pbrt_import_text(const char *text, size_t length, const char *name, const char *directory,
                      const ImportOptions *options, Scene *scene, Error *error)
{
    const ImportSource source = {.text = text, .length = length, .name = name, .directory = directory};
    return source_import(&source, options, scene, error);
}

static void line_drop(const char *line, void *context)
{
    (void)line;
    (void)context;
}

bool pbrt_needs(const char *path, SceneNeeds *needs, Error *error)
{
    const ImportOptions options = {.all_errors = true, .needs = needs};
    FileData text = {0};
    Vec3 offset = vec3_splat(0.0f);
    Scene scene;
    bool piped = strcmp(path, "-") == 0;
    if (piped && !file_read_stream(STDIN_FILENO, "standard input", IMPORT_FILE_BYTES_MAX, &text, error))
        return false;
    const ImportSource source = {
        .path = piped ? NULL : path, .text = text.data, .length = text.size, .name = "stdin", .directory = ""};
    scene_init(&scene);
    log_sink_set(line_drop, NULL); /* `needs` has what they say */
    bool good = source_read(&source, &options, &offset, &scene, error);
    log_sink_set(NULL, NULL);
    scene_destroy(&scene);
    free(text.data);
    return good;
}

bool pbrt_load(const char *path, bool lenient, Scene *scene, Error *error)
{
    MediaPlaces places;
    const ImportOptions options = {.lenient = lenient, .all_errors = true, .places = &places};
    FileData text = {0};
    bool piped = strcmp(path, "-") == 0;
    media_places_init(&places);
    bool good = piped ? file_read_stream(STDIN_FILENO, "standard input", IMPORT_FILE_BYTES_MAX, &text, error) &&
                            pbrt_import_text(text.data, text.size, "stdin", "", &options, scene, error)
                      : pbrt_import(path, &options, scene, error);
    free(text.data);
    good = good && (scene_finish(scene, error) || error_in(error, piped ? "stdin" : path)) &&
           media_places_check(&places, scene, error);
    media_places_destroy(&places);
    return good;
}
