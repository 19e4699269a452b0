#include "serve/status_json.h"

#include "base/json.h"
#include "base/path_name.h"

#include <string.h>

static void facts_write(JsonWriter *json, const Snapshot *snapshot, const RenderFacts *facts)
{
    json_text(json, "image", path_file_name(facts->image));
    json_text(json, "scene", path_file_name(facts->scene));
    json_text(json, "integrator", facts->integrator);
    json_signed(json, "width", snapshot->width);
    json_signed(json, "height", snapshot->height);
}

static void progress_write(JsonWriter *json, const RenderStatus *status)
{
    const RenderProgress *progress = &status->progress;
    double known = progress->left >= 0.0 ? progress->left : (double)NAN, left = status->ended ? 0.0 : known;
    double rate = progress->elapsed > 0.0 ? 1.0 / progress->elapsed : 0.0;
    json_bool(json, "ended", status->ended);
    json_number(json, "elapsed", progress->elapsed);
    json_number(json, "fraction", progress->fraction);
    json_number(json, "left", left);
    json_unsigned(json, "samples", progress->samples);
    json_number(json, "samples_per_pixel", status->samples_per_pixel);
    json_number(json, "samples_per_second", (double)(progress->samples - progress->samples_before) * rate);
    json_number(json, "rays_per_second", (double)progress->rays * rate);
}

static void devices_write(JsonWriter *json, const RenderStatus *status)
{
    double rate = status->progress.elapsed > 0.0 ? 1.0 / status->progress.elapsed : 0.0;
    json_array_begin(json, "devices");
    for (size_t i = 0; i < status->device_count; ++i) {
        json_object_begin(json, NULL);
        json_text(json, "name", status->devices[i].name);
        json_number(json, "rays_per_second", (double)status->devices[i].rays * rate);
        json_object_end(json);
    }
    json_array_end(json);
}

static void weights_write(JsonWriter *json, const double weights[CHAIN_WEIGHTS])
{
    json_object_begin(json, "weights");
    json_number(json, "chains", weights[0]);
    json_number(json, "pool", weights[1]);
    json_number(json, "paths", weights[2]);
    json_number(json, "bidirectional", weights[3]);
    json_object_end(json);
}

static void layers_write(JsonWriter *json, const Snapshot *snapshot)
{
    bool halves = false;
    json_array_begin(json, "layers");
    for (size_t i = 0; i < snapshot->layer_count; ++i) {
        json_text(json, NULL, snapshot->layers[i].name);
        halves = halves || strcmp(snapshot->layers[i].name, "halfB") == 0;
    }
    if (halves)
        json_text(json, NULL, LAYER_DIFFERENCE);
    json_array_end(json);
}

static void curve_write(JsonWriter *json, const ErrorCurve *curve)
{
    json_array_begin(json, "errors");
    for (size_t i = 0; i < curve->count; ++i) {
        json_array_begin(json, NULL);
        json_number(json, NULL, curve->points[i].seconds);
        json_number(json, NULL, curve->points[i].error);
        json_array_end(json);
    }
    json_array_end(json);
}

void status_json_write(FILE *stream, const Snapshot *snapshot, const RenderFacts *facts, const ErrorCurve *curve)
{
    JsonWriter json;
    json_init(&json, stream);
    json_object_begin(&json, NULL);
    facts_write(&json, snapshot, facts);
    json_unsigned(&json, "version", snapshot->version);
    progress_write(&json, &snapshot->status);
    devices_write(&json, &snapshot->status);
    weights_write(&json, snapshot->status.weights);
    layers_write(&json, snapshot);
    curve_write(&json, curve);
    json_object_end(&json);
}
