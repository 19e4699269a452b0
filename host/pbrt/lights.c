/* LightSource and AreaLightSource. Scales follow pbrt-v4: before "scale", "power" or "illuminance" apply, a light's
 * spectrum is normalised to luminance 1; for an rgb value its illuminant is, so that rgb 1 1 1 gives pixels of 1 1
 * 1. */
#include "base/log.h"
#include "math/warp.h"
#include "pbrt/errors.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "pbrt/values.h"
#include "scene/light_setup.h"
#include "scene/portal_setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREES_TO_RADIANS (M_PI / 180.0)

typedef struct LightReader {
    PbrtImport *im;
    ParamList *list;
    Matrix ctm, inverse;
    Light light;
} LightReader;

static float scale_read(ParamList *list)
{
    float scale = param_float(list, "scale", 1.0f);
    if (scale < 0.0f)
        param_error(list, "scale", "\"scale\" of %s is negative", list->owner);
    return scale;
}

/* rgb x scale; an error if it overflows a float. */
static Vec3 emission_make(ParamList *list, const float rgb[3], double scale)
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

static void position_set(LightReader *r, const float from[3])
{
    double p[3];
    to_doubles(from, p);
    matrix_point(&r->ctm, p, p);
    r->light.position = vec3((float)p[0], (float)p[1], (float)p[2]);
    if (!vec3_finite(r->light.position))
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
        r->light.direction = vec3((float)(b[0] / length), (float)(b[1] / length), (float)(b[2] / length));
}

static void point_read(LightReader *r)
{
    float intensity[3] = {1.0f, 1.0f, 1.0f}, from[3] = {0.0f, 0.0f, 0.0f};
    value_color(r->im, r->list, "I", COLOR_ILLUMINANT, intensity);
    double scale = (double)scale_read(r->list);
    float power = param_float(r->list, "power", -1.0f);
    if (power > 0.0f)
        scale *= (double)power / (4.0 * M_PI);
    param_vector(r->list, "from", PARAM_POINT3, from);
    r->light.kind = LIGHT_POINT;
    r->light.emission = emission_make(r->list, intensity, scale);
    position_set(r, from);
}

/* With coneangle t and conedeltaangle d, the intensity is full within t - d and zero beyond t. */
static void spot_read(LightReader *r)
{
    float intensity[3] = {1.0f, 1.0f, 1.0f}, from[3] = {0.0f, 0.0f, 0.0f}, to[3] = {0.0f, 0.0f, 1.0f};
    value_color(r->im, r->list, "I", COLOR_ILLUMINANT, intensity);
    double scale = (double)scale_read(r->list);
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
    r->light.emission = emission_make(r->list, intensity, scale);
    r->light.cos_total = (float)cos_total;
    r->light.cos_falloff = (float)cos_falloff;
    position_set(r, from);
    direction_set(r, from, to);
}

/* L is the irradiance on a surface perpendicular to the light. */
static void distant_read(LightReader *r)
{
    float radiance[3] = {1.0f, 1.0f, 1.0f}, from[3] = {0.0f, 0.0f, 0.0f}, to[3] = {0.0f, 0.0f, 1.0f};
    value_color(r->im, r->list, "L", COLOR_ILLUMINANT, radiance);
    double scale = (double)scale_read(r->list);
    float illuminance = param_float(r->list, "illuminance", -1.0f);
    if (illuminance > 0.0f)
        scale *= (double)illuminance;
    param_vector(r->list, "from", PARAM_POINT3, from);
    param_vector(r->list, "to", PARAM_POINT3, to);
    r->light.kind = LIGHT_DISTANT;
    r->light.emission = emission_make(r->list, radiance, scale);
    direction_set(r, from, to);
}

/* Illuminance of an upward-facing plane by the upper half of a map: 4 pi times the mean of luminance times cosine over
 * directions. Texels of an octahedral map have equal solid angles, those of the other are smaller by the sine of the angle
 * from the pole: their mean sine is 2 / pi. */
static double map_illuminance(const Image *image, const float *rgb, bool equirectangular)
{
    double sum = 0.0;
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x) {
            Vec2 uv = vec2(((float)x + 0.5f) / (float)image->width, ((float)y + 0.5f) / (float)image->height);
            double z = equirectangular ? cos(M_PI * (double)uv.y) : (double)octahedral_to_sphere(uv).z;
            double weight = equirectangular ? 0.5 * M_PI * sin(M_PI * (double)uv.y) : 1.0;
            const float *p = &rgb[3 * ((size_t)y * (size_t)image->width + (size_t)x)];
            if (z > 0.0)
                sum += weight * z * (double)rgb_luminance(vec3(p[0], p[1], p[2]));
        }
    return 4.0 * M_PI * sum / ((double)image->width * (double)image->height);
}

