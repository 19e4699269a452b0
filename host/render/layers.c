#include "render/layers.h"

#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "path/path_state.h"
#include "render/shard.h"

#include <stdlib.h>

/* Most AOV samples per pixel, which are stratified (math/sobol.h). */
#define AOV_SAMPLES 8u

static bool wants(const RenderLayers *layers, Layer layer)
{
    return (layers->wanted & LAYER_BIT(layer)) != 0;
}

static bool has_halves(const RenderLayers *layers)
{
    return layers->keep_halves || wants(layers, LAYER_HALVES);
}

bool render_layers_compare_halves(const RenderLayers *layers)
{
    return layers && (has_halves(layers) || wants(layers, LAYER_VARIANCE));
}

bool render_layers_split(const RenderLayers *layers)
{
    return layers && (has_halves(layers) || (layers->wanted & ~LAYERS_AOV) != 0);
}

#define LAYER_OF(NAME, ...) [AOV_##NAME] = LAYER_##NAME,
static const Layer LAYER_OF_AOV[AOV_COUNT] = {AOV_LIST(LAYER_OF)};
#undef LAYER_OF

_Static_assert((int)AOV_COUNT <= (int)SPLAT_FILMS, "a splat has bits for the number of the variable");

_Static_assert(AOV_SAMPLES <= AOV_SAMPLES_MAX, "samples are counted in bytes");

#define CHANNELS_OF(NAME, name, text, values, red, green, blue) [AOV_##NAME] = sizeof(green) > 1 ? 3 : 1,
static const size_t AOV_CHANNELS[AOV_COUNT] = {AOV_LIST(CHANNELS_OF)};
#undef CHANNELS_OF

#define VALUES_OF(NAME, name, text, values, ...) [AOV_##NAME] = values,
static const uint AOV_VALUES[AOV_COUNT] = {AOV_LIST(VALUES_OF)};
#undef VALUES_OF

static bool halves_init(RenderLayers *layers, const Film *film, Error *error)
{
    for (int i = 0; i < 2; ++i)
        if (!film_init_like(&layers->halves[i], film, error))
            return false;
    return true;
}

/* Pixels a side of the tiles in which stratification is taken to do the same for all pixels. */
#define TILE 8u

/* Makes all values of a tile count alike, however bright they are (pixel_series_stratified). */
#define ALIKE 1e6

static size_t tiles_along(size_t pixels)
{
    return (pixels + TILE - 1) / TILE;
}

static bool variance_init(RenderLayers *layers, const Film *film, Error *error)
{
    for (int i = 0; i < 2; ++i)
        layers->size[i] = (size_t)(film->crop[i + 2] - film->crop[i]);
    size_t tiles = tiles_along(layers->size[0]) * tiles_along(layers->size[1]);
    for (int i = 0; i < 2; ++i) {
        layers->stratified[i] = calloc(tiles, sizeof *layers->stratified[i]);
        if (!layers->stratified[i])
            return error_memory(error, tiles * sizeof *layers->stratified[i], "variances");
    }
    for (int i = 0; i < 2; ++i)
        if (!pixel_series_init(&layers->own[i], film_pixels(film), 3, false, error) ||
            !pixel_series_init(&layers->light[i], film_pixels(film), 3, true, error))
            return false;
    return true;
}

static bool aovs_init(RenderLayers *layers, const Film *film, Error *error)
{
    const AovImage *counted = NULL; /* by which the others that have a sample of every ray count theirs */
    for (uint aov = 0; aov < AOV_COUNT; ++aov) {
        bool every = AOV_VALUES[aov] != AOV_DISTANCE;
        const AovKind kind = {AOV_CHANNELS[aov], AOV_VALUES[aov] == AOV_PART};
        if (!wants(layers, LAYER_OF_AOV[aov]))
            continue;
        if (!aov_image_init(&layers->aovs[aov], film, kind, every ? counted : NULL, error))
            return false;
        counted = every && !counted ? &layers->aovs[aov] : counted;
    }
    return true;
}

bool render_layers_init(RenderLayers *layers, unsigned wanted, bool keep_halves, const Film *film, Error *error)
{
    *layers = (RenderLayers){.wanted = wanted, .keep_halves = keep_halves};
    return (!has_halves(layers) || halves_init(layers, film, error)) &&
           (!wants(layers, LAYER_VARIANCE) || variance_init(layers, film, error)) && aovs_init(layers, film, error);
}

