/* MakeNamedMedium, and the media that MediumInterface names. */
#include "pbrt/errors.h"
#include "pbrt/media_presets.h"
#include "pbrt/readers.h"
#include "pbrt/values.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool medium_number(PbrtImport *im, const char *name, SourcePlace place, uint *number)
{
    *number = *name ? name_table_find(&im->media, name) : 0;
    if (*number != NONE)
        return true;
    const Medium blank = {.g = 0.0f};
    MediumSeen *seen = array_grow(&im->media_seen, 1, im->error);
    const char *kept = seen ? arena_text(&im->arena, name, strlen(name), im->error) : NULL;
    if (!kept)
        return false;
    *seen = (MediumSeen){.name = kept, .place = place};
    return scene_add_medium(im->scene, &blank, number, im->error) &&
           name_table_add(&im->media, kept, *number, im->error);
}

bool media_check(PbrtImport *im)
{
    for (size_t i = 0; i < im->media_seen.count; ++i) {
        const MediumSeen *seen = &ARRAY_AT(&im->media_seen, MediumSeen, i);
        if (seen->defined)
            continue;
        errors_missing(im);
        error_at(im->error, seen->place, "unknown medium \"%s\"", seen->name);
        error_fix(im->error, "define it with MakeNamedMedium \"%s\" \"string type\" \"homogeneous\"", seen->name);
        if (!errors_note(im, false))
            return false;
    }
    return true;
}

/* ---- homogeneous media ------------------------------------------------------------------------------------------- */

/* pbrt's default, in both coefficients: its preset for whole milk. */
#define DEFAULT_PRESET "Wholemilk"

static const MediumPreset *preset_find(const char *name)
{
    for (size_t i = 0; i < MEDIUM_PRESET_COUNT; ++i)
        if (strcmp(MEDIUM_PRESETS[i].name, name) == 0)
            return &MEDIUM_PRESETS[i];
    return NULL;
}

static const MediumPreset *preset_read(PbrtImport *im, ParamList *list)
{
    const char *name = param_string(list, "preset", "");
    const MediumPreset *preset = *name ? preset_find(name) : NULL;
    if (preset || !*name || list->failed)
        return preset;
    const char *names[MEDIUM_PRESET_COUNT];
    for (size_t i = 0; i < MEDIUM_PRESET_COUNT; ++i)
        names[i] = MEDIUM_PRESETS[i].name;
    list->failed =
        !import_unknown(im, param_place(list, "preset"), "preset of a medium", name, names, MEDIUM_PRESET_COUNT);
    return NULL;
}

/* A coefficient: a colour, a spectrum or a number; *out is unchanged if it is absent. */
static void coefficient_read(PbrtImport *im, ParamList *list, const char *name, float out[3])
{
    const Param *param = param_find(list, name, PARAM_BIT(PARAM_FLOAT) | PARAM_COLORS);
    if (param && param->type == PARAM_FLOAT) {
        out[0] = out[1] = out[2] = param_float(list, name, 0.0f);
        if (out[0] < 0.0f)
            param_error(list, name, "\"%s\" is negative", name);
    } else if (param) {
        value_color(im, list, name, COLOR_INDEX, out);
    }
}

/* scale * coefficients; an error if that overflows a float. */
static Vec3 coefficients_scale(ParamList *list, const float c[3], double scale)
{
    Vec3 scaled = vec3((float)((double)c[0] * scale), (float)((double)c[1] * scale), (float)((double)c[2] * scale));
    if (!vec3_finite(scaled))
        param_error(list, "scale", "the coefficients of %s overflow", list->owner);
    return scaled;
}

static float positive_read(ParamList *list, const char *name)
{
    float value = param_float(list, name, 1.0f);
    if (value < 0.0f)
        param_error(list, name, "\"%s\" of %s is negative", name, list->owner);
    return value;
}

static void homogeneous_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    const MediumPreset *preset = preset_read(im, list), *milk = preset_find(DEFAULT_PRESET);
    float absorption[3], scattering[3], emission[3] = {0.0f, 0.0f, 0.0f};
    memcpy(absorption, milk->absorption, sizeof absorption);
    memcpy(scattering, milk->scattering, sizeof scattering);
    coefficient_read(im, list, "sigma_a", absorption);
    coefficient_read(im, list, "sigma_s", scattering);
    value_color(im, list, "Le", COLOR_ILLUMINANT, emission);
    double scale = (double)positive_read(list, "scale"), brightness = (double)positive_read(list, "Lescale");
    medium->g = param_float(list, "g", 0.0f);
    if (!(medium->g > -1.0f && medium->g < 1.0f))
        param_error(list, "g", "\"g\" of a medium must be above -1 and below 1");
    Vec3 absorbed = coefficients_scale(list, preset ? preset->absorption : absorption, scale);
    medium->scattering = coefficients_scale(list, preset ? preset->scattering : scattering, scale);
    medium->extinction = vec3_add(absorbed, medium->scattering);
    medium->emission = vec3_mul(absorbed, vec3_scale(vec3(emission[0], emission[1], emission[2]), (float)brightness));
    if (!vec3_finite(medium->extinction) || !vec3_finite(medium->emission))
        param_error(list, "scale", "the coefficients of %s overflow", list->owner);
}

static bool medium_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    static const char *const UNSUPPORTED[] = {"uniformgrid", "rgbgrid", "cloud", "nanovdb"};
    static const char *const KNOWN[] = {"homogeneous"};
    const char *type = param_string(list, "type", NULL);
    if (!type) {
        param_error(list, "type", "%s lacks \"string type\"", list->owner);
        return error_fix(im->error, "add \"string type\" \"homogeneous\"");
    }
    for (size_t i = 0; i < sizeof UNSUPPORTED / sizeof *UNSUPPORTED; ++i)
        if (strcmp(type, UNSUPPORTED[i]) == 0) {
            char what[64];
            snprintf(what, sizeof what, "a medium of type \"%s\"", type);
            return import_unsupported(im, param_place(list, "type"), what, "empty space", "use \"homogeneous\"");
        }
    if (strcmp(type, KNOWN[0]) != 0)
        return import_unknown(im, param_place(list, "type"), "type of medium", type, KNOWN, 1);
    homogeneous_read(im, list, medium);
    return param_list_finish(list, im->options.lenient);
}

bool import_named_medium(PbrtImport *im, const char *name)
{
    ParamList list;
    char owner[96];
    uint number;
    Medium medium = {.g = 0.0f};
    if (!*name) {
        error_at(im->error, im->place, "a medium has the name \"\", which stands for empty space");
        return error_fix(im->error, "give it another name");
    }
    if (!medium_number(im, name, im->place, &number))
        return false;
    MediumSeen *seen = &ARRAY_AT(&im->media_seen, MediumSeen, number - 1);
    if (seen->defined) {
        error_at(im->error, im->place, "the medium \"%s\" is defined twice", name);
        return error_fix(im->error, "rename one of the two");
    }
    seen->defined = true;
    snprintf(owner, sizeof owner, "the medium \"%s\"", name);
    import_list(im, &list, owner, ATTRIBUTE_MEDIUM);
    bool good = medium_read(im, &list, &medium);
    if (good)
        ARRAY_AT(&im->scene->media, Medium, number) = medium;
    param_list_destroy(&list);
    return good;
}
