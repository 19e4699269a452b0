#include "pbrt/values.h"

#include "base/log.h"
#include "geometry/texture.h"
#include "pbrt/errors.h"

#include <math.h>
#include <string.h>

/* Turns an error without a place, from a module that knows nothing of the scene file, into one at the parameter. */
static void error_move(ParamList *list, const Param *param, const Error *found)
{
    error_at(list->error, param->place, "%s", error_text(found));
    if (found->fix[0])
        error_fix(list->error, "%s", found->fix);
    list->failed = true;
}

/* Reads a spectrum named in pbrt, else a file of samples. */
static void spectrum_named(PbrtImport *im, ParamList *list, const Param *param, ColorRole role, float rgb[3])
{
    Error error = {{0}, {0}}, file_error = {{0}, {0}};
    if (param->count != 1) {
        param_error(list, param->name, "\"spectrum %s\" takes one name", param->name);
        return;
    }
    if (color_named_spectrum(param->strings[0], role, rgb, &error))
        return;
    bool is_file = strchr(param->strings[0], '.') || strchr(param->strings[0], '/');
    const char *path = is_file ? import_path(im, param->strings[0]) : NULL;
    if (path && color_spectrum_file(path, role, rgb, &file_error))
        return;
    error_move(list, param, path ? &file_error : &error);
}

static void spectrum_sampled(ParamList *list, const Param *param, ColorRole role, float rgb[3])
{
    Error error = {{0}, {0}};
    if (!color_from_samples(param->floats, param->count / 2, role, rgb, &error))
        error_move(list, param, &error);
}

static void blackbody(ParamList *list, const Param *param, ColorRole role, float rgb[3])
{
    if (param->count != 1)
        param_error(list, param->name, "\"blackbody %s\" has %zu values instead of one temperature in kelvin",
                    param->name, param->count);
    else if (!(param->floats[0] > 0.0f))
        param_error(list, param->name, "the temperature of a blackbody must be above 0 kelvin");
    else if (role != COLOR_ILLUMINANT)
        param_error(list, param->name, "\"%s\" is not the colour of a light: a blackbody is not possible here",
                    param->name);
    else
        color_blackbody(param->floats[0], rgb);
}

static void color_convert(PbrtImport *im, ParamList *list, const Param *param, ColorRole role, float rgb[3])
{
    if (param->type == PARAM_BLACKBODY)
        blackbody(list, param, role, rgb);
    else if (param->type == PARAM_SPECTRUM && param->is_text)
        spectrum_named(im, list, param, role, rgb);
    else if (param->type == PARAM_SPECTRUM)
        spectrum_sampled(list, param, role, rgb);
    else if (param->count != 3)
        param_error(list, param->name, "\"rgb %s\" has %zu values instead of 3", param->name, param->count);
    else
        memcpy(rgb, param->floats, 3 * sizeof *rgb);
}

static void color_check(ParamList *list, const char *name, ColorRole role, const float rgb[3])
{
    for (int c = 0; c < 3; ++c) {
        if (!isfinite(rgb[c]) || rgb[c] < 0.0f)
            param_error(list, name, "\"%s\" has a negative component", name);
        else if (role == COLOR_REFLECTANCE && rgb[c] > 1.0f)
            param_error(list, name, "\"%s\" is an albedo and has a component above 1: %g", name, (double)rgb[c]);
    }
}

bool value_color(PbrtImport *im, ParamList *list, const char *name, ColorRole role, float rgb[3])
{
    const Param *param = param_find(list, name, PARAM_COLORS);
    if (!param)
        return false;
    float color[3] = {0.0f, 0.0f, 0.0f};
    color_convert(im, list, param, role, color);
    color_check(list, name, role, color);
    if (list->failed)
        return false;
    memcpy(rgb, color, sizeof color);
    return true;
}

uint value_texture_index(PbrtImport *im, ParamList *list, const Param *param, bool spectrum)
{
    const NameTable *table = spectrum ? &im->spectrum_textures : &im->float_textures;
    const char *type = spectrum ? "spectrum" : "float", *name = param->strings[0];
    if (param->count != 1) {
        param_error(list, param->name, "\"texture %s\" takes one name", param->name);
        return NONE;
    }
    uint texture = name_table_find(table, name);
    if (texture != NONE || list->failed)
        return texture;
    const NameTable *other = spectrum ? &im->float_textures : &im->spectrum_textures;
    const char *nearest = name_table_nearest(table, name);
    errors_missing(im);
    param_error(list, param->name, "unknown %s texture \"%s\" for parameter \"%s\"", type, name, param->name);
    if (name_table_find(other, name) != NONE)
        error_fix(list->error, "there is a %s texture of that name; \"%s\" needs a %s texture",
                  spectrum ? "float" : "spectrum", param->name, type);
    else if (nearest)
        error_fix(list->error, "did you mean \"%s\"?", nearest);
    else
        error_fix(list->error, "define it with Texture before this line");
    return NONE;
}

static void texture_use(PbrtImport *im, ParamList *list, uint texture, Vec3 *value, uint *program)
{
    const ImportTexture *found = &ARRAY_AT(&im->textures, ImportTexture, texture);
    *program = NONE;
    if (found->count == 1 && found->ops[0].code == TEXTURE_CONSTANT)
        *value = found->ops[0].value;
    else if (!texture_program(im, texture, program))
        list->failed = true;
}