void render_layers_destroy(RenderLayers *layers)
{
    for (int i = 0; i < 2; ++i) {
        film_destroy(&layers->halves[i]);
        pixel_series_destroy(&layers->own[i]);
        pixel_series_destroy(&layers->light[i]);
        free(layers->stratified[i]);
    }
    for (uint aov = 0; aov < AOV_COUNT; ++aov)
        aov_image_destroy(&layers->aovs[aov]);
    *layers = (RenderLayers){0};
}

static void variance_archive(Archive *archive, RenderLayers *layers)
{
    size_t tiles = tiles_along(layers->size[0]) * tiles_along(layers->size[1]);
    for (int i = 0; i < 2; ++i) {
        pixel_series_archive(archive, &layers->own[i]);
        pixel_series_archive(archive, &layers->light[i]);
        archive_floats(archive, layers->stratified[i], tiles, (NumberRange){0.0, 1.0}, "the parts left of variances");
    }
}

void render_layers_archive(Archive *archive, RenderLayers *layers)
{
    archive_same(archive, layers->wanted, "the layers");
    archive_same(archive, has_halves(layers), "the halves");
    for (int i = 0; i < 2 && has_halves(layers); ++i)
        film_archive(archive, &layers->halves[i]);
    if (wants(layers, LAYER_VARIANCE))
        variance_archive(archive, layers);
    for (uint aov = 0; aov < AOV_COUNT; ++aov)
        if (wants(layers, LAYER_OF_AOV[aov]))
            aov_image_archive(archive, &layers->aovs[aov]);
    ARCHIVE_FIELD(archive, layers->aov_samples);
}

/* ---- halves and variance ----------------------------------------------------------------------------------------- */

static void stratified_set(const RenderLayers *layers, const PixelSeries halves[2], float *stratified)
{
    size_t columns = tiles_along(layers->size[0]), rows = tiles_along(layers->size[1]);
    for (size_t tile = 0; tile < columns * rows; ++tile) {
        PixelWindow window = {layers->size[0], tile % columns * TILE, tile / columns * TILE, 0, 0};
        window.x1 = window.x0 + TILE < layers->size[0] ? window.x0 + TILE : layers->size[0];
        window.y1 = window.y0 + TILE < layers->size[1] ? window.y0 + TILE : layers->size[1];
        stratified[tile] = (float)pixel_series_stratified(&halves[0], &halves[1], window, ALIKE);
    }
}

static void stratified_renew(RenderLayers *layers)
{
    stratified_set(layers, layers->own, layers->stratified[0]);
    stratified_set(layers, layers->light, layers->stratified[1]);
}

static bool variance_add(RenderLayers *layers, const Film *part, unsigned half, Error *error)
{
    size_t bytes = 3 * film_pixels(part) * sizeof(float);
    float *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "variances");
    film_resolve_part(part, FILM_OWN, 1.0f, rgb);
    pixel_series_add_counted(&layers->own[half], rgb, part->counts, part->every_count);
    if (part->light_samples > 0) {
        film_resolve_part(part, FILM_LIGHT, 1.0f, rgb);
        pixel_series_add(&layers->light[half], rgb, NULL, (double)part->light_samples);
    }
    free(rgb);
    stratified_renew(layers);
    return true;
}

/* Variance of the mean over both halves. */
static double variance_of(const PixelSeries halves[2], size_t value)
{
    size_t pixel = value / (size_t)halves->channels;
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < 2; ++i) {
        double own = pixel_series_weight(&halves[i], pixel);
        sum += own * own * pixel_series_variance(&halves[i], value);
        weight += own;
    }
    return weight > 0.0 ? sum / (weight * weight) : 0.0;
}

bool render_layers_add(RenderLayers *layers, const Film *part, unsigned half, Error *error)
{
    return (!has_halves(layers) || film_merge(&layers->halves[half], part, error)) &&
           (!wants(layers, LAYER_VARIANCE) || variance_add(layers, part, half, error));
}

bool render_layers_merge(RenderLayers *layers, RenderLayers *from, Error *error)
{
    for (int i = 0; i < 2 && wants(layers, LAYER_HALVES); ++i)
        if (!film_merge(&layers->halves[i], &from->halves[i], error))
            return false;
    for (int i = 0; i < 2 && wants(layers, LAYER_VARIANCE); ++i) {
        pixel_series_merge(&layers->own[i], &from->own[i]);
        pixel_series_merge(&layers->light[i], &from->light[i]);
    }
    if (wants(layers, LAYER_VARIANCE))
        stratified_renew(layers);
    if (from->aov_samples <= layers->aov_samples)
        return true;
    for (uint aov = 0; aov < AOV_COUNT; ++aov) {
        AovImage image = layers->aovs[aov];
        layers->aovs[aov] = from->aovs[aov];
        from->aovs[aov] = image;
    }
    unsigned samples = layers->aov_samples;
    layers->aov_samples = from->aov_samples;
    from->aov_samples = samples;
    return true;
}