/* pbrt multiplies by 2 pi where the integral over the sphere requires 4 pi; so does this, to give the same image. */
static double illuminance_scale(const Image *image, const float *rgb, bool equirectangular, float wanted)
{
    double found = 0.5 * map_illuminance(image, rgb, equirectangular);
    return found > 0.0 ? (double)wanted / found : 1.0;
}

static bool map_check(LightReader *r, const Image *image, const char *path)
{
    SourcePlace place = param_place(r->list, "filename");
    char what[96];
    if (image->channels < 3) {
        param_error(r->list, "filename", "%s is grey; the image of an infinite light needs red, green and blue", path);
        return false;
    }
    if (image->width == image->height || (r->light.flags & LIGHT_EQUIRECTANGULAR) != 0)
        return true;
    snprintf(what, sizeof what, "an infinite light's image that is not square (%d x %d)", image->width, image->height);
    if (!import_unsupported(r->im, place, what, "read as latitude and longitude",
                            "if it is a latitude-longitude map, add \"string mapping\" \"latlong\"; pbrt's imgtool "
                            "makeequiarea makes the square map that pbrt reads")) {
        r->list->failed = true;
        return false;
    }
    r->light.flags |= LIGHT_EQUIRECTANGULAR;
    return true;
}

/* A single value that is not finite would make the light's power not finite. */
static bool map_finite(LightReader *r, const float *rgb, size_t pixels, const char *path)
{
    for (size_t i = 0; i < 3 * pixels; ++i)
        if (!isfinite(rgb[i])) {
            param_error(r->list, "filename", "%s has pixels that are not finite and cannot be used as a light", path);
            return false;
        }
    return true;
}

static void map_load(LightReader *r, const Image *image, const char *path, float illuminance, double scale)
{
    static const float WHITE[3] = {1.0f, 1.0f, 1.0f};
    float *rgb = NULL;
    Error *error = r->list->error;
    if (!map_check(r, image, path))
        return;
    TextureImageOptions options = {.encoding = ENCODING_SRGB,
                                   .gamma = 1.0f,
                                   .wrap = r->light.flags & LIGHT_EQUIRECTANGULAR ? WRAP_REPEAT : WRAP_OCTAHEDRAL,
                                   .filter = FILTER_BILINEAR};
    size_t pixels = (size_t)image->width * (size_t)image->height;
    if (!image_linear_rgb(image, &rgb, error)) {
        r->list->failed = true;
        return;
    }
    if (map_finite(r, rgb, pixels, path)) {
        if (illuminance > 0.0f)
            scale *= illuminance_scale(image, rgb, (r->light.flags & LIGHT_EQUIRECTANGULAR) != 0, illuminance);
        if (r->light.kind == LIGHT_INFINITE)
            r->light.kind = LIGHT_INFINITE_IMAGE;
        r->light.emission = emission_make(r->list, WHITE, scale);
        r->list->failed = r->list->failed || !texture_image_add(r->im->scene, image, &options, &r->light.image, error);
    }
    free(rgb);
}

static void map_read(LightReader *r, const char *file, float illuminance, double scale)
{
    Image image;
    Error error = {{0}, {0}};
    if (r->im->options.needs)
        return;
    const char *path = r->list->failed ? NULL : import_path(r->im, file);
    if (!path) {
        r->list->failed = true;
        return;
    }
    if (!image_read(path, &image, &error)) {
        param_error(r->list, "filename", "infinite light: %s", error_text(&error));
        error_fix(r->list->error, "%s", error.fix);
        return;
    }
    map_load(r, &image, path, illuminance, scale);
    image_destroy(&image);
}

/* Only directions matter, so the transform may be rescaled; sampling assumes a scale of 1 (light/infinite.h). */
static void infinite_transform_set(LightReader *r)
{
    double scale = cbrt(fabs(matrix_determinant(&r->ctm)));
    if (!(scale > 0.0 && isfinite(scale)))
        scale = 1.0;
    Matrix to_world = r->ctm, to_light = r->inverse;
    for (int i = 0; i < 12; ++i) {
        to_world.m[i] /= scale;
        to_light.m[i] *= scale;
    }
    r->light.world_from_light = matrix_affine(to_world.m);
    r->light.light_from_world = matrix_affine(to_light.m);
}

