/* LightSource and AreaLightSource. Scales follow pbrt-v4: before "scale", "power" or "illuminance" apply, a light's
 * spectrum is normalised to luminance 1; for an rgb value its illuminant is, so that rgb 1 1 1 gives pixels of 1 1
 * 1. */
#include "base/log.h"
#include "pbrt/errors.h"
#include "pbrt/light_reader.h"
#include "pbrt/media_places.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "pbrt/values.h"
#include "scene/light_setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREES_TO_RADIANS (M_PI / 180.0)

float light_scale_read(ParamList *list)
{
    float scale = param_float(list, "scale", 1.0f);
    if (scale < 0.0f)
        param_error(list, "scale", "\"scale\" of %s is negative", list->owner);
    return scale;
}

Vec3 light_emission_make(ParamList *list, const float rgb[3], double scale)
{
    Vec3 emission =
        vec3((float)((double)rgb[0] * scale), (float)((double)rgb[1] * scale), (float)((double)rgb[2] * scale));
    if (!vec3_finite(emission))
        param_error(list, "scale", "the emission of %s overflows", list->owner);
    return emission;
}

static void to_doubles(const float in[3], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = (double)in[i];
}

void light_position_set(LightReader *r, const float from[3])
{
    double p[3];
    to_doubles(from, p);
    matrix_point(&r->ctm, p, p);
    r->light.detail.position = vec3((float)p[0], (float)p[1], (float)p[2]);
    if (!vec3_finite(r->light.detail.position))
        param_error(r->list, "from", "the position of %s is not finite", r->list->owner);
}

/* Sets the unit vector from `from` to `to` in world space. */
static void direction_set(LightReader *r, const float from[3], const float to[3])
{
    double a[3], b[3];
    to_doubles(from, a);
    to_doubles(to, b);
    for (int i = 0; i < 3; ++i)
        b[i] -= a[i];
    matrix_vector(&r->ctm, b, b);
    double length = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    if (!(length > 0.0) || !isfinite(length))
        param_error(r->list, "to", "%s has no direction: \"from\" and \"to\" coincide", r->list->owner);
    else
        r->light.detail.direction = vec3((float)(b[0] / length), (float)(b[1] / length), (float)(b[2] / length));
}

static void point_read(LightReader *r)
{
    float intensity[3] = {1.0f, 1.0f, 1.0f}, from[3] = {0.0f, 0.0f, 0.0f};
    value_color(r->im, r->list, "I", COLOR_ILLUMINANT, intensity);
    double scale = (double)light_scale_read(r->list);
    float power = param_float(r->list, "power", -1.0f);
    if (power > 0.0f)
        scale *= (double)power / (4.0 * M_PI);
    param_vector(r->list, "from", PARAM_POINT3, from);
    r->light.kind = LIGHT_POINT;
    r->light.emission = light_emission_make(r->list, intensity, scale);
    light_position_set(r, from);
}

/* With coneangle t and conedeltaangle d, the intensity is full within t - d and zero beyond t. */
static void spot_read(LightReader *r)
{
    float intensity[3] = {1.0f, 1.0f, 1.0f}, from[3] = {0.0f, 0.0f, 0.0f}, to[3] = {0.0f, 0.0f, 1.0f};
    value_color(r->im, r->list, "I", COLOR_ILLUMINANT, intensity);
    double scale = (double)light_scale_read(r->list);
    float cone = param_float(r->list, "coneangle", 30.0f), delta = param_float(r->list, "conedeltaangle", 5.0f);
    float power = param_float(r->list, "power", -1.0f);
    param_vector(r->list, "from", PARAM_POINT3, from);
    param_vector(r->list, "to", PARAM_POINT3, to);
    if (!(cone > 0.0f && cone <= 180.0f))
        param_error(r->list, "coneangle", "\"coneangle\" must be above 0 and at most 180 degrees");
    if (!(delta >= 0.0f && delta <= cone))
        param_error(r->list, "conedeltaangle", "\"conedeltaangle\" must be from 0 to coneangle");
    double cos_total = cos((double)cone * DEGREES_TO_RADIANS);
    double cos_falloff = cos(((double)cone - (double)delta) * DEGREES_TO_RADIANS);
    if (power > 0.0f)
        scale *= (double)power / light_spot_solid_angle(cos_total, cos_falloff);
    r->light.kind = LIGHT_SPOT;
    r->light.emission = light_emission_make(r->list, intensity, scale);
    r->light.detail.cos_total = (float)cos_total;
    r->light.detail.cos_falloff = (float)cos_falloff;
    light_position_set(r, from);
    direction_set(r, from, to);
}

