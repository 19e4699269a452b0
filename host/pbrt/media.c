/* MakeNamedMedium, and the media that MediumInterface names. */
#include "pbrt/media.h"

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

/* ---- coefficients ------------------------------------------------------------------------------------------------ */

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

Vec3 medium_coefficients_scale(ParamList *list, Vec3 c, double scale)
{
    Vec3 scaled = vec3((float)((double)c.x * scale), (float)((double)c.y * scale), (float)((double)c.z * scale));
    if (!vec3_finite(scaled))
        param_error(list, "scale", "the coefficients of %s overflow", list->owner);
    return scaled;
}

float medium_factor_read(ParamList *list, const char *name)
{
    float value = param_float(list, name, 1.0f);
    if (value < 0.0f)
        param_error(list, name, "\"%s\" of %s is negative", name, list->owner);
    return value;
}

float medium_emission_factor_read(ParamList *list)
{
    if (!param_find(list, "Lescale", ~0u))
        return medium_factor_read(list, "LeScale");
    param_ignore(list, "LeScale");
    return medium_factor_read(list, "Lescale");
}

void medium_g_read(ParamList *list, Medium *medium)
{
    medium->g = param_float(list, "g", 0.0f);
    if (!(medium->g > -1.0f && medium->g < 1.0f))
        param_error(list, "g", "\"g\" of a medium must be above -1 and below 1");
}

static Vec3 vec3_of(const float v[3])
{
    return vec3(v[0], v[1], v[2]);
}

void medium_coefficients_read(PbrtImport *im, ParamList *list, const float fallback[2][3], Medium *medium,
                              Vec3 *absorption)
{
    const MediumPreset *preset = preset_read(im, list);
    float absorbed[3], scattered[3];
    memcpy(absorbed, fallback[0], sizeof absorbed);
    memcpy(scattered, fallback[1], sizeof scattered);
    coefficient_read(im, list, "sigma_a", absorbed);
    coefficient_read(im, list, "sigma_s", scattered);
    double scale = (double)medium_factor_read(list, "scale");
    medium_g_read(list, medium);
    *absorption = medium_coefficients_scale(list, vec3_of(preset ? preset->absorption : absorbed), scale);
    medium->scattering = medium_coefficients_scale(list, vec3_of(preset ? preset->scattering : scattered), scale);
    medium->extinction = medium_coefficients_scale(list, vec3_add(*absorption, medium->scattering), 1.0);
}

/* ---- media ------------------------------------------------------------------------------------------------------- */

static bool homogeneous_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    float milk[2][3], emission[3] = {0.0f, 0.0f, 0.0f}; /* pbrt's default */
    const MediumPreset *preset = preset_find("Wholemilk");
    memcpy(milk[0], preset->absorption, sizeof milk[0]);
    memcpy(milk[1], preset->scattering, sizeof milk[1]);
    Vec3 absorption;
    medium_coefficients_read(im, list, milk, medium, &absorption);
    value_color(im, list, "Le", COLOR_ILLUMINANT, emission);
    Vec3 radiance = vec3_scale(vec3_of(emission), medium_emission_factor_read(list));
    medium->emission = medium_coefficients_scale(list, vec3_mul(absorption, radiance), 1.0);
    return !list->failed;
}

typedef struct MediumType {
    const char *name;
    bool (*read)(PbrtImport *im, ParamList *list, Medium *medium);
} MediumType;

static const MediumType TYPES[] = {{"homogeneous", homogeneous_read},
                                   {"uniformgrid", medium_uniform_grid_read},
                                   {"rgbgrid", medium_rgb_grid_read},
                                   {"nanovdb", medium_nanovdb_read},
                                   {"cloud", medium_cloud_read}};
enum { TYPE_COUNT = sizeof TYPES / sizeof *TYPES };

static bool medium_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    const char *names[TYPE_COUNT];
    const char *type = param_string(list, "type", NULL);
    if (!type) {
        param_error(list, "type", "%s lacks \"string type\"", list->owner);
        return error_fix(im->error, "add \"string type\" \"homogeneous\"");
    }
    for (size_t i = 0; i < TYPE_COUNT; ++i) {
        names[i] = TYPES[i].name;
        if (strcmp(type, names[i]) == 0)
            return import_use(im, "MakeNamedMedium", type) && TYPES[i].read(im, list, medium) &&
                   param_list_finish(list, im->options.lenient);
    }
    return import_unknown(im, param_place(list, "type"), "type of medium", type, names, TYPE_COUNT);
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
