/* What an image holds besides the picture, for compositing, denoising and error bars. */
#ifndef TWINLIGHT_RENDER_LAYERS_H
#define TWINLIGHT_RENDER_LAYERS_H

#include "film/film.h"
#include "film/pixel_series.h"
#include "layout/scene_types.h"
#include "render/run.h"

typedef enum Layer {
    LAYER_DIRECT, /* what path tracing saw */
    LAYER_INDIRECT, /* what chains brought */
    LAYER_HALVES, /* two pictures, each of half of the work, independent of each other */
    LAYER_VARIANCE, /* of the picture */
    LAYER_ALBEDO, /* these three: kernels/aov.cl */
    LAYER_NORMAL,
    LAYER_DEPTH,
    LAYER_BY_DEPTH, /* what chains brought of each number of segments, in the film (film_depths_reserve) */
    LAYER_COUNT
} Layer;

#define LAYER_BIT(layer) (1u << (layer))
#define LAYERS_ALL (LAYER_BIT(LAYER_BY_DEPTH) - 1u) /* the last only where it is named */
#define LAYERS_AOV (LAYER_BIT(LAYER_ALBEDO) | LAYER_BIT(LAYER_NORMAL) | LAYER_BIT(LAYER_DEPTH))

typedef struct RenderLayers {
    unsigned wanted; /* LAYER_BIT */
    Film halves[2];
    PixelSeries own, light; /* of what path tracing saw, and of what chains brought */
    Film aovs[AOV_COUNT];
    unsigned aov_samples; /* of every pixel, so far */
} RenderLayers;

/* Makes room for what is wanted of a film like `film`. `radius`: of the scene. */
bool render_layers_init(RenderLayers *layers, unsigned wanted, const Film *film, double radius, Error *error);
void render_layers_destroy(RenderLayers *layers);

/* Adds a part of the picture that is independent of all others: to half 0 or 1, and to the variances of what path
 * tracing saw and of what chains brought. */
bool render_layers_add(RenderLayers *layers, const Film *part, unsigned half, Error *error);

/* rgb[3 x count] = the estimated variance of scale x the picture, in pixels first ... first + count - 1. */
void render_layers_variance(const RenderLayers *layers, float scale, size_t first, size_t count, float *rgb);

/* Takes samples of the AOVs that the run's layers want, if it has any: as many of a pixel as it has of light when all
 * have `samples` together, at most 16, for AOVs are nearly free of noise. */
bool render_layers_sample(RenderRun *run, uint64_t samples, Error *error);

#endif
