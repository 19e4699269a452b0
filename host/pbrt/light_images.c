/* Lights with images: infinite, goniometric and projection lights. */
#include "image/read.h"
#include "math/warp.h"
#include "pbrt/errors.h"
#include "pbrt/light_reader.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "pbrt/values.h"
#include "scene/portal_setup.h"
#include "scene/texture_image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- images ------------------------------------------------------------------------------------------------------ */

static const float WHITE[3] = {1.0f, 1.0f, 1.0f};

/* A single value that is not finite would make the light's power not finite. */
static bool pixels_finite(LightReader *r, const float *rgb, size_t pixels, const char *path)
{
    for (size_t i = 0; i < 3 * pixels; ++i)
        if (!isfinite(rgb[i])) {
            param_error(r->list, "filename", "%s has pixels that are not finite and cannot be used as a light", path);
            return false;
        }
    return true;
}

/* The pixels of an image that becomes a light, as linear RGB, which the caller frees; NULL: an error is set. */
static float *image_pixels(LightReader *r, const Image *image, const char *path)
{
    float *rgb = NULL;
    if (!image_linear_rgb(image, &rgb, r->list->error))
        r->list->failed = true;
    else if (!pixels_finite(r, rgb, (size_t)image->width * (size_t)image->height, path)) {
        free(rgb);
        rgb = NULL;
    }
    return rgb;
}

/* Reads the light's image `file`; returns its path, or NULL if there is an error, or only needs are wanted. */
static const char *image_open(LightReader *r, const char *file, Image *image)
{
    Error error = {{0}, {0}};
    if (r->im->options.needs)
        return NULL;
    const char *path = r->list->failed ? NULL : import_path(r->im, file);
    if (!path) {
        r->list->failed = true;
        return NULL;
    }
    if (image_read(path, image, &error))
        return path;
    param_error(r->list, "filename", "%s: %s", r->list->owner, error_text(&error));
    error_fix(r->list->error, "%s", error.fix);
    return NULL;
}

/* Only directions matter, so the transforms between the light's space and the world may be rescaled; sampling assumes a
 * scale of 1 (light/infinite.h, light/intensity_image.h). */
static void directions_set(LightReader *r, Matrix to_world, Matrix to_light)
{
    double scale = cbrt(fabs(matrix_determinant(&to_world)));
    if (!(scale > 0.0 && isfinite(scale)))
        scale = 1.0;
    for (int i = 0; i < 12; ++i) {
        to_world.m[i] /= scale;
        to_light.m[i] *= scale;
    }
    r->light.detail.world_from_light = matrix_affine(to_world.m);
    r->light.detail.light_from_world = matrix_affine(to_light.m);
}

/* ---- infinite ---------------------------------------------------------------------------------------------------- */

/* Illuminance of an upward-facing plane by the upper half of a map: 4 pi times the mean of luminance times cosine over
 * directions. Texels of an octahedral map have equal solid angles, those of the other are smaller by the sine of the
 * angle from the pole: their mean sine is 2 / pi. */
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

static void map_load(LightReader *r, const Image *image, const char *path, float illuminance, double scale)
{
    float *rgb = map_check(r, image, path) ? image_pixels(r, image, path) : NULL;
    bool equirectangular = (r->light.flags & LIGHT_EQUIRECTANGULAR) != 0;
    TextureImageOptions options = {.encoding = ENCODING_SRGB,
                                   .gamma = 1.0f,
                                   .wrap = equirectangular ? WRAP_REPEAT : WRAP_OCTAHEDRAL,
                                   .filter = FILTER_BILINEAR};
    if (!rgb)
        return;
    if (illuminance > 0.0f)
        scale *= illuminance_scale(image, rgb, equirectangular, illuminance);
    if (r->light.kind == LIGHT_INFINITE)
        r->light.kind = LIGHT_INFINITE_IMAGE;
    r->light.emission = light_emission_make(r->list, WHITE, scale);
    r->list->failed =
        r->list->failed || !texture_image_add(r->im->scene, image, &options, &r->light.detail.image, r->list->error);
    free(rgb);
}