/* L is the irradiance on a surface perpendicular to the light. */
static void distant_read(LightReader *r)
{
    float radiance[3] = {1.0f, 1.0f, 1.0f}, from[3] = {0.0f, 0.0f, 0.0f}, to[3] = {0.0f, 0.0f, 1.0f};
    value_color(r->im, r->list, "L", COLOR_ILLUMINANT, radiance);
    double scale = (double)light_scale_read(r->list);
    float illuminance = param_float(r->list, "illuminance", -1.0f);
    if (illuminance > 0.0f)
        scale *= (double)illuminance;
    param_vector(r->list, "from", PARAM_POINT3, from);
    param_vector(r->list, "to", PARAM_POINT3, to);
    r->light.kind = LIGHT_DISTANT;
    r->light.emission = light_emission_make(r->list, radiance, scale);
    direction_set(r, from, to);
}

#define READER(NAME, name, text, feature, position) {text, name##_read, (position) != 0},
static const struct {
    const char *name;
    void (*read)(LightReader *r);
    bool position;
} KINDS[] = {LIGHT_LIST_DELTA(READER){"infinite", infinite_read, false}};
#undef READER
#define KIND_COUNT (sizeof KINDS / sizeof *KINDS)

static bool kind_missing(PbrtImport *im, const char *kind)
{
    const char *names[KIND_COUNT];
    for (size_t i = 0; i < KIND_COUNT; ++i)
        names[i] = KINDS[i].name;
    return import_unknown(im, im->place, "light", kind, names, KIND_COUNT);
}

static bool light_add(LightReader *r)
{
    if (!param_list_finish(r->list, r->im->options.lenient))
        return false;
    if (vec3_is_zero(r->light.emission)) {
        log_message_at(LOG_INFO, r->list->place, "%s emits nothing and is left out", r->list->owner);
        return true;
    }
    size_t first = r->im->scene->lights.count;
    return scene_add_light(r->im->scene, &r->light, r->im->error) && media_places_lights(r->im, first);
}

bool import_light(PbrtImport *im, const char *kind)
{
    ParamList list;
    char owner[96];
    LightReader reader = {.im = im, .list = &list};
    reader.light = (LightData){.detail = {.image = NONE, .distribution = NONE, .medium = im->state.outside}};
    size_t i = 0;
    while (i < KIND_COUNT && strcmp(kind, KINDS[i].name) != 0)
        ++i;
    if (i == KIND_COUNT)
        return kind_missing(im, kind);
    if (!import_ctm_inverse(im, im->place, !KINDS[i].position, &reader.ctm, &reader.inverse))
        return false;
    snprintf(owner, sizeof owner, "the %s light", kind);
    import_list(im, &list, owner, ATTRIBUTE_LIGHT);
    KINDS[i].read(&reader);
    bool good = light_add(&reader);
    param_list_destroy(&list);
    return good;
}

static void area_read(PbrtImport *im, ParamList *list, AreaEmission *emission)
{
    float radiance[3] = {1.0f, 1.0f, 1.0f};
    bool has_radiance = value_color(im, list, "L", COLOR_ILLUMINANT, radiance);
    double scale = (double)light_scale_read(list);
    float power = param_float(list, "power", -1.0f);
    emission->flags = param_bool(list, "twosided", false) ? LIGHT_TWO_SIDED : 0u;
    const Param *file = param_find(list, "filename", PARAM_BIT(PARAM_STRING));
    if (file && has_radiance)
        param_error(list, "filename", "an area light takes either L or filename");
    if (file && !list->failed)
        list->failed = !import_unsupported(im, file->place, "an image of emission (filename of an area light)",
                                           "constant emission of 1", "give L");
    emission->by_power = power > 0.0f;
    if (emission->by_power)
        scale *= (double)power;
    Vec3 product = light_emission_make(list, radiance, scale);
    emission->radiance[0] = product.x;
    emission->radiance[1] = product.y;
    emission->radiance[2] = product.z;
}

bool value_area_emission(PbrtImport *im, AreaEmission *emission, bool *present)
{
    static const char *const KNOWN[] = {"diffuse"};
    const AreaLightSource *source = im->state.area_light;
    ParamList list;
    *present = false;
    if (!source)
        return true;
    if (strcmp(source->kind, "diffuse") != 0)
        return import_unknown(im, source->place, "area light", source->kind, KNOWN, 1);
    param_list_init(&list, "the area light", source->place, im->error);
    param_list_add_set(&list, source->params, false);
    param_list_add_set(&list, source->attributes, true);
    area_read(im, &list, emission);
    bool good = param_list_finish(&list, im->options.lenient);
    param_list_destroy(&list);
    *present =
        good && !(emission->radiance[0] == 0.0f && emission->radiance[1] == 0.0f && emission->radiance[2] == 0.0f);
    return good;
}
