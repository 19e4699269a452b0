#include "bench/analysis.h"

#include "base/log.h"
#include "compare/metrics.h"
#include "film/pixel_series.h"
#include "image/rendering_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCKS 16 /* required by metrics_compute; the report does not use block figures */

typedef struct Analysis {
    const BenchOptions *options;
    BenchScene *scene;
    Rendering reference;
    float *patch[2]; /* a patch of an image and of the reference */
} Analysis;

/* ---- one image -------------------------------------------------------------------------------------------------- */

static void patch_copy(const Rendering *from, const BenchPatch *patch, float *to)
{
    size_t row = 3 * (size_t)patch->width;
    for (int y = 0; y < patch->height; ++y)
        memcpy(to + (size_t)y * row, from->rgb + 3 * ((size_t)(patch->y + y) * (size_t)from->width + (size_t)patch->x),
               row * sizeof *to);
}

static bool patches_measure(Analysis *analysis, const Rendering *image, double *rel_mse, Error *error)
{
    for (int i = 0; i < analysis->options->patch_count; ++i) {
        const BenchPatch *patch = &analysis->options->patches[i];
        Metrics metrics;
        patch_copy(image, patch, analysis->patch[0]);
        patch_copy(&analysis->reference, patch, analysis->patch[1]);
        if (!metrics_compute(analysis->patch[0], analysis->patch[1], patch->width, patch->height, 1, &metrics, error))
            return false;
        rel_mse[i] = metrics.rel_mse;
    }
    return true;
}

static bool run_measure(Analysis *analysis, BenchRun *run, const Rendering *image, Error *error)
{
    const float *reference = analysis->reference.rgb;
    Metrics metrics;
    DisplayError display;
    if (!rendering_same_size(image, run->image, &analysis->reference, analysis->scene->reference.path, error) ||
        !metrics_compute(image->rgb, reference, image->width, image->height, BLOCKS, &metrics, error) ||
        !display_error_compute(image->rgb, reference, image->width, image->height, &analysis->options->display,
                               &display, error))
        return false;
    run->figures = (BenchFigures){.rel_mse = metrics.rel_mse,
                                  .rel_mse_trimmed = metrics.rel_mse_trimmed,
                                  .mape = metrics.mape,
                                  .flip = display.flip,
                                  .ssim = display.ssim,
                                  .mean_ratio = metrics.mean / metrics.mean_reference};
    return patches_measure(analysis, image, run->figures.patches, error);
}

/* ---- the runs of a series with one time ------------------------------------------------------------------------- */

static bool run_belongs(const BenchRun *run, int series, int time)
{
    return run->finished && run->series == series && run->time == time;
}

/* Sets the variance of the pixels over the runs, and the error of their mean. */
static bool group_spread(const Analysis *analysis, const PixelSeries *pixels, BenchGroup *group, Error *error)
{
    const Rendering *reference = &analysis->reference;
    size_t values = 3 * pixels->pixels;
    Metrics of_mean;
    group->variance = group->bias = group->efficiency = (double)NAN;
    if (group->runs < 2)
        return true;
    if (!metrics_compute(pixels->mean, reference->rgb, reference->width, reference->height, BLOCKS, &of_mean, error))
        return false;
    group->variance = 0.0;
    for (size_t i = 0; i < values; ++i)
        group->variance +=
            metrics_relative_square(pixel_series_spread(pixels, i), (double)reference->rgb[i]) / (double)values;
    group->bias = of_mean.rel_mse - group->variance / group->runs;
    return true;
}

/* Measures every run of the group and accumulates its pixels. */
static bool group_measure(Analysis *analysis, int series, int time, PixelSeries *pixels, BenchGroup *group,
                          Error *error)
{
    for (BenchRun *run = analysis->scene->runs; run < analysis->scene->runs + analysis->scene->run_count; ++run) {
        Rendering image;
        if (!run_belongs(run, series, time))
            continue;
        if (!rendering_load(run->image, &image, error))
            return false;
        bool good = run_measure(analysis, run, &image, error);
        if (good)
            pixel_series_add(pixels, image.rgb, NULL, 1.0);
        ++group->runs;
        rendering_destroy(&image);
        if (!good)
            return false;
    }
    return group_spread(analysis, pixels, group, error);
}

/* Quantities that are summarised over runs. */
enum {
    SECONDS,
    SAMPLES,
    REL_MSE,
    TRIMMED,
    MAPE,
    FLIP,
    SSIM,
    SAMPLES_PER_SECOND,
    RAYS_PER_SECOND,
    MEAN_RATIO,
    FIRST_PATCH /* and BENCH_PATCHES_MAX - 1 more */
};