static void map_read(LightReader *r, const char *file, float illuminance, double scale)
{
    Image image;
    const char *path = image_open(r, file, &image);
    if (!path)
        return;
    map_load(r, &image, path, illuminance, scale);
    image_destroy(&image);
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
    r->list->failed =
        r->list->failed || !scene_add_portal(r->im->scene, &portal, &r->light.detail.portal, r->list->error);
}

void infinite_read(LightReader *r)
{
    float radiance[3] = {1.0f, 1.0f, 1.0f};
    bool has_radiance = value_color(r->im, r->list, "L", COLOR_ILLUMINANT, radiance);
    double scale = (double)light_scale_read(r->list);
    float illuminance = param_float(r->list, "illuminance", -1.0f);
    const char *file = param_string(r->list, "filename", "");
    r->light.kind = LIGHT_INFINITE;
    mapping_read(r);
    portal_read(r);
    if (has_radiance && *file)
        param_error(r->list, "filename", "an infinite light takes either L or filename");
    directions_set(r, r->ctm, r->inverse);
    if (*file) {
        map_read(r, file, illuminance, scale);
        return;
    }
    if (illuminance > 0.0f)
        scale *= (double)illuminance / M_PI;
    r->light.emission = light_emission_make(r->list, radiance, scale);
}

/* ---- lights at a point ------------------------------------------------------------------------------------------- */

/* Adds the light's image, whose texels give the intensity. */
static void intensity_add(LightReader *r, const Image *image)
{
    TextureImageOptions options = {
        .encoding = ENCODING_SRGB, .gamma = 1.0f, .wrap = WRAP_CLAMP, .filter = FILTER_POINT};
    r->list->failed =
        r->list->failed || !texture_image_add(r->im->scene, image, &options, &r->light.detail.image, r->list->error);
}

static const char *intensity_open(LightReader *r, Image *image)
{
    const char *file = param_string(r->list, "filename", "");
    if (*file)
        return image_open(r, file, image);
    param_error(r->list, "filename", "%s has no image", r->list->owner);
    error_fix(r->list->error, "give one by \"filename\"; a light without image is a point or spot light");
    return NULL;
}

/* Replaces the pixels by their means over red, green and blue, `count` of them; returns the sum of these. */
static double pixels_grey(float *rgb, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        rgb[i] = vec3_mean(vec3(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]));
        sum += fmax((double)rgb[i], 0.0);
    }
    return sum;
}

/* The light's emission is set from intensity, scale and power. */
static void goniometric_load(LightReader *r, const Image *image, const char *path, const float intensity[3],
                             double scale)
{
    float power = param_float(r->list, "power", -1.0f);
    if (image->width != image->height) {
        param_error(r->list, "filename", "%s is not square (%d x %d) and thus not the map of a goniometric light", path,
                    image->width, image->height);
        error_fix(r->list->error, "pbrt's imgtool makeequiarea makes the square map of a latitude-longitude map");
        return;
    }
    float *pixels = image_pixels(r, image, path);
    if (!pixels)
        return;
    size_t count = (size_t)image->width * (size_t)image->height;
    double mean = pixels_grey(pixels, count) / (double)count;
    if (power > 0.0f && mean > 0.0)
        scale *= (double)power / (4.0 * M_PI * mean);
    const Image grey = {
        .width = image->width, .height = image->height, .channels = 1, .is_float = true, .data = pixels};
    r->light.emission = light_emission_make(r->list, intensity, scale);
    intensity_add(r, &grey);
    free(pixels);
}

/* As in pbrt, the map's z axis is the y axis of the current space. */
void goniometric_read(LightReader *r)
{
    static const Matrix SWAP = {{1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1}};
    static const float ORIGIN[3] = {0.0f, 0.0f, 0.0f};
    float intensity[3] = {1.0f, 1.0f, 1.0f};
    value_color(r->im, r->list, "I", COLOR_ILLUMINANT, intensity);
    double scale = (double)light_scale_read(r->list);
    Image image;
    r->light.kind = LIGHT_GONIOMETRIC;
    r->light.emission = vec3(intensity[0], intensity[1], intensity[2]);
    light_position_set(r, ORIGIN);
    directions_set(r, matrix_multiply(&r->ctm, &SWAP), matrix_multiply(&SWAP, &r->inverse));
    const char *path = intensity_open(r, &image);
    if (!path)
        return;
    goniometric_load(r, &image, path, intensity, scale);
    image_destroy(&image);
}

