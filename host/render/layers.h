/* Layers of an image besides the picture, for compositing, denoising and error bars. */
#ifndef TWINLIGHT_RENDER_LAYERS_H
#define TWINLIGHT_RENDER_LAYERS_H

#include "film/film.h"
#include "film/pixel_series.h"
#include "layout/frame_params.h"
#include "render/run.h"

typedef enum Layer {
    LAYER_DIRECT, /* MMLT: what path tracing alone renders, paths of up to two segments */
    LAYER_INDIRECT, /* MMLT: the rest */
    LAYER_HALVES, /* two independent pictures with half of the work each */
    LAYER_VARIANCE, /* estimated, of each pixel of the picture */
    LAYER_ALBEDO, /* the next three: kernels/aov.cl */
    LAYER_NORMAL,
    LAYER_DEPTH,
    LAYER_BY_DEPTH, /* LAYER_INDIRECT by number of segments, from the film (film_depths_reserve) */
    LAYER_COUNT
} Layer;

#define LAYER_BIT(layer) (1u << (layer))
#define LAYERS_ALL (LAYER_BIT(LAYER_BY_DEPTH) - 1u) /* not LAYER_BY_DEPTH, which must be named */
#define LAYERS_AOV (LAYER_BIT(LAYER_ALBEDO) | LAYER_BIT(LAYER_NORMAL) | LAYER_BIT(LAYER_DEPTH))

typedef struct RenderLayers {
    unsigned wanted; /* LAYER_BIT of each */
    Film halves[2];
    PixelSeries own, light; /* for the variance of FILM_OWN and of FILM_LIGHT */
    Film aovs[AOV_COUNT];
    unsigned aov_samples; /* samples per pixel so far */
} RenderLayers;

/* Allocates the layers in `wanted` for a film like `film`. radius: of the scene's bounding sphere, which sets the
 * quantum of AOV_DEPTH. Call render_layers_destroy even on failure. */
bool render_layers_init(RenderLayers *layers, unsigned wanted, const Film *film, double radius, Error *error);
void render_layers_destroy(RenderLayers *layers);

/* Adds an independent part of the picture to half 0 or 1 and to the variances. */
bool render_layers_add(RenderLayers *layers, const Film *part, unsigned half, Error *error);

/* rgb[3 * count]: the estimated variance of scale x the picture in pixels first ... first + count - 1. */
void render_layers_variance(const RenderLayers *layers, float scale, size_t first, size_t count, float *rgb);

/* Renders the AOVs that the run's layers want, if any: brings them to as many samples per pixel as `samples` paths of
 * light make, at most 16, since AOVs are nearly noise-free. */
bool render_layers_sample(RenderRun *run, uint64_t samples, Error *error);

#endif
