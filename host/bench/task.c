#include "bench/task.h"

#include "base/build_info.h"
#include "base/hash.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/path_name.h"
#include "base/timing.h"
#include "bench/record.h"
#include "image/exr.h"
#include "layout/diagnostics.h"
#include "render/progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- names and seeds -------------------------------------------------------------------------------------------- */

static uint64_t hash_text(uint64_t hash, const char *text)
{
    return hash_bytes(hash, text, strlen(text) + 1);
}

uint64_t bench_task_seed(const BenchOptions *options, const char *integrator, double seconds, int number)
{
    uint64_t hash = hash_bytes(HASH_START, &options->seed, sizeof options->seed);
    hash = hash_text(hash, integrator);
    hash = hash_bytes(hash, &seconds, sizeof seconds);
    hash = hash_bytes(hash, &number, sizeof number);
    return hash ^ (hash >> 29);
}

void bench_task_image(const BenchWorkshop *shop, const BenchTask *task, char path[PATH_MAX])
{
    char machine[320];
    build_machine(machine, sizeof machine);
    uint64_t key = shop->scene->key;
    key = hash_text(key, task->integrator->name);
    key = hash_text(key, task->backend->name);
    key = hash_bytes(key, &task->seconds, sizeof task->seconds);
    key = hash_bytes(key, &task->seed, sizeof task->seed);
    key = hash_bytes(key, &shop->bench->options.threads, sizeof shop->bench->options.threads);
    key = hash_text(hash_text(hash_text(key, build_commit()), build_compiler()), machine);
    snprintf(path, PATH_MAX, "%.*s/%s-%s-%s-%gs-%016llx.exr", PATH_MAX - 256, shop->bench->folder, shop->scene->name,
             task->integrator->name, task->backend->name, task->seconds, (unsigned long long)key);
    for (char *c = path + strlen(shop->bench->folder) + 1; *c; ++c)
        if (*c == ' ' || *c == '/')
            *c = '_';
}

/* ---- one rendering ---------------------------------------------------------------------------------------------- */

static bool backend_open(BenchWorkshop *shop, const BackendChoices *choices, Error *error)
{
    if (shop->choices == choices)
        return true;
    if (shop->choices)
        shop->backend.interface->close(shop->backend.backend);
    shop->choices = NULL;
    const BackendScene view = scene_backend_view(&shop->data);
    const BackendOptions options = {.threads = shop->bench->options.threads};
    double start = timing_now();
    if (!backend_choices_open(choices, &view, &options, &shop->backend, error))
        return false;
    shop->build = timing_now() - start;
    shop->choices = choices;
    return true;
}

/* Counters of a backend, which accumulate over renderings. */
typedef struct Counters {
    BackendStatistics statistics;
    uint64_t diagnostics;
} Counters;

static Counters counters_read(const BenchWorkshop *shop)
{
    Counters counters = {0};
    uint64_t kinds[DIAGNOSTIC_COUNT] = {0};
    shop->backend.interface->statistics(shop->backend.backend, &counters.statistics);
    shop->backend.interface->diagnostics(shop->backend.backend, kinds);
    for (int i = 0; i < DIAGNOSTIC_COUNT; ++i)
        counters.diagnostics += kinds[i];
    return counters;
}

static void record_fill(const BenchWorkshop *shop, const Counters *before, const RenderResult *result, const Film *film,
                        BenchRecord *record)
{
    const Counters after = counters_read(shop);
    *record = (BenchRecord){
        .seconds = result->seconds,
        .load = shop->load,
        .build = shop->build,
        .samples_per_pixel = result->samples_per_pixel,
        .ray_seconds = after.statistics.ray_seconds - before->statistics.ray_seconds,
        .samples = result->samples,
        .closest_rays = after.statistics.closest_rays - before->statistics.closest_rays,
        .shadow_rays = after.statistics.shadow_rays - before->statistics.shadow_rays,
        .threads = (uint64_t)after.statistics.threads,
        .saturated = film->saturated + film_full_pixels(film),
        .not_finite = film->not_finite,
        .diagnostics = after.diagnostics - before->diagnostics,
        .chains = result->chains,
    };
    snprintf(record->device, sizeof record->device, "%s", after.statistics.device);
}

