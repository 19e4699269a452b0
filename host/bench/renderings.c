#include "bench/renderings.h"

#include "base/hash.h"
#include "base/log.h"
#include "base/path_name.h"
#include "base/timing.h"
#include "bench/options.h"
#include "bench/task.h"
#include "image/rendering_file.h"
#include "gltf/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the scene -------------------------------------------------------------------------------------------------- */

/* The depth that all integrators support, so that all render the same picture. */
static int depth_common(const BenchOptions *options, int wanted)
{
    int depth = wanted;
    for (int i = 0; i < options->integrator_count; ++i)
        if (options->integrators[i]->depth_limit < depth)
            depth = options->integrators[i]->depth_limit;
    if (options->reference_integrator->depth_limit < depth)
        depth = options->reference_integrator->depth_limit;
    return depth;
}

/* A hash of everything the picture depends on: the kernels' data, and how the film becomes an image. */
static uint64_t scene_key(const Scene *scene, int max_depth)
{
    const BackendScene view = scene_backend_view(scene);
    uint64_t key = HASH_START;
    key = hash_bytes(key, view.geometry, view.geometry_words * sizeof *view.geometry);
    key = hash_bytes(key, view.tables, view.tables_words * sizeof *view.tables);
    key = hash_bytes(key, view.texels, view.texel_words * sizeof *view.texels);
    key = hash_bytes(key, view.frame, sizeof *view.frame);
    key = hash_bytes(key, &scene->settings.film_scale, sizeof scene->settings.film_scale);
    return hash_bytes(key, &max_depth, sizeof max_depth);
}

static bool patches_check(const BenchOptions *options, const BenchScene *scene, Error *error)
{
    for (int i = 0; i < options->patch_count; ++i) {
        const BenchPatch *patch = &options->patches[i];
        if (patch->x + patch->width <= scene->width && patch->y + patch->height <= scene->height)
            continue;
        error_set(error, "the patch %s reaches beyond the film of %s, which has %d x %d pixels", patch->name,
                  scene->path, scene->width, scene->height);
        return error_fix(error, "move or shrink it, or leave it out");
    }
    return true;
}

static bool scene_prepare(BenchWorkshop *shop, Error *error)
{
    const BenchOptions *options = &shop->bench->options;
    BenchScene *scene = shop->scene;
    double start = timing_now();
    if (!scene_file_load(scene->path, options->lenient, &shop->data, error))
        return false;
    shop->load = timing_now() - start;
    const SceneSettings *settings = &shop->data.settings;
    scene->width = options->resolution[0] > 0 ? options->resolution[0] : settings->width;
    scene->height = options->resolution[0] > 0 ? options->resolution[1] : settings->height;
    int wanted = options->max_depth > 0 ? options->max_depth : settings->max_depth;
    scene->max_depth = depth_common(options, wanted);
    if (scene->max_depth < wanted)
        log_message(LOG_WARNING, "%s: paths of up to %d segments instead of %d, the limit of one of the integrators",
                    scene->path, scene->max_depth, wanted);
    const int crop[4] = {0, 0, scene->width, scene->height};
    if (!scene_film_set(&shop->data, scene->width, scene->height, crop, error) || !patches_check(options, scene, error))
        return false;
    scene->primitives = shop->data.primitive_count;
    scene->lights = shop->data.lights.count;
    scene->key = scene_key(&shop->data, scene->max_depth);
    return true;
}

/* ---- the reference ---------------------------------------------------------------------------------------------- */

/* Writes the reference: the mean of two renderings, which it keeps as its halves. */
static bool halves_join(const BenchScene *scene, const char paths[2][PATH_MAX], Error *error)
{
    Rendering halves[2] = {{0}, {0}};
    bool good = rendering_load(paths[0], &halves[0], error) && rendering_load(paths[1], &halves[1], error);
    float *const pictures[2] = {halves[0].rgb, halves[1].rgb};
    good = good && rendering_mean_write(scene->reference.path, pictures, scene->width, scene->height, true, error);
    rendering_destroy(&halves[0]);
    rendering_destroy(&halves[1]);
    return good;
}

static bool reference_make(BenchWorkshop *shop, Error *error)
{
    const BenchOptions *options = &shop->bench->options;
    BenchReference *reference = &shop->scene->reference;
    char paths[2][PATH_MAX];
    double samples = 0.0;
    bool both = true;
    for (int half = 0; half < 2; ++half) {
        BenchTask task = {options->reference_integrator, &options->backends[0], 0.5 * options->reference_seconds,
                          bench_task_seed(options, "reference", options->reference_seconds, half),
                          half == 0 ? "half A of the reference" : "half B of the reference"};
        BenchRecord record;
        bool finished;
        bench_task_image(shop, &task, paths[half]);
        if (!bench_task_run(shop, &task, paths[half], &record, &finished, error))
            return false;
        both = both && finished;
        samples += finished ? record.samples_per_pixel : 0.0;
    }
    if (!both)
        return true;
    snprintf(reference->path, sizeof reference->path, "%.*s-mean.exr", (int)strlen(paths[0]) - 4, paths[0]);
    snprintf(reference->origin, sizeof reference->origin,
             "rendered here: %s, %g s in two halves with independent seeds, %.4g samples per pixel%s",
             options->reference_integrator->name, options->reference_seconds, samples,
             bench_is_compared(options, options->reference_integrator)
                 ? "; this integrator is among those compared, and the reference shares its bias, if any"
                 : "");
    return halves_join(shop->scene, paths, error);
}