/* The half extents of a projected image at distance 1: the shorter side subtends the angle fov. */
static void projection_extent(const Image *image, float fov, double extent[2])
{
    double half = tan(0.5 * (double)fov * (M_PI / 180.0));
    double aspect = (double)image->width / (double)image->height;
    extent[0] = aspect > 1.0 ? half * aspect : half;
    extent[1] = aspect > 1.0 ? half : half / aspect;
}

/* Integral of the luminance over the solid angle. */
static double projection_flux(const Image *image, const float *rgb, const double extent[2])
{
    double sum = 0.0, area = 4.0 * extent[0] * extent[1];
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x) {
            double px = extent[0] * (2.0 * (x + 0.5) / image->width - 1.0);
            double py = extent[1] * (2.0 * (y + 0.5) / image->height - 1.0);
            const float *p = &rgb[3 * ((size_t)y * (size_t)image->width + (size_t)x)];
            sum += (double)rgb_luminance(vec3(p[0], p[1], p[2])) * pow(1.0 + px * px + py * py, -1.5);
        }
    return area * sum / ((double)image->width * (double)image->height);
}

/* The unit vector in the world of a vector of the current space. */
static Vec3 world_direction(const LightReader *r, double x, double y, double z)
{
    const double local[3] = {x, y, z};
    double d[3];
    matrix_vector(&r->ctm, local, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return vec3((float)(d[0] / length), (float)(d[1] / length), (float)(d[2] / length));
}

/* Sets the light's transforms, its axis, and the largest angle from it that a corner of the image has. */
static void projection_directions_set(LightReader *r, const double extent[2])
{
    const Matrix image = matrix_scale(extent[0], extent[1], 1.0);
    const Matrix square = matrix_scale(1.0 / extent[0], 1.0 / extent[1], 1.0);
    LightDetail *light = &r->light.detail;
    directions_set(r, matrix_multiply(&r->ctm, &image), matrix_multiply(&square, &r->inverse));
    light->direction = world_direction(r, 0.0, 0.0, 1.0);
    light->cos_total = 1.0f;
    for (int corner = 0; corner < 4; ++corner) {
        double x = (corner & 1) != 0 ? extent[0] : -extent[0], y = (corner & 2) != 0 ? extent[1] : -extent[1];
        light->cos_total = float_min(light->cos_total, vec3_dot(world_direction(r, x, y, 1.0), light->direction));
    }
    light->cos_falloff = light->cos_total;
}

static void projection_load(LightReader *r, const Image *image, const char *path, float fov, double scale)
{
    double extent[2];
    float power = param_float(r->list, "power", -1.0f);
    if (image->channels < 3) {
        param_error(r->list, "filename", "%s is grey; the image of a projection light needs red, green and blue", path);
        return;
    }
    float *rgb = image_pixels(r, image, path);
    if (!rgb)
        return;
    projection_extent(image, fov, extent);
    projection_directions_set(r, extent);
    double flux = projection_flux(image, rgb, extent);
    if (power > 0.0f && flux > 0.0)
        scale *= (double)power / flux;
    r->light.emission = light_emission_make(r->list, WHITE, scale);
    intensity_add(r, image);
    free(rgb);
}

/* Projects along the z axis of the current space, y up, x to the right in its left-handed sense, as a camera there
 * sees. */
void projection_read(LightReader *r)
{
    static const float ORIGIN[3] = {0.0f, 0.0f, 0.0f};
    double scale = (double)light_scale_read(r->list);
    float fov = param_float(r->list, "fov", 90.0f);
    Image image;
    r->light.kind = LIGHT_PROJECTION;
    r->light.emission = vec3(1.0f, 1.0f, 1.0f);
    light_position_set(r, ORIGIN);
    if (!(fov > 0.0f && fov < 180.0f))
        param_error(r->list, "fov", "\"fov\" must be above 0 and below 180 degrees");
    const char *path = intensity_open(r, &image);
    if (!path)
        return;
    projection_load(r, &image, path, fov, scale);
    image_destroy(&image);
}
