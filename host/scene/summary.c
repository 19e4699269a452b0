#include "scene/summary.h"

#include "base/json.h"
#include "layout/scene_view.h"

#include <inttypes.h>
#include <string.h>

static const char *const PRIMITIVE_NAMES[PRIMITIVE_KINDS] = {"triangle", "bilinear", "sphere",
                                                             "disk",     "cylinder", "curve"};
#define TEXT(NAME, name, text, traits) text,
static const char *const MATERIAL_NAMES[MATERIAL_KINDS] = {MATERIAL_LIST(TEXT)};
#define LIGHT_TEXT(NAME, name, text, feature, position) text,
static const char *const LIGHT_NAMES[LIGHT_KINDS] = {LIGHT_LIST(LIGHT_TEXT)};
#undef LIGHT_TEXT
static const char *const FEATURE_NAMES[FEATURE_COUNT] = {FEATURE_LIST(TEXT)};
#undef TEXT

void scene_summary(const Scene *scene, SceneSummary *summary)
{
    memset(summary, 0, sizeof *summary);
    /* The importer's array is already freed; the packed buffer holds the same primitives. */
    const uint *words = scene->geometry_words.data;
    const Primitive *primitives = (const Primitive *)(words + scene->frame.scene.layout.primitives);
    for (size_t i = 0; i < scene->primitive_count; ++i)
        ++summary->primitives[(primitives[i].shape_and_kind >> PRIMITIVE_KIND_SHIFT) % PRIMITIVE_KINDS];
    for (size_t i = 0; i < scene->materials.count; ++i)
        ++summary->materials[ARRAY_AT(&scene->materials, Material, i).kind];
    for (size_t i = 0; i < scene->lights.count; ++i)
        ++summary->lights[light_kind(&ARRAY_AT(&scene->lights, Light, i))];
    for (size_t i = 0; i < scene->texture_ops.count; ++i)
        summary->textures += ARRAY_AT(&scene->texture_ops, TextureOp, i).code == TEXTURE_END;
    summary->images = scene->images.count;
    summary->media = scene->media.count > 0 ? scene->media.count - 1 : 0;
    summary->objects = scene->objects.count > 0 ? scene->objects.count - 1 : 0;
    summary->instances = scene->instances.count;
}

static void counts_text(FILE *stream, const char *title, const size_t *counts, const char *const *names, int kinds)
{
    size_t total = 0;
    for (int i = 0; i < kinds; ++i)
        total += counts[i];
    fprintf(stream, "%-14s%zu", title, total);
    const char *separator = "  (";
    for (int i = 0; i < kinds; ++i) {
        if (counts[i] == 0)
            continue;
        fprintf(stream, "%s%zu %s", separator, counts[i], names[i]);
        separator = ", ";
    }
    fputs(total > 0 ? ")\n" : "\n", stream);
}

void scene_summary_text(const Scene *scene, const SceneSummary *summary, const char *path, FILE *stream)
{
    const SceneSettings *settings = &scene->settings;
    const float *low = scene->bounds_min, *high = scene->bounds_max;
    fprintf(stream, "%-14s%s\n", "scene", path);
    fprintf(stream, "%-14s%d x %d, crop %d,%d,%d,%d\n", "film", settings->width, settings->height, settings->crop[0],
            settings->crop[1], settings->crop[2], settings->crop[3]);
    fprintf(stream, "%-14s%d per pixel, paths of up to %d segments\n", "samples", settings->samples,
            settings->max_depth);
    counts_text(stream, "primitives", summary->primitives, PRIMITIVE_NAMES, PRIMITIVE_KINDS);
    fprintf(stream, "%-14s%zu of %zu objects\n", "instances", summary->instances, summary->objects);
    counts_text(stream, "materials", summary->materials, MATERIAL_NAMES, MATERIAL_KINDS);
    counts_text(stream, "lights", summary->lights, LIGHT_NAMES, LIGHT_KINDS);
    fprintf(stream, "%-14s%zu, %zu images\n", "textures", summary->textures, summary->images);
    fprintf(stream, "%-14s%zu\n", "media", summary->media);
    fprintf(stream, "%-14s(%g, %g, %g) to (%g, %g, %g)\n", "bounds", (double)low[0], (double)low[1], (double)low[2],
            (double)high[0], (double)high[1], (double)high[2]);
    fprintf(stream, "%-14s0x%06" PRIx64 " ", "features", scene->features);
    for (int bit = 0; bit < FEATURE_COUNT; ++bit)
        if (scene->features >> bit & 1u)
            fprintf(stream, " %s%s", FEATURE_NAMES[bit], scene->features >> bit > 1u ? "," : "");
    fprintf(stream, "\n%-14s%.3f MB\n", "memory", 1e-6 * (double)scene_bytes(scene));
    fprintf(stream, "%-14s%lu degenerate triangles, %lu lights without area, %lu substitutions\n", "dropped",
            scene->counts.degenerate_triangles, scene->counts.zero_area_lights, scene->counts.substitutions);
}

static void counts_json(JsonWriter *json, const char *key, const size_t *counts, const char *const *names, int kinds)
{
    json_object_begin(json, key);
    for (int i = 0; i < kinds; ++i)
        json_unsigned(json, names[i], counts[i]);
    json_object_end(json);
}

static void vector_json(JsonWriter *json, const char *key, const float *v)
{
    json_array_begin(json, key);
    for (int i = 0; i < 3; ++i)
        json_number(json, NULL, (double)v[i]);
    json_array_end(json);
}

void scene_summary_json(const Scene *scene, const SceneSummary *summary, const char *path, FILE *stream)
{
    JsonWriter json;
    json_init(&json, stream);
    json_object_begin(&json, NULL);
    json_text(&json, "scene", path);
    json_signed(&json, "width", scene->settings.width);
    json_signed(&json, "height", scene->settings.height);
    json_signed(&json, "samples", scene->settings.samples);
    json_signed(&json, "max_depth", scene->settings.max_depth);
    counts_json(&json, "primitives", summary->primitives, PRIMITIVE_NAMES, PRIMITIVE_KINDS);
    json_unsigned(&json, "objects", summary->objects);
    json_unsigned(&json, "instances", summary->instances);
    counts_json(&json, "materials", summary->materials, MATERIAL_NAMES, MATERIAL_KINDS);
    counts_json(&json, "lights", summary->lights, LIGHT_NAMES, LIGHT_KINDS);
    json_unsigned(&json, "textures", summary->textures);
    json_unsigned(&json, "images", summary->images);
    json_unsigned(&json, "media", summary->media);
    vector_json(&json, "bounds_min", scene->bounds_min);
    vector_json(&json, "bounds_max", scene->bounds_max);
    json_unsigned(&json, "feature_mask", scene->features);
    json_array_begin(&json, "features");
    for (int bit = 0; bit < FEATURE_COUNT; ++bit)
        if (scene->features >> bit & 1u)
            json_text(&json, NULL, FEATURE_NAMES[bit]);
    json_array_end(&json);
    json_unsigned(&json, "bytes", scene_bytes(scene));
    json_unsigned(&json, "degenerate_triangles", scene->counts.degenerate_triangles);
    json_unsigned(&json, "zero_area_lights", scene->counts.zero_area_lights);
    json_unsigned(&json, "substitutions", scene->counts.substitutions);
    json_object_end(&json);
}
