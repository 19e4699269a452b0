#include "render/stats.h"

#include "config.h"

#include "base/log.h"
#include "base/output_file.h"
#include "base/timing.h"

#include <stdio.h>
#include <string.h>

static void stats_scene(JsonWriter *json, const RenderStats *stats)
{
    const Scene *scene = stats->scene;
    const SceneSettings *settings = &scene->settings;
    json_object_begin(json, "scene");
    json_text(json, "file", stats->scene_file);
    json_signed(json, "width", settings->width);
    json_signed(json, "height", settings->height);
    json_array_begin(json, "crop");
    for (int i = 0; i < 4; ++i)
        json_signed(json, NULL, settings->crop[i]);
    json_array_end(json);
    json_signed(json, "max_depth", settings->max_depth);
    json_unsigned(json, "primitives", scene->primitive_count);
    json_unsigned(json, "instances", scene->instances.count);
    json_unsigned(json, "materials", scene->materials.count);
    json_unsigned(json, "lights", scene->lights.count);
    json_unsigned(json, "bytes", scene_bytes(scene));
    json_object_end(json);
}

static void stats_seconds(JsonWriter *json, const RenderStats *stats)
{
    json_object_begin(json, "seconds");
    json_number(json, "load", stats->load);
    json_number(json, "build", stats->build);
    json_number(json, "render", stats->render);
    json_number(json, "write", stats->write);
    json_number(json, "total", stats->total);
    json_object_end(json);
}

static void stats_rays(JsonWriter *json, const RenderResult *result)
{
    uint64_t all = result->backend.closest_rays + result->backend.shadow_rays;
    json_object_begin(json, "rays");
    json_unsigned(json, "closest", result->backend.closest_rays);
    json_unsigned(json, "shadow", result->backend.shadow_rays);
    json_number(json, "seconds_all_threads", result->backend.ray_seconds);
    json_number(json, "per_second", result->seconds > 0.0 ? (double)all / result->seconds : 0.0);
    json_object_end(json);
}

static void stats_ranks(JsonWriter *json, const ExchangeStatistics *exchange)
{
    json_object_begin(json, "ranks");
    json_unsigned(json, "count", exchange->ranks);
    json_unsigned(json, "passes", exchange->passes);
    json_unsigned(json, "exchanged_bytes", exchange->bytes);
    json_number(json, "exchange_seconds", exchange->seconds);
    json_object_end(json);
}

const char *stats_chain_kind(int kind)
{
    static const char *const KINDS[CHAIN_KINDS] = {"all", "light", "camera", "large"};
    return KINDS[kind];
}

void stats_chain_counts(JsonWriter *json, const ChainStatistics *chains)
{
    json_unsigned(json, "pool_samples", chains->pool_samples);
    json_unsigned(json, "seeds", chains->seeds);
    json_unsigned(json, "mutations", chains->steps);
    json_number(json, "pool_seconds", chains->pool_seconds);
    json_number(json, "chain_seconds", chains->chain_seconds);
    json_number(json, "direct_seconds", chains->direct_seconds);
    json_number(json, "bidirectional_seconds", chains->bidirectional_seconds);
}

/* JSON key for paths of `depth` segments. */
static const char *depth_key(int depth, char text[16])
{
    snprintf(text, 16, "%d", depth);
    return text;
}

/* "KEY": {"3": ..., ...}, for the depths that have chains. */
static void stats_by_depth(JsonWriter *json, const char *key, const ChainStatistics *chains, const uint64_t *counts)
{
    json_object_begin(json, key);
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth) {
        char name[16];
        if (chain_statistics_proposals(chains, depth) > 0)
            json_unsigned(json, depth_key(depth, name), counts[depth]);
    }
    json_object_end(json);
}

void stats_chain_health(JsonWriter *json, const ChainStatistics *chains)
{
    stats_by_depth(json, "longest_rejections", chains, chains->longest_run);
    stats_by_depth(json, "starts", chains, chains->starts);
    stats_by_depth(json, "distinct_starts", chains, chains->distinct_starts);
    json_number(json, "least_distinct", chains->least_distinct);
    json_object_begin(json, "r_hat");
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth) {
        char name[16];
        if (chains->r_hat[depth] > 0.0)
            json_number(json, depth_key(depth, name), chains->r_hat[depth]);
    }
    json_object_end(json);
}

