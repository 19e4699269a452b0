#include "bench/tables.h"

#include "base/build_info.h"
#include "base/json.h"
#include "render/stats.h"

#include <inttypes.h>
#include <math.h>

#define FORMAT 1 /* of the JSON; raised when a key changes its meaning */

/* ---- a line a run ----------------------------------------------------------------------------------------------- */

/* Replaces tabs and newlines, which would break the table. */
static void tsv_text(FILE *stream, const char *text)
{
    for (; *text; ++text)
        fputc((unsigned char)*text < 0x20 ? ' ' : *text, stream);
}

static void tsv_run(const BenchScene *scene, const BenchRun *run, const BenchOptions *options, FILE *stream)
{
    const BenchSeries *series = &scene->series[run->series];
    const BenchRecord *record = &run->record;
    const BenchFigures *figures = &run->figures;
    tsv_text(stream, scene->name);
    fprintf(stream, "\t%s\t%s\t%.9g\t%d\t%" PRIu64 "\t", series->integrator->name, series->backend->name,
            options->times[run->time], run->number + 1, run->seed);
    fprintf(stream, "%.9g\t%.9g\t%" PRIu64 "\t%" PRIu64 "\t", record->seconds, record->samples_per_pixel,
            record->samples, record->closest_rays + record->shadow_rays);
    fprintf(stream, "%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t", figures->rel_mse, figures->rel_mse_trimmed, figures->mape,
            figures->flip, figures->ssim, figures->mean_ratio);
    for (int i = 0; i < options->patch_count; ++i)
        fprintf(stream, "%.9g\t", figures->patches[i]);
    tsv_text(stream, run->image);
    fputc('\t', stream);
    tsv_text(stream, scene->reference.path);
    fputc('\n', stream);
}

void bench_tsv_write(const Bench *bench, FILE *stream)
{
    const BenchOptions *options = &bench->options;
    fputs("scene\tintegrator\tbackend\ttime\trun\tseed\tseconds\tsamples_per_pixel\tsamples\trays\trel_mse\t"
          "rel_mse_trimmed\tmape\tflip\tssim\tmean_ratio\t",
          stream);
    for (int i = 0; i < options->patch_count; ++i) {
        fputs("rel_mse ", stream);
        tsv_text(stream, options->patches[i].name);
        fputc('\t', stream);
    }
    fputs("image\treference\n", stream);
    for (int i = 0; i < options->scene_count; ++i)
        for (int r = 0; r < bench->scenes[i].run_count; ++r)
            if (bench->scenes[i].runs[r].finished && bench->scenes[i].reference.path[0])
                tsv_run(&bench->scenes[i], &bench->scenes[i].runs[r], options, stream);
}

/* ---- one object ------------------------------------------------------------------------------------------------- */

static void json_band(JsonWriter *json, const char *key, const BenchBand *band)
{
    json_array_begin(json, key);
    json_number(json, NULL, band->low);
    json_number(json, NULL, band->median);
    json_number(json, NULL, band->high);
    json_array_end(json);
}

static void json_group(JsonWriter *json, const BenchGroup *group, double time)
{
    json_object_begin(json, NULL);
    json_number(json, "time", time);
    json_signed(json, "runs", group->runs);
    json_band(json, "seconds", &group->seconds);
    json_band(json, "samples_per_pixel", &group->samples_per_pixel);
    json_band(json, "rel_mse", &group->rel_mse);
    json_band(json, "rel_mse_trimmed", &group->rel_mse_trimmed);
    json_band(json, "mape", &group->mape);
    json_band(json, "flip", &group->flip);
    json_band(json, "ssim", &group->ssim);
    json_number(json, "samples_per_second", group->samples_per_second);
    json_number(json, "rays_per_second", group->rays_per_second);
    json_number(json, "mean_ratio", group->mean_ratio);
    json_number(json, "mean_ratio_error", group->mean_ratio_error);
    json_number(json, "variance", group->variance);
    json_number(json, "efficiency", group->efficiency);
    json_number(json, "bias", group->bias);
    json_object_end(json);
}

static void json_line(JsonWriter *json, const char *key, const SampleLine *line)
{
    json_object_begin(json, key);
    json_number(json, "slope", line->slope);
    json_number(json, "slope_error", line->slope_error);
    json_number(json, "intercept", line->intercept);
    json_object_end(json);
}

static void json_series(JsonWriter *json, const BenchOptions *options, const BenchSeries *series)
{
    json_object_begin(json, NULL);
    json_text(json, "integrator", series->integrator->name);
    json_text(json, "backend", series->backend->name);
    json_line(json, "by_time", &series->by_time);
    json_line(json, "by_samples", &series->by_samples);
    json_number(json, "equal_seconds", series->equal_seconds);
    json_bool(json, "extrapolated", series->extrapolated);
    json_number(json, "speedup", series->speedup);
    json_array_begin(json, "groups");
    for (int t = 0; t < options->time_count; ++t)
        if (series->groups[t].runs > 0)
            json_group(json, &series->groups[t], options->times[t]);
    json_array_end(json);
    json_object_end(json);
}