void render_layers_variance(const RenderLayers *layers, float scale, size_t first, size_t count, float *rgb)
{
    double square = (double)scale * (double)scale;
    for (size_t value = 3 * first; value < 3 * (first + count); ++value) {
        size_t x = value / 3 % layers->size[0], y = value / 3 / layers->size[0];
        size_t tile = y / TILE * tiles_along(layers->size[0]) + x / TILE;
        rgb[value - 3 * first] =
            (float)(square * ((double)layers->stratified[0][tile] * variance_of(layers->own, value) +
                              (double)layers->stratified[1][tile] * variance_of(layers->light, value)));
    }
}

/* ---- variables --------------------------------------------------------------------------------------------------- */

/* A pass for `count` variables. */
static bool aov_list(const FrameParams *frame, uint count, StepList *list, Error *error)
{
    Recorder recorder;
    if (!recorder_init(&recorder, 2 + 2 * (size_t)count, error))
        return false;
    recorder_kernel(&recorder, KERNEL_pt_start_paths, false);
    recorder_step(&recorder, STEP_TRACE_CLOSEST);
    recorder_kernel(&recorder, KERNEL_aov_shade_hits, false);
    for (uint i = 0; i < count; ++i) {
        if (i > 0)
            recorder_step(&recorder, STEP_SPLAT);
        recorder_kernel(&recorder, KERNEL_aov_splat, false);
    }
    *list = recorder_list(&recorder, frame, PATH_WORDS, NULL, 0);
    return true;
}

static void aov_splats(void *context, const uint *splats, uint count, uint stride)
{
    RenderLayers *layers = context;
    aov_images_add(layers->aovs, AOV_COUNT, splats, count, stride);
}

/* Makes a sample of every pixel of the variables in the bits `aovs`. */
static bool aov_run(RenderRun *run, uint aovs, const StepList *list, Error *error)
{
    RenderLayers *layers = run->options->layers;
    FrameParams frame = run->frame;
    const SplatSink sink = {.splats = aov_splats, .context = layers};
    render_frame_seed(&frame, run->options->seed);
    frame.pass.aovs = aovs;
    frame.path.sobol = 1;
    frame.film.reconstruction = RECONSTRUCTION_SAMPLE;
    frame.pass.sample_index = run->options->first_sample + layers->aov_samples;
    frame.pass.first_item = 0;
    frame.pass.item_count = (uint)run->crop_pixels;
    return run->interface->run(run->backend, &frame, list, &sink, render_run_stop_between(run), NULL, error);
}

/* Samples that the variables should have by now. Every shard makes those of the whole picture, in proportion to what is
 * done of its share, so that they do not depend on how the picture is divided. */
static uint64_t aov_samples_wanted(const RenderRun *run, uint64_t samples)
{
    const RenderOptions *options = run->options;
    uint64_t wanted = samples / run->crop_pixels;
    if (shard_given(options)) {
        wanted *= options->shard.count;
        wanted = options->samples > 0 && wanted > options->samples ? options->samples : wanted;
    }
    return wanted < AOV_SAMPLES ? wanted : AOV_SAMPLES;
}

bool render_layers_sample(RenderRun *run, uint64_t samples, Error *error)
{
    RenderLayers *layers = run->options->layers;
    uint64_t wanted = aov_samples_wanted(run, samples);
    uint aovs = 0, count = 0;
    StepList list;
    if (!layers || layers->aov_samples >= wanted || (layers->wanted & LAYERS_AOV) == 0 || *render_run_stop(run))
        return true;
    for (uint aov = 0; aov < AOV_COUNT; ++aov)
        if (wants(layers, LAYER_OF_AOV[aov])) {
            aovs |= 1u << aov;
            ++count;
        }
    if (!aov_list(&run->frame, count, &list, error))
        return false;
    bool done = true;
    for (; done && layers->aov_samples < wanted; ++layers->aov_samples)
        done = aov_run(run, aovs, &list, error);
    step_list_destroy(&list);
    return done;
}