/* Includes, per kind of mutation, the acceptance rate by depth. */
static void stats_chains(JsonWriter *json, const ChainStatistics *chains)
{
    json_object_begin(json, "chains");
    stats_chain_counts(json, chains);
    json_object_begin(json, "shares");
    json_number(json, "chains", chains->weights[0]);
    json_number(json, "pool", chains->weights[1]);
    json_number(json, "paths", chains->weights[2]);
    json_number(json, "bidirectional", chains->weights[3]);
    json_object_end(json);
    json_object_begin(json, "acceptance");
    for (int kind = 0; kind < CHAIN_KINDS; ++kind) {
        json_object_begin(json, stats_chain_kind(kind));
        for (int depth = 0; depth < CHAIN_DEPTHS; ++depth) {
            char name[16];
            double accepted = (double)chains->accepted[kind][depth], proposals = (double)chains->proposals[kind][depth];
            if (proposals > 0.0)
                json_number(json, depth_key(depth, name), accepted / proposals);
        }
        json_object_end(json);
    }
    json_object_end(json);
    stats_chain_health(json, chains);
    json_object_end(json);
}

static void stats_diagnostics(JsonWriter *json, const RenderStats *stats)
{
    const RenderResult *result = stats->result;
    const SceneCounts *counts = &stats->scene->counts;
    json_object_begin(json, "diagnostics");
    json_unsigned(json, "film_saturated", stats->film->saturated);
    json_unsigned(json, "film_full_pixels", film_full_pixels(stats->film));
    json_unsigned(json, "film_vanished", stats->film->vanished);
    json_unsigned(json, "film_not_finite", stats->film->not_finite);
    json_unsigned(json, "degenerate_triangles", counts->degenerate_triangles);
    json_unsigned(json, "zero_area_lights", counts->zero_area_lights);
    json_unsigned(json, "substitutions", counts->substitutions);
    json_unsigned(json, "warnings", log_warning_count());
    json_object_begin(json, "kernels");
    for (int i = 0; i < result->diagnostic_count; ++i)
        json_unsigned(json, result->diagnostic_names[i], result->diagnostics[i]);
    json_object_end(json);
    json_object_end(json);
}

static void stats_error(JsonWriter *json, const RenderStats *stats)
{
    const RenderResult *result = stats->result;
    const ErrorGoal *goal = stats->error;
    json_object_begin(json, "error");
    json_number(json, "goal", goal->goal);
    json_text(json, "of", goal->blocks ? "blocks" : "pixels");
    if (goal->percentile > 0.0)
        json_number(json, "percentile", goal->percentile);
    if (result->error.work > 0) {
        json_number(json, "estimate", result->error.estimate);
        json_number(json, "standard_error", result->error.deviation);
        json_number(json, "samples_per_pixel",
                    (double)result->error.work * result->samples_per_pixel / (double)result->samples);
    }
    json_bool(json, "reached", result->error_reached);
    json_object_end(json);
}

static void stats_print(FILE *stream, const RenderStats *stats)
{
    const RenderResult *result = stats->result;
    JsonWriter json;
    json_init(&json, stream);
    json_object_begin(&json, NULL);
    json_signed(&json, "format", STATS_FORMAT);
    json_text(&json, "version", PACKAGE_VERSION);
    stats_scene(&json, stats);
    json_text(&json, "integrator", stats->integrator);
    json_text(&json, "backend", stats->backend);
    json_text(&json, "device", result->backend.device);
    json_unsigned(&json, "seed", stats->seed);
    json_signed(&json, "threads",
                result->backend.exchange.ranks > 0 ? result->backend.exchange.threads : result->backend.threads);
    json_number(&json, "samples_per_pixel", result->samples_per_pixel);
    json_unsigned(&json, "samples", result->samples);
    json_number(&json, "samples_per_second", result->seconds > 0.0 ? (double)result->samples / result->seconds : 0.0);
    json_unsigned(&json, "photons", result->photons);
    json_unsigned(&json, "openings", result->openings);
    json_bool(&json, "stopped", result->stopped);
    if (stats->error->goal > 0.0)
        stats_error(&json, stats);
    stats_seconds(&json, stats);
    stats_rays(&json, result);
    if (result->backend.exchange.ranks > 0)
        stats_ranks(&json, &result->backend.exchange);
    if (result->chains.steps > 0)
        stats_chains(&json, &result->chains);
    json_unsigned(&json, "peak_memory_bytes", timing_peak_memory());
    json_unsigned(&json, "backend_bytes", result->backend.bytes);
    stats_diagnostics(&json, stats);
    json_text(&json, "part", stats->part[0] ? stats->part : NULL);
    json_text(&json, "image", stats->part[0] ? NULL : stats->exr);
    json_text(&json, "png", stats->png[0] ? stats->png : NULL);
    json_object_end(&json);
}

bool stats_to_output(const char *path)
{
    return strcmp(path, "-") == 0;
}

bool stats_write(const char *path, const RenderStats *stats, Error *error)
{
    if (stats_to_output(path)) {
        stats_print(stdout, stats); /* main checks for write errors */
        return true;
    }
    OutputFile file;
    FILE *stream = output_file_begin(&file, path, error) ? output_file_stream(&file, error) : NULL;
    if (!stream)
        return false;
    stats_print(stream, stats);
    return output_file_stream_commit(&file, stream, error);
}
