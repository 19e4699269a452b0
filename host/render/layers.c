#include "render/layers.h"

#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "path/path_state.h"

#include <stdlib.h>

/* Most AOV samples per pixel, which are stratified (math/sobol.h). */
#define AOV_SAMPLES 8u

static bool wants(const RenderLayers *layers, Layer layer)
{
    return (layers->wanted & LAYER_BIT(layer)) != 0;
}

#define LAYER_OF(NAME, ...) [AOV_##NAME] = LAYER_##NAME,
static const Layer LAYER_OF_AOV[AOV_COUNT] = {AOV_LIST(LAYER_OF)};
#undef LAYER_OF

#define VALUES_OF(NAME, name, text, values, ...) [AOV_##NAME] = (values),
static const uint AOV_VALUES[AOV_COUNT] = {AOV_LIST(VALUES_OF)};
#undef VALUES_OF

static bool halves_init(RenderLayers *layers, const Film *film, Error *error)
{
    for (int i = 0; i < 2; ++i)
        if (!film_init_like(&layers->halves[i], film, error))
            return false;
    return true;
}

static bool aovs_init(RenderLayers *layers, const Film *film, double radius, Error *error)
{
    for (uint aov = 0; aov < AOV_COUNT; ++aov) {
        if (!wants(layers, LAYER_OF_AOV[aov]))
            continue;
        if (!film_init(&layers->aovs[aov], film->width, film->height, film->crop, error))
            return false;
        film_quantum_set(&layers->aovs[aov], AOV_VALUES[aov] == AOV_DISTANCE ? radius : 1.0);
    }
    return true;
}

bool render_layers_init(RenderLayers *layers, unsigned wanted, const Film *film, double radius, Error *error)
{
    *layers = (RenderLayers){.wanted = wanted};
    return (!wants(layers, LAYER_HALVES) || halves_init(layers, film, error)) &&
           (!wants(layers, LAYER_VARIANCE) || (pixel_series_init(&layers->own, film_pixels(film), 3, error) &&
                                               pixel_series_init(&layers->light, film_pixels(film), 3, error))) &&
           aovs_init(layers, film, radius, error);
}

void render_layers_destroy(RenderLayers *layers)
{
    for (int i = 0; i < 2; ++i)
        film_destroy(&layers->halves[i]);
    for (uint aov = 0; aov < AOV_COUNT; ++aov)
        film_destroy(&layers->aovs[aov]);
    pixel_series_destroy(&layers->own);
    pixel_series_destroy(&layers->light);
    *layers = (RenderLayers){0};
}

/* ---- halves and variance ----------------------------------------------------------------------------------------- */

static bool variance_add(RenderLayers *layers, const Film *part, Error *error)
{
    size_t bytes = 3 * film_pixels(part) * sizeof(float);
    float *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "variances");
    film_resolve_part(part, FILM_OWN, 1.0f, rgb);
    pixel_series_add(&layers->own, rgb, part->counts, 1.0);
    if (part->light_samples > 0) {
        film_resolve_part(part, FILM_LIGHT, 1.0f, rgb);
        pixel_series_add(&layers->light, rgb, NULL, (double)part->light_samples);
    }
    free(rgb);
    return true;
}

bool render_layers_add(RenderLayers *layers, const Film *part, unsigned half, Error *error)
{
    return (!wants(layers, LAYER_HALVES) || film_merge(&layers->halves[half], part, error)) &&
           (!wants(layers, LAYER_VARIANCE) || variance_add(layers, part, error));
}

void render_layers_variance(const RenderLayers *layers, float scale, size_t first, size_t count, float *rgb)
{
    double square = (double)scale * (double)scale;
    for (size_t value = 3 * first; value < 3 * (first + count); ++value)
        rgb[value - 3 * first] = (float)(square * (pixel_series_variance(&layers->own, value) +
                                                   pixel_series_variance(&layers->light, value)));
}

/* ---- variables --------------------------------------------------------------------------------------------------- */

static bool aov_list(StepList *list, Error *error)
{
    Recorder recorder;
    if (!recorder_init(&recorder, 3, error))
        return false;
    recorder_kernel(&recorder, KERNEL_pt_start_paths, false);
    recorder_step(&recorder, STEP_TRACE_CLOSEST);
    recorder_kernel(&recorder, KERNEL_aov_splat, false);
    *list = recorder_list(&recorder, PATH_WORDS, NULL, 0);
    return true;
}

static bool aov_run(Film *film, RenderRun *run, uint aov, unsigned sample, const StepList *list, Error *error)
{
    FrameParams frame = run->frame;
    const SplatSink sink = render_run_sink(film);
    frame.pass.aov = aov;
    frame.path.sobol = 1;
    frame.film.exponent = film->quantum_exponent;
    frame.pass.sample_index = run->options->first_sample + sample;
    frame.pass.first_item = 0;
    frame.pass.item_count = (uint)run->crop_pixels;
    return run->interface->run(run->backend, &frame, list, &sink, render_run_stop(run), NULL, error);
}

bool render_layers_sample(RenderRun *run, uint64_t samples, Error *error)
{
    RenderLayers *layers = run->options->layers;
    uint64_t wanted = samples / run->crop_pixels;
    StepList list;
    wanted = wanted < AOV_SAMPLES ? wanted : AOV_SAMPLES;
    if (!layers || layers->aov_samples >= wanted || (layers->wanted & LAYERS_AOV) == 0)
        return true;
    if (!aov_list(&list, error))
        return false;
    bool done = true;
    for (; done && layers->aov_samples < wanted; ++layers->aov_samples)
        for (uint aov = 0; done && aov < AOV_COUNT; ++aov)
            done = !wants(layers, LAYER_OF_AOV[aov]) ||
                   aov_run(&layers->aovs[aov], run, aov, layers->aov_samples, &list, error);
    step_list_destroy(&list);
    return done;
}