static void json_chains(JsonWriter *json, const ChainStatistics *chains)
{
    json_object_begin(json, "chains");
    stats_chain_counts(json, chains);
    json_array_begin(json, "mutation_counts");
    for (int kind = 0; kind < CHAIN_KINDS; ++kind)
        for (int depth = 0; depth < CHAIN_DEPTHS; ++depth) {
            if (chains->proposals[kind][depth] == 0)
                continue;
            json_object_begin(json, NULL);
            json_text(json, "kind", stats_chain_kind(kind));
            json_signed(json, "depth", depth);
            json_unsigned(json, "proposals", chains->proposals[kind][depth]);
            json_unsigned(json, "accepted", chains->accepted[kind][depth]);
            json_object_end(json);
        }
    json_array_end(json);
    stats_chain_health(json, chains);
    json_object_end(json);
}

static void json_run(JsonWriter *json, const BenchOptions *options, const BenchScene *scene, const BenchRun *run)
{
    const BenchRecord *record = &run->record;
    json_object_begin(json, NULL);
    json_text(json, "integrator", scene->series[run->series].integrator->name);
    json_text(json, "backend", scene->series[run->series].backend->name);
    json_number(json, "time", options->times[run->time]);
    json_signed(json, "run", run->number + 1);
    json_unsigned(json, "seed", run->seed);
    json_number(json, "seconds", record->seconds);
    json_number(json, "load_seconds", record->load);
    json_number(json, "build_seconds", record->build);
    json_number(json, "write_seconds", record->write);
    json_number(json, "ray_seconds_all_threads", record->ray_seconds);
    json_unsigned(json, "threads", record->threads);
    json_number(json, "samples_per_pixel", record->samples_per_pixel);
    json_unsigned(json, "samples", record->samples);
    json_unsigned(json, "closest_rays", record->closest_rays);
    json_unsigned(json, "shadow_rays", record->shadow_rays);
    json_number(json, "rel_mse", run->figures.rel_mse);
    json_number(json, "rel_mse_trimmed", run->figures.rel_mse_trimmed);
    json_number(json, "mape", run->figures.mape);
    json_number(json, "flip", run->figures.flip);
    json_number(json, "ssim", run->figures.ssim);
    json_number(json, "mean_ratio", run->figures.mean_ratio);
    json_object_begin(json, "patches");
    for (int i = 0; i < options->patch_count; ++i)
        json_number(json, options->patches[i].name, run->figures.patches[i]);
    json_object_end(json);
    if (record->chains.steps > 0)
        json_chains(json, &record->chains);
    json_text(json, "image", run->image);
    json_object_end(json);
}

static void json_scene(JsonWriter *json, const BenchOptions *options, const BenchScene *scene)
{
    json_object_begin(json, NULL);
    json_text(json, "name", scene->name);
    json_text(json, "file", scene->path);
    json_signed(json, "width", scene->width);
    json_signed(json, "height", scene->height);
    json_signed(json, "max_depth", scene->max_depth);
    json_text(json, "reference", scene->reference.path[0] ? scene->reference.path : NULL);
    json_text(json, "reference_origin", scene->reference.path[0] ? scene->reference.origin : NULL);
    json_number(json, "reference_rel_mse", scene->reference.own_error);
    bool known = scene->reference.path[0] != '\0';
    json_array_begin(json, "series");
    for (int s = 0; s < scene->series_count && known; ++s)
        json_series(json, options, &scene->series[s]);
    json_array_end(json);
    json_array_begin(json, "runs");
    for (int r = 0; r < scene->run_count && known; ++r)
        if (scene->runs[r].finished)
            json_run(json, options, scene, &scene->runs[r]);
    json_array_end(json);
    json_object_end(json);
}

void bench_json_write(const Bench *bench, FILE *stream)
{
    const BenchOptions *options = &bench->options;
    char machine[320];
    JsonWriter json;
    build_machine(machine, sizeof machine);
    json_init(&json, stream);
    json_object_begin(&json, NULL);
    json_signed(&json, "format", FORMAT);
    json_text(&json, "machine", machine);
    json_text(&json, "compiler", build_compiler());
    json_text(&json, "commit", build_commit());
    json_text(&json, "command", bench->command);
    json_number(&json, "exposure", options->display.exposure);
    json_array_begin(&json, "scenes");
    for (int i = 0; i < options->scene_count; ++i)
        if (bench->scenes[i].run_count > 0)
            json_scene(&json, options, &bench->scenes[i]);
    json_array_end(&json);
    json_object_end(&json);
}
