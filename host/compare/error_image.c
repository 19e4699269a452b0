#include "compare/error_image.h"

#include "base/path_name.h"
#include "image/color.h"
#include "image/contact_sheet.h"
#include "image/exr.h"
#include "image/png_write.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

bool error_image_path_check(const char *path, Error *error)
{
    if (path_ends(path, ".exr") || path_ends(path, ".png"))
        return true;
    error_set(error, "%s does not end in .exr or .png", path);
    return error_fix(error, "choose the format by the ending of the name");
}

void error_color(float relative, float rgb[3])
{
    if (!isfinite(relative)) {
        rgb[0] = rgb[2] = 1.0f;
        rgb[1] = 0.0f;
        return;
    }
    /* Maps three decades, 0.001 ... 1, to [0, 1]. The first channel rises over the whole range, the second over its
     * upper half, the third over its last quarter: black, red, yellow, white, or black, blue, cyan, white. */
    float t = fabsf(relative) > 1e-3f ? fminf(log10f(fabsf(relative)) / 3.0f + 1.0f, 1.0f) : 0.0f;
    float ramp[3] = {t, fmaxf(2.0f * t - 1.0f, 0.0f), 0.6f * fmaxf(4.0f * t - 3.0f, 0.0f)};
    for (int c = 0; c < 3; ++c)
        rgb[c] = ramp[relative > 0.0f ? c : 2 - c];
}

void magnitude_color(float magnitude, float rgb[3])
{
    /* sRGB, in even steps of lightness */
    static const double STOPS[][3] = {
        {0.0, 0.0, 0.02}, {0.32, 0.07, 0.48}, {0.72, 0.22, 0.47}, {0.98, 0.54, 0.38}, {0.99, 0.99, 0.75}};
    const int last = (int)(sizeof STOPS / sizeof STOPS[0]) - 1;
    double place = last * fmin(fmax((double)magnitude, 0.0), 1.0);
    int stop = place < last ? (int)place : last - 1;
    for (int c = 0; c < 3; ++c)
        rgb[c] = (float)color_srgb_decode(STOPS[stop][c] + (place - stop) * (STOPS[stop + 1][c] - STOPS[stop][c]));
}

static double pixel_mean(const float *rgb)
{
    return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3.0;
}

/* Fills `out` with one relative error per pixel. */
static void relative_fill(const float *image, const float *reference, size_t pixels, float *out)
{
    double sum = 0.0;
    for (size_t i = 0; i < pixels; ++i) {
        double mean = pixel_mean(reference + 3 * i);
        sum += isfinite(mean) ? mean : 0.0;
    }
    double floor_value = 0.01 * fabs(sum / (double)pixels);
    for (size_t i = 0; i < pixels; ++i) {
        double a = pixel_mean(image + 3 * i), r = pixel_mean(reference + 3 * i);
        out[i] = a == r ? 0.0f : (float)((a - r) / (fabs(r) + floor_value));
    }
}

static bool exr_error_write(const char *path, const float *image, const float *reference, int width, int height,
                            Error *error)
{
    size_t pixels = (size_t)width * (size_t)height;
    float *difference = malloc(4 * pixels * sizeof *difference);
    if (!difference)
        return error_memory(error, 4 * pixels * sizeof *difference, "an error image");
    float *relative = difference + 3 * pixels;
    for (size_t i = 0; i < 3 * pixels; ++i)
        difference[i] = image[i] - reference[i];
    relative_fill(image, reference, pixels, relative);
    const ExrChannel channels[] = {{"R", difference, 3, false},
                                   {"G", difference + 1, 3, false},
                                   {"B", difference + 2, 3, false},
                                   {"relative.Y", relative, 1, false}};
    bool good = exr_write(path, channels, 4, width, height, NULL, NULL, 0, error);
    free(difference);
    return good;
}

bool error_image_rgb(const float *image, const float *reference, int width, int height, float *rgb, Error *error)
{
    size_t pixels = (size_t)width * (size_t)height;
    float *relative = malloc(pixels * sizeof *relative);
    if (!relative)
        return error_memory(error, pixels * sizeof *relative, "an error image");
    relative_fill(image, reference, pixels, relative);
    for (size_t i = 0; i < pixels; ++i)
        error_color(relative[i], rgb + 3 * i);
    free(relative);
    return true;
}

static bool png_error_write(const char *path, const float *image, const float *reference, int width, int height,
                            Error *error)
{
    size_t values = 3 * (size_t)width * (size_t)height;
    float *rgb = malloc(values * sizeof *rgb);
    if (!rgb)
        return error_memory(error, values * sizeof *rgb, "an error image");
    bool good = error_image_rgb(image, reference, width, height, rgb, error) &&
                png_write(path, rgb, width, height, 0.0f, error);
    free(rgb);
    return good;
}

bool error_image_write(const char *path, const float *image, const float *reference, int width, int height,
                       Error *error)
{
    if (!error_image_path_check(path, error))
        return false;
    return (path_ends(path, ".exr") ? exr_error_write : png_error_write)(path, image, reference, width, height, error);
}

bool error_image_side_by_side(const char *path, const float *image, const float *reference, int width, int height,
                              double exposure, Error *error)
{
    size_t values = 3 * (size_t)width * (size_t)height;
    ContactSheet sheet = {0};
    float *map = malloc(values * sizeof *map), factor = (float)exp2(exposure);
    if (!map)
        return error_memory(error, values * sizeof *map, "an error image");
    bool good = error_image_rgb(image, reference, width, height, map, error) &&
                contact_sheet_init(&sheet, width, height, 3, 1, error);
    if (good) {
        contact_sheet_put(&sheet, 0, 0, image, factor, "1");
        contact_sheet_put(&sheet, 1, 0, reference, factor, "2");
        contact_sheet_put(&sheet, 2, 0, map, 1.0f, "3");
        good = png_write(path, sheet.rgb, sheet.width, sheet.height, 0.0f, error);
    }
    contact_sheet_destroy(&sheet);
    free(map);
    return good;
}