/* ---- all renderings --------------------------------------------------------------------------------------------- */

static bool run_make(BenchWorkshop *shop, BenchRun *run, Error *error)
{
    const BenchOptions *options = &shop->bench->options;
    const BenchSeries *series = &shop->scene->series[run->series];
    char what[48];
    snprintf(what, sizeof what, "run %d of %d", run->number + 1, options->runs);
    double seconds = options->times[run->time];
    const BenchTask task = {series->integrator, series->backend, seconds,
                            bench_task_seed(options, series->integrator->name, seconds, run->number), what};
    run->seed = task.seed;
    bench_task_image(shop, &task, run->image);
    return bench_task_run(shop, &task, run->image, &run->record, &run->finished, error);
}

static void series_fill(const BenchOptions *options, BenchScene *scene)
{
    for (int b = 0; b < options->backend_count; ++b) {
        for (int i = 0; i < options->integrator_count; ++i) {
            BenchSeries *series = &scene->series[scene->series_count++];
            series->integrator = options->integrators[i];
            series->backend = &options->backends[b];
            series->equal_seconds = series->speedup = (double)NAN;
            snprintf(series->name, sizeof series->name, options->backend_count > 1 ? "%s, %.20s" : "%s",
                     series->integrator->name, series->backend->name);
        }
    }
}

/* Makes one run of everything, then the next, so that a signal leaves a complete comparison with fewer runs. Backends
 * come one after the other, since each must be opened. */
static bool runs_make(BenchWorkshop *shop, Error *error)
{
    const BenchOptions *options = &shop->bench->options;
    BenchScene *scene = shop->scene;
    scene->run_count = scene->series_count * options->time_count * options->runs;
    scene->runs = calloc((size_t)scene->run_count, sizeof *scene->runs);
    if (!scene->runs) {
        scene->run_count = 0;
        return error_memory(error, sizeof *scene->runs, "runs");
    }
    BenchRun *run = scene->runs;
    for (int b = 0; b < options->backend_count; ++b)
        for (int number = 0; number < options->runs; ++number)
            for (int time = 0; time < options->time_count; ++time)
                for (int i = 0; i < options->integrator_count; ++i, ++run) {
                    run->series = b * options->integrator_count + i;
                    run->time = time;
                    run->number = number;
                    if (!run_make(shop, run, error))
                        return false;
                }
    return true;
}

/* Names the scene after folder and file, for example "veach-bidir/scene" (many files are called scene), with a number
 * appended if another scene has that name. */
static void scene_name(Bench *bench, BenchScene *scene)
{
    const char *name = path_file_name(scene->path);
    if (name > scene->path + 1)
        for (name -= 2; name > scene->path && name[-1] != '/';)
            --name;
    int length = (int)(path_ends(name, ".pbrt") ? strlen(name) - 5 : strlen(name));
    snprintf(scene->name, sizeof scene->name, "%.*s", length < 64 ? length : 64, name);
    size_t plain = strlen(scene->name);
    int number = 1;
    for (const BenchScene *other = bench->scenes; other < scene; ++other)
        if (strncmp(other->name, scene->name, plain) == 0)
            ++number;
    if (number > 1)
        snprintf(scene->name + plain, sizeof scene->name - plain, " %d", number);
}

double bench_scene_seconds(const BenchOptions *options, bool has_reference, int *renderings)
{
    int each = options->integrator_count * options->backend_count * options->runs;
    double seconds = has_reference ? 0.0 : options->reference_seconds;
    *renderings = each * options->time_count + (has_reference ? 0 : 2);
    for (int i = 0; i < options->time_count; ++i)
        seconds += each * options->times[i];
    return seconds;
}

/* Uses a given reference; its size is checked now, before hours of rendering. */
static bool reference_take(BenchScene *scene, const char *path, Error *error)
{
    BenchReference *reference = &scene->reference;
    Rendering picture;
    const Rendering film = {.width = scene->width, .height = scene->height};
    if (!rendering_load(path, &picture, error))
        return false;
    bool good = rendering_same_size(&picture, path, &film, "the film", error);
    rendering_destroy(&picture);
    if (!good)
        return error_fix(error, "render at the reference's --resolution, or crop the reference");
    snprintf(reference->path, sizeof reference->path, "%s", path);
    snprintf(reference->origin, sizeof reference->origin, "given: %.200s", path_file_name(path));
    return true;
}

bool bench_scene_render(Bench *bench, BenchScene *scene, const char *path, const char *reference, Error *error)
{
    BenchWorkshop shop = {.bench = bench, .scene = scene};
    scene->path = path;
    scene->reference.own_error = (double)NAN;
    scene_name(bench, scene);
    series_fill(&bench->options, scene);
    scene_init(&shop.data);
    bool good = scene_prepare(&shop, error);
    good = good && (reference ? reference_take(scene, reference, error) : reference_make(&shop, error));
    good = good && runs_make(&shop, error);
    if (shop.choices)
        shop.backend.interface->close(shop.backend.backend);
    scene_destroy(&shop.data);
    return good;
}

void bench_scene_destroy(BenchScene *scene)
{
    free(scene->runs);
    *scene = (BenchScene){0};
}
