#include "image/rendering_file.h"

#include "image/exr.h"
#include "image/read.h"

#include <stdlib.h>

static bool half_load(const char *path, const char *layer, float **rgb, Error *error)
{
    Image image;
    bool found = false;
    if (!image_read_layer(path, layer, &image, &found, error))
        return false;
    bool good = !found || image_linear_rgb(&image, rgb, error);
    image_destroy(&image);
    return good;
}

bool rendering_load(const char *path, Rendering *rendering, Error *error)
{
    *rendering = (Rendering){0};
    bool good = image_read_rgb(path, &rendering->rgb, &rendering->width, &rendering->height, error) &&
                half_load(path, "halfA", &rendering->halves[0], error) &&
                half_load(path, "halfB", &rendering->halves[1], error);
    if (!good)
        rendering_destroy(rendering);
    return good;
}

void rendering_destroy(Rendering *rendering)
{
    free(rendering->rgb);
    free(rendering->halves[0]);
    free(rendering->halves[1]);
    *rendering = (Rendering){0};
}

bool rendering_has_halves(const Rendering *rendering)
{
    return rendering->halves[0] && rendering->halves[1];
}

bool rendering_mean_write(const char *path, float *const halves[2], int width, int height, bool layers, Error *error)
{
    size_t values = 3 * (size_t)width * (size_t)height;
    const float *a = halves[0], *b = halves[1];
    float *mean = malloc(values * sizeof *mean);
    if (!mean)
        return error_memory(error, values * sizeof *mean, "a mean");
    for (size_t i = 0; i < values; ++i)
        mean[i] = 0.5f * (a[i] + b[i]);
    const ExrChannel channels[] = {
        {"R", mean, 3, !layers},  {"G", mean + 1, 3, !layers},  {"B", mean + 2, 3, !layers},
        {"halfA.R", a, 3, false}, {"halfA.G", a + 1, 3, false}, {"halfA.B", a + 2, 3, false},
        {"halfB.R", b, 3, false}, {"halfB.G", b + 1, 3, false}, {"halfB.B", b + 2, 3, false}};
    bool good = exr_write(path, channels, layers ? 9 : 3, width, height, error);
    free(mean);
    return good;
}

bool rendering_same_size(const Rendering *a, const char *a_path, const Rendering *b, const char *b_path, Error *error)
{
    if (a->width == b->width && a->height == b->height)
        return true;
    error_set(error, "the sizes differ: %s has %d x %d pixels, %s has %d x %d", a_path, a->width, a->height, b_path,
              b->width, b->height);
    return error_fix(error, "render or crop both to one size");
}