/* "mapping", which pbrt does not have: how directions are laid out in the image. */
static void mapping_read(LightReader *r)
{
    const char *mapping = param_string(r->list, "mapping", "equalarea");
    if (strcmp(mapping, "latlong") == 0)
        r->light.flags |= LIGHT_EQUIRECTANGULAR;
    else if (strcmp(mapping, "equalarea") != 0) {
        param_error(r->list, "mapping", "unknown mapping \"%s\" of an infinite light", mapping);
        error_fix(r->list->error, "use equalarea or latlong");
    }
}

/* "portal": four points in world space; pbrt does not apply the current transform to them. */
static void portal_read(LightReader *r)
{
    size_t count = 0;
    const float *points = param_floats(r->list, "portal", PARAM_POINT3, &count);
    const float offset[3] = {r->im->offset.x, r->im->offset.y, r->im->offset.z};
    double corners[4][3];
    Portal portal;
    Error error = {{0}, {0}};
    if (!points)
        return;
    if (count != 12) {
        param_error(r->list, "portal", "the portal of an infinite light has %zu points instead of four", count / 3);
        error_fix(r->list->error, "give the four corners of a rectangle");
        return;
    }
    for (int i = 0; i < 12; ++i)
        corners[i / 3][i % 3] = (double)points[i] - (double)offset[i % 3];
    if (!portal_make(corners, &portal, &error)) {
        param_error(r->list, "portal", "%s", error_text(&error));
        error_fix(r->list->error, "%s", error.fix);
        return;
    }
    r->light.kind = LIGHT_PORTAL;
    r->list->failed = r->list->failed || !scene_add_portal(r->im->scene, &portal, &r->light.portal, r->list->error);
}

static void infinite_read(LightReader *r)
{
    float radiance[3] = {1.0f, 1.0f, 1.0f};
    bool has_radiance = value_color(r->im, r->list, "L", COLOR_ILLUMINANT, radiance);
    double scale = (double)scale_read(r->list);
    float illuminance = param_float(r->list, "illuminance", -1.0f);
    const char *file = param_string(r->list, "filename", "");
    r->light.kind = LIGHT_INFINITE;
    mapping_read(r);
    portal_read(r);
    if (has_radiance && *file)
        param_error(r->list, "filename", "an infinite light takes either L or filename");
    infinite_transform_set(r);
    if (*file) {
        map_read(r, file, illuminance, scale);
        return;
    }
    if (illuminance > 0.0f)
        scale *= (double)illuminance / M_PI;
    r->light.emission = emission_make(r->list, radiance, scale);
}

#define READER(NAME, name, text, feature, position) {text, name##_read},
static const struct {
    const char *name;
    void (*read)(LightReader *r);
} KINDS[] = {LIGHT_LIST_DELTA(READER){"infinite", infinite_read}};
#undef READER
#define KIND_COUNT (sizeof KINDS / sizeof *KINDS)

static bool light_other(PbrtImport *im, const char *kind)
{
    const char *names[KIND_COUNT];
    char what[64];
    for (size_t i = 0; i < KIND_COUNT; ++i)
        names[i] = KINDS[i].name;
    if (strcmp(kind, "goniometric") != 0 && strcmp(kind, "projection") != 0)
        return import_unknown(im, im->place, "light", kind, names, KIND_COUNT);
    snprintf(what, sizeof what, "the light \"%s\"", kind);
    return import_unsupported(im, im->place, what, "the light is left out", "use point or spot");
}

static bool light_add(LightReader *r)
{
    if (!param_list_finish(r->list, r->im->options.lenient))
        return false;
    if (vec3_is_zero(r->light.emission)) {
        log_message_at(LOG_INFO, r->list->place, "%s emits nothing and is left out", r->list->owner);
        return true;
    }
    return scene_add_light(r->im->scene, &r->light, r->im->error);
}

bool import_light(PbrtImport *im, const char *kind)
{
    ParamList list;
    char owner[96];
    LightReader reader = {.im = im, .list = &list};
    reader.light = (Light){
        .flags = im->state.outside << LIGHT_MEDIUM_SHIFT, .primitive = NONE, .image = NONE, .distribution = NONE};
    size_t i = 0;
    while (i < KIND_COUNT && strcmp(kind, KINDS[i].name) != 0)
        ++i;
    if (i == KIND_COUNT)
        return light_other(im, kind);
    if (!import_ctm_inverse(im, im->place, &reader.ctm, &reader.inverse))
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
    double scale = (double)scale_read(list);
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
    Vec3 product = emission_make(list, radiance, scale);
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