bool value_color_param(PbrtImport *im, ParamList *list, const char *name, ColorRole role, ColorParam *out)
{
    const Param *param = param_find(list, name, PARAM_COLORS | PARAM_BIT(PARAM_TEXTURE));
    if (!param)
        return false;
    if (param->type == PARAM_TEXTURE) {
        uint texture = value_texture_index(im, list, param, true);
        if (texture != NONE)
            texture_use(im, list, texture, &out->value, &out->program);
        return !list->failed;
    }
    float rgb[3];
    if (!value_color(im, list, name, role, rgb))
        return false;
    *out = (ColorParam){.value = vec3(rgb[0], rgb[1], rgb[2]), .program = NONE};
    return true;
}

bool value_float_param(PbrtImport *im, ParamList *list, const char *name, FloatParam *out)
{
    const Param *param = param_find(list, name, PARAM_BIT(PARAM_FLOAT) | PARAM_BIT(PARAM_TEXTURE));
    if (!param)
        return false;
    if (param->type == PARAM_FLOAT) {
        *out = (FloatParam){.value = param_float(list, name, out->value), .program = NONE};
        return !list->failed;
    }
    Vec3 value = vec3_splat(out->value);
    uint texture = value_texture_index(im, list, param, false);
    if (texture != NONE)
        texture_use(im, list, texture, &value, &out->program);
    out->value = value.x;
    return !list->failed;
}

/* Points per side of the square over which a texture is averaged. */
#define MEAN_SIDE 64

float value_texture_mean(const PbrtImport *im, uint program, float unread)
{
    const SceneView view = {.features = ~(ulong)0,
                            .texture_ops = im->scene->texture_ops.data,
                            .images = im->scene->images.data,
                            .texels = im->scene->texels.data,
                            .lookup = im->scene->lookup.data};
    double sum = 0.0;
    if (im->options.needs)
        return unread;
    for (int y = 0; y < MEAN_SIDE; ++y)
        for (int x = 0; x < MEAN_SIDE; ++x) {
            Vec2 uv = vec2(((float)x + 0.5f) / MEAN_SIDE, ((float)y + 0.5f) / MEAN_SIDE);
            const TexturePoint point = {.p = vec3(uv.x, uv.y, 0.0f), .uv = uv, .n = vec3(0.0f, 0.0f, 1.0f)};
            sum += (double)texture_eval_float(&view, program, &point);
        }
    return (float)(sum / (MEAN_SIDE * MEAN_SIDE));
}

/* Limits of eta are this and its inverse: no material is beyond them, and squares of eta remain normal floats. */
#define ETA_LEAST 0.01f

float value_eta(PbrtImport *im, ParamList *list, const char *name, float fallback)
{
    const Param *param = param_find(list, name, PARAM_BIT(PARAM_FLOAT) | PARAM_COLORS);
    float eta = fallback;
    if (param && param->type == PARAM_FLOAT) {
        eta = param_float(list, name, fallback);
    } else if (param) {
        float rgb[3];
        if (!value_color(im, list, name, COLOR_INDEX, rgb))
            return fallback;
        eta = (rgb[0] + rgb[1] + rgb[2]) / 3.0f;
        if (rgb[0] != rgb[1] || rgb[1] != rgb[2])
            log_message_at(LOG_INFO, param->place, "dispersion is not supported: %s is %g for all colours", name,
                           (double)eta);
    }
    if (!(eta >= ETA_LEAST && eta <= 1.0f / ETA_LEAST))
        param_error(list, name, "the index of refraction \"%s\" must be from %g to %g", name, (double)ETA_LEAST,
                    1.0 / (double)ETA_LEAST);
    return eta;
}

static bool ops_append(PbrtImport *im, const TextureOp *ops, uint count, uint *program)
{
    *program = (uint)im->scene->texture_ops.count;
    TextureOp *out = array_grow(&im->scene->texture_ops, (size_t)count + 1, im->error);
    if (!out)
        return false;
    memcpy(out, ops, count * sizeof *ops);
    out[count] = (TextureOp){.code = TEXTURE_END};
    return true;
}

uint value_constant_program(PbrtImport *im, float value)
{
    TextureOp op = {.code = TEXTURE_CONSTANT, .value = vec3_splat(value)};
    uint program;
    return ops_append(im, &op, 1, &program) ? program : NONE;
}

bool texture_program(PbrtImport *im, uint texture, uint *program)
{
    ImportTexture *found = &ARRAY_AT(&im->textures, ImportTexture, texture);
    if (found->program == NONE && !ops_append(im, found->ops, found->count, &found->program))
        return false;
    *program = found->program;
    return true;
}

bool value_image(PbrtImport *im, SourcePlace place, const char *path, const TextureImageOptions *options,
                 const char *what, uint *index)
{
    Error error = {{0}, {0}};
    *index = NONE;
    if (im->options.needs || texture_image_load(im->scene, &im->images, path, options, index, &error))
        return true;
    error_at(im->error, place, "%s: %s", what, error_text(&error));
    if (error.fix[0])
        error_fix(im->error, "%s", error.fix);
    return false;
}