static bool image_write(const char *path, const float *rgb, const BenchScene *scene, const BenchTask *task,
                        Error *error)
{
    const ExrAttribute attributes[] = {exr_text("integrator", task->integrator->name),
                                       exr_text("scene", path_file_name(scene->path)), exr_whole("seed", task->seed)};
    const ExrChannel channels[] = {{"R", rgb, 3, false}, {"G", rgb + 1, 3, false}, {"B", rgb + 2, 3, false}};
    const ExrPicture picture = {.channels = channels,
                                .channel_count = 3,
                                .width = scene->width,
                                .height = scene->height,
                                .crop = {0, 0, scene->width, scene->height},
                                .attributes = attributes,
                                .attribute_count = sizeof attributes / sizeof attributes[0]};
    return exr_write_picture(path, &picture, error);
}

static bool film_write(const BenchWorkshop *shop, const BenchTask *task, const Film *film, const char *path,
                       BenchRecord *record, Error *error)
{
    double start = timing_now();
    size_t bytes = 3 * film_pixels(film) * sizeof(float);
    float *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "a picture");
    film_resolve(film, shop->data.settings.film_scale, rgb);
    bool good = image_write(path, rgb, shop->scene, task, error);
    free(rgb);
    record->write = timing_now() - start;
    return good && bench_record_write(path, record, error);
}

static void task_progress(void *context, const RenderProgress *progress)
{
    progress_update(context, progress);
}

/* Renders. If a signal cuts it short, *finished is set to false and nothing is written. */
static bool task_render(BenchWorkshop *shop, const BenchTask *task, const char *path, BenchRecord *record,
                        bool *finished, Error *error)
{
    const RenderOptions options = {.seconds = task->seconds,
                                   .max_depth = shop->scene->max_depth,
                                   .seed = task->seed,
                                   .photons = PHOTONS_DEFAULT,
                                   .reconstruction = RECONSTRUCTION_SPLAT,
                                   .stop = interrupt_flag()};
    const SceneSettings *settings = &shop->data.settings;
    Progress progress;
    const RenderCallbacks callbacks = {.progress = task_progress, .context = &progress};
    RenderResult result;
    Film film = {0};
    progress_init(&progress, stderr, shop->bench->options.quiet);
    progress.last_shown = HUGE_VAL; /* without a terminal, one line per rendering is enough */
    const Counters before = counters_read(shop);
    bool good = film_init(&film, settings->width, settings->height, settings->crop, error) &&
                render_film(&(RenderTask){.integrator = task->integrator,
                                          .scene = &shop->data,
                                          .backend = shop->backend,
                                          .options = &options,
                                          .callbacks = &callbacks},
                            &film, &result, error);
    progress_end(&progress);
    *finished = good && !result.stopped;
    if (*finished) {
        record_fill(shop, &before, &result, &film, record);
        good = film_write(shop, task, &film, path, record, error);
    }
    film_destroy(&film);
    return good;
}

bool bench_task_run(BenchWorkshop *shop, const BenchTask *task, const char *path, BenchRecord *record, bool *finished,
                    Error *error)
{
    Bench *bench = shop->bench;
    char left[24];
    ++bench->renderings_done;
    *finished = bench_record_read(path, record);
    if (*finished)
        bench->planned -= task->seconds;
    if (*finished || *interrupt_flag())
        return true;
    /* Renderings may take longer than asked, since each finishes its first sample: scale the estimate. */
    double stretch = bench->done > 0.0 ? bench->spent / bench->done : 1.0, start = timing_now();
    progress_time(fmax(bench->planned - bench->done, 0.0) * stretch, left, sizeof left);
    log_message(LOG_INFO, "%d of %d, %s left: %s, %s on %s for %g s, %s", bench->renderings_done,
                bench->renderings_planned, left, shop->scene->name, task->integrator->name, task->backend->name,
                task->seconds, task->what);
    bool good = backend_open(shop, task->backend, error) && task_render(shop, task, path, record, finished, error);
    bench->done += task->seconds;
    bench->spent += timing_now() - start;
    return good;
}