static double run_value(const BenchRun *run, int what)
{
    const BenchRecord *record = &run->record;
    const double values[] = {[SECONDS] = record->seconds,
                             [SAMPLES] = record->samples_per_pixel,
                             [REL_MSE] = run->figures.rel_mse,
                             [TRIMMED] = run->figures.rel_mse_trimmed,
                             [MAPE] = run->figures.mape,
                             [FLIP] = run->figures.flip,
                             [SSIM] = run->figures.ssim,
                             [SAMPLES_PER_SECOND] = (double)record->samples / record->seconds,
                             [RAYS_PER_SECOND] = (double)(record->closest_rays + record->shadow_rays) / record->seconds,
                             [MEAN_RATIO] = run->figures.mean_ratio};
    return what >= FIRST_PATCH ? run->figures.patches[what - FIRST_PATCH] : values[what];
}

/* Gathers a quantity of all runs of a group; returns their number. */
static int values_gather(const BenchScene *scene, int series, int time, int what, double *values)
{
    int count = 0;
    for (const BenchRun *run = scene->runs; run < scene->runs + scene->run_count; ++run)
        if (run_belongs(run, series, time))
            values[count++] = run_value(run, what);
    return count;
}

static BenchBand group_band(const BenchScene *scene, int series, int time, int what)
{
    double values[BENCH_RUNS_MAX];
    size_t count = (size_t)values_gather(scene, series, time, what, values);
    return (BenchBand){sample_quantile(values, count, 0.1), sample_quantile(values, count, 0.5),
                       sample_quantile(values, count, 0.9)};
}

static void mean_ratio_set(const BenchScene *scene, int series, int time, BenchGroup *group)
{
    double values[BENCH_RUNS_MAX], square = 0.0;
    int count = values_gather(scene, series, time, MEAN_RATIO, values);
    for (int i = 0; i < count; ++i)
        group->mean_ratio += values[i] / count;
    for (int i = 0; i < count; ++i)
        square += (values[i] - group->mean_ratio) * (values[i] - group->mean_ratio);
    group->mean_ratio_error = count > 1 ? sqrt(square / (count - 1.0) / count) : (double)NAN;
}

static const BenchRun *run_typical(const BenchScene *scene, int series, int time, double median)
{
    const BenchRun *best = NULL;
    for (const BenchRun *run = scene->runs; run < scene->runs + scene->run_count; ++run)
        if (run_belongs(run, series, time) &&
            (!best || fabs(run->figures.rel_mse - median) < fabs(best->figures.rel_mse - median)))
            best = run;
    return best;
}

static void group_summarise(const Analysis *analysis, int series, int time, BenchGroup *group)
{
    const BenchScene *scene = analysis->scene;
    BenchBand *const bands[] = {[SECONDS] = &group->seconds, [SAMPLES] = &group->samples_per_pixel,
                                [REL_MSE] = &group->rel_mse, [TRIMMED] = &group->rel_mse_trimmed,
                                [MAPE] = &group->mape,       [FLIP] = &group->flip,
                                [SSIM] = &group->ssim};
    for (int what = SECONDS; what <= SSIM; ++what)
        *bands[what] = group_band(scene, series, time, what);
    group->samples_per_second = group_band(scene, series, time, SAMPLES_PER_SECOND).median;
    group->rays_per_second = group_band(scene, series, time, RAYS_PER_SECOND).median;
    mean_ratio_set(scene, series, time, group);
    for (int i = 0; i < analysis->options->patch_count; ++i)
        group->patches[i] = group_band(scene, series, time, FIRST_PATCH + i).median;
    group->efficiency = 1.0 / (group->variance * group->seconds.median);
    group->typical = run_typical(scene, series, time, group->rel_mse.median);
}

static bool group_fill(Analysis *analysis, int series, int time, Error *error)
{
    BenchGroup *group = &analysis->scene->series[series].groups[time];
    PixelSeries pixels = {0};
    size_t count = (size_t)analysis->reference.width * (size_t)analysis->reference.height;
    *group = (BenchGroup){0};
    bool good = pixel_series_init(&pixels, count, 3, true, error) &&
                group_measure(analysis, series, time, &pixels, group, error);
    pixel_series_destroy(&pixels);
    if (good && group->runs > 0)
        group_summarise(analysis, series, time, group);
    return good;
}

/* ---- series ----------------------------------------------------------------------------------------------------- */

static SampleLine line_fit(const BenchScene *scene, int series, int abscissa, double *x, double *y)
{
    size_t count = 0;
    for (const BenchRun *run = scene->runs; run < scene->runs + scene->run_count; ++run) {
        if (!run->finished || run->series != series || !(run->figures.rel_mse > 0.0))
            continue;
        x[count] = log10(run_value(run, abscissa));
        y[count++] = log10(run->figures.rel_mse);
    }
    return sample_line(x, y, count);
}

