#include "render_output.h"

#include "config.h"

#include "exr.h"
#include "output_file.h"
#include "path_name.h"
#include "png_write.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* target = `path` with its ending (if it has one) replaced by `ending`; as it is when it ends so already, in any case. */
static bool path_with_ending(char target[PATH_MAX], const char *path, const char *ending, Error *error)
{
    const char *name = path_file_name(path);
    const char *dot = strrchr(name, '.');
    bool ends = path_ends(path, ending);
    size_t stem = dot && dot != name && !ends ? (size_t)(dot - path) : strlen(path);
    if (stem + strlen(ending) >= PATH_MAX) {
        error_set(error, "the file name is too long: %.200s...", path);
        return error_fix(error, "give a shorter one with --output");
    }
    snprintf(target, PATH_MAX, "%.*s%s", (int)stem, path, ends ? "" : ending);
    return true;
}

bool render_output_name(RenderOutput *output, const Scene *scene, const char *scene_file, const char *exr,
                        bool want_png, const char *png, double exposure, Error *error)
{
    const char *film_name = path_file_name(scene->settings.output);
    const char *base = exr ? exr : film_name[0] ? film_name : path_file_name(scene_file);
    output->png[0] = '\0';
    output->film_scale = scene->settings.film_scale;
    output->exposure = (float)exposure;
    if (!path_with_ending(output->exr, base, ".exr", error))
        return false;
    return !want_png || path_with_ending(output->png, png ? png : output->exr, ".png", error);
}

bool render_output_check(const char *path, Error *error)
{
    struct stat status;
    if (stat(path, &status) == 0 && S_ISDIR(status.st_mode)) {
        error_set(error, "cannot write %s: it is a folder", path);
        return error_fix(error, "give the name of a file in it");
    }
    OutputFile file = {.descriptor = -1};
    bool writable = output_file_begin(&file, path, error);
    output_file_cancel(&file);
    return writable;
}

/* Whether two names lead to one file: the same file on disk, or the same name of one that is not there yet. */
static bool path_same(const char *a, const char *b)
{
    struct stat status_a, status_b;
    if (stat(a, &status_a) == 0 && stat(b, &status_b) == 0)
        return S_ISREG(status_a.st_mode) && status_a.st_dev == status_b.st_dev && status_a.st_ino == status_b.st_ino;
    while (strncmp(a, "./", 2) == 0)
        a += 2;
    while (strncmp(b, "./", 2) == 0)
        b += 2;
    return strcmp(a, b) == 0;
}

bool render_output_distinct(const RenderOutput *output, const char *stats, const char *trace, Error *error)
{
    const struct {
        const char *what, *path;
    } files[] = {{"the scene", output->scene_file},
                 {"the image", output->exr},
                 {"the PNG", output->png[0] ? output->png : NULL},
                 {"the statistics", stats},
                 {"the trace", trace}};
    for (size_t i = 0; i < sizeof files / sizeof *files; ++i)
        for (size_t j = 0; j < i; ++j)
            if (files[i].path && files[j].path && path_same(files[i].path, files[j].path)) {
                error_set(error, "%s would overwrite %s: %s", files[i].what, files[j].what, files[i].path);
                return error_fix(error, "give each its own name, with --output, --png, --stats and --trace");
            }
    return true;
}

/* Layers of an image of chains: what path tracing saw, and what the chains brought. Together they are the picture. */
#define LAYER_COUNT 2
#define LAYER_CHANNELS(name, rgb)                                                                                      \
    {name ".B", (rgb) + 2, 3, false}, {name ".G", (rgb) + 1, 3, false},                                                \
    {                                                                                                                  \
        name ".R", rgb, 3, false                                                                                       \
    }

static bool exr_output_write(const RenderOutput *output, const Film *film, const float *rgb, double samples_per_pixel,
                             Error *error)
{
    char samples[32], seed[32], depth[32];
    snprintf(samples, sizeof samples, "%.9g", samples_per_pixel);
    snprintf(seed, sizeof seed, "%" PRIu64, output->seed);
    snprintf(depth, sizeof depth, "%d", output->max_depth);
    /* Nothing of time, machine or threads: the same picture is the same file. */
    const ExrAttribute attributes[] = {
        {"integrator", output->integrator},
        {"maxDepth", depth},
        {"renderer", PACKAGE_NAME " " PACKAGE_VERSION},
        {"samples", samples},
        {"scene", path_file_name(output->scene_file)},
        {"seed", seed},
    };
    size_t floats = 3 * film_pixels(film);
    const ExrChannel channels[] = {{"B", rgb + 2, 3, false},
                                   {"G", rgb + 1, 3, false},
                                   {"R", rgb, 3, false},
                                   LAYER_CHANNELS("direct", rgb + floats),
                                   LAYER_CHANNELS("indirect", rgb + 2 * floats)};
    size_t count = film->light_samples > 0 ? 3 * (1 + LAYER_COUNT) : 3;
    return exr_write(output->exr, channels, count, film->width, film->height, film->crop, attributes,
                     sizeof attributes / sizeof attributes[0], error);
}

bool render_output_write(const RenderOutput *output, const Film *film, double samples_per_pixel, Error *error)
{
    int width = film->crop[2] - film->crop[0], height = film->crop[3] - film->crop[1];
    size_t floats = 3 * (size_t)width * (size_t)height;
    size_t bytes = (film->light_samples > 0 ? 1 + LAYER_COUNT : 1) * floats * sizeof(float);
    float *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "the picture");
    film_resolve(film, output->film_scale, rgb);
    if (film->light_samples > 0) {
        film_resolve_part(film, FILM_OWN, output->film_scale, rgb + floats);
        film_resolve_part(film, FILM_LIGHT, output->film_scale, rgb + 2 * floats);
    }
    bool written = exr_output_write(output, film, rgb, samples_per_pixel, error) &&
                   (!output->png[0] || png_write(output->png, rgb, width, height, output->exposure, error));
    free(rgb);
    return written;
}