static bool lines_fit(const BenchOptions *options, BenchScene *scene, Error *error)
{
    double *room = malloc(2 * (size_t)scene->run_count * sizeof *room);
    if (!room)
        return error_memory(error, 2 * (size_t)scene->run_count * sizeof *room, "slopes");
    const SampleLine none = {(double)NAN, (double)NAN, (double)NAN};
    for (int s = 0; s < scene->series_count; ++s) {
        BenchSeries *series = &scene->series[s];
        int times = 0;
        for (int t = 0; t < options->time_count; ++t)
            times += series->groups[t].runs > 0;
        series->by_time = times < 2 ? none : line_fit(scene, s, SECONDS, room, room + scene->run_count);
        series->by_samples = times < 2 ? none : line_fit(scene, s, SAMPLES, room, room + scene->run_count);
    }
    free(room);
    return true;
}

/* Time at which a series reaches the error `target`: interpolated between its medians by a power law, extrapolated
 * beyond them with the slope of independent samples, -1. */
static double equal_time(const BenchOptions *options, const BenchSeries *series, double target, bool *extrapolated)
{
    const BenchGroup *before = NULL;
    *extrapolated = false;
    for (int t = 0; t < options->time_count; ++t) {
        const BenchGroup *group = &series->groups[t];
        if (group->runs == 0)
            continue;
        if (group->rel_mse.median <= target) {
            *extrapolated = !before && group->rel_mse.median < target;
            if (!before)
                return group->seconds.median * group->rel_mse.median / target;
            double part = log(before->rel_mse.median / target) / log(before->rel_mse.median / group->rel_mse.median);
            return before->seconds.median * pow(group->seconds.median / before->seconds.median, part);
        }
        before = group;
    }
    *extrapolated = true;
    return before ? before->seconds.median * before->rel_mse.median / target : (double)NAN;
}

static void speedups_set(const BenchOptions *options, BenchScene *scene)
{
    int time = bench_common_time(options, scene);
    for (int s = 0; s < scene->series_count; ++s) {
        BenchSeries *series = &scene->series[s];
        series->equal_seconds = series->speedup = (double)NAN;
        if (time < 0)
            continue;
        const BenchGroup *first = &scene->series[0].groups[time];
        series->equal_seconds =
            s == 0 ? first->seconds.median : equal_time(options, series, first->rel_mse.median, &series->extrapolated);
        series->speedup = first->seconds.median / series->equal_seconds;
    }
}

int bench_common_time(const BenchOptions *options, const BenchScene *scene)
{
    for (int t = options->time_count - 1; t >= 0; --t) {
        bool all = scene->series_count > 0;
        for (int s = 0; s < scene->series_count; ++s)
            all = all && scene->series[s].groups[t].runs > 0;
        if (all)
            return t;
    }
    return -1;
}

/* ---- the scene -------------------------------------------------------------------------------------------------- */

/* relMSE of the reference itself, from its independent halves: their mean has as variance a quarter of their mean
 * squared difference. NaN without halves. */
static double own_error(const Rendering *reference)
{
    size_t values = 3 * (size_t)reference->width * (size_t)reference->height;
    double sum = 0.0;
    if (!rendering_has_halves(reference))
        return (double)NAN;
    for (size_t i = 0; i < values; ++i) {
        double difference = (double)reference->halves[0][i] - (double)reference->halves[1][i];
        sum += metrics_relative_square(0.25 * difference * difference, (double)reference->rgb[i]);
    }
    return sum / (double)values;
}

static bool groups_fill(Analysis *analysis, Error *error)
{
    for (int s = 0; s < analysis->scene->series_count; ++s)
        for (int t = 0; t < analysis->options->time_count; ++t)
            if (!group_fill(analysis, s, t, error))
                return false;
    return true;
}

bool bench_scene_analyse(const BenchOptions *options, BenchScene *scene, Error *error)
{
    Analysis analysis = {.options = options, .scene = scene};
    if (!scene->reference.path[0] || scene->run_count == 0)
        return true;
    if (!rendering_load(scene->reference.path, &analysis.reference, error))
        return false;
    int finished = 0;
    for (int r = 0; r < scene->run_count; ++r)
        finished += scene->runs[r].finished;
    log_message(LOG_INFO, "%s: comparing %d images with the reference", scene->name, finished);
    scene->reference.own_error = own_error(&analysis.reference);
    size_t values = 3 * (size_t)scene->width * (size_t)scene->height;
    for (int i = 0; i < 2; ++i)
        analysis.patch[i] = malloc(values * sizeof(float));
    bool good = (analysis.patch[0] && analysis.patch[1]) || error_memory(error, values * sizeof(float), "patches");
    good = good && groups_fill(&analysis, error) && lines_fit(options, scene, error);
    if (good)
        speedups_set(options, scene);
    free(analysis.patch[0]);
    free(analysis.patch[1]);
    rendering_destroy(&analysis.reference);
    return good;
}
