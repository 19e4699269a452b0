/* Layers of an image besides the picture, for compositing, denoising and error bars. */
#ifndef TWINLIGHT_RENDER_LAYERS_H
#define TWINLIGHT_RENDER_LAYERS_H

#include "film/film.h"
#include "film/pixel_series.h"
#include "layout/aov_list.h"
#include "layout/frame_params.h"
#include "render/aov_image.h"
#include "render/run.h"

/* X(NAME, name, text, groups): LAYER_NAME, a part of the picture's light; name_add (picture.c); its name in --layers;
 * how many groups of three channels it has. Of MMLT: */
#define LAYER_LIST_LIGHT(X)                                                                                            \
    X(DIRECT, direct, "direct", 1) /* what path tracing alone renders, paths of up to two segments */                  \
    X(INDIRECT, indirect, "indirect", 1) /* the rest */                                                                \
    X(HALVES, halves, "halves", 2) /* two independent pictures with half of the work each */                           \
    X(VARIANCE, variance, "variance", 1) /* estimated, of each pixel of the picture */                                 \
    X(BY_DEPTH, by_depth, "by-depth", LAYER_DEPTHS) /* INDIRECT by number of segments (film_depths_reserve) */

#define LAYER_DEPTHS (int)(SPLAT_DEPTH_MAX + 1u - SPLAT_DEPTH_MIN)

/* All layers: those of light, and the variables of kernels/aov.cl, which every integrator has. */
#define LAYER_LIST(X) LAYER_LIST_LIGHT(X) AOV_LIST(X)

#define LAYER_ENUMERATE(NAME, ...) LAYER_##NAME,
typedef enum Layer { LAYER_LIST(LAYER_ENUMERATE) LAYER_COUNT } Layer;
#undef LAYER_ENUMERATE

#define LAYER_BIT(layer) (1u << (layer))
#define LAYER_BIT_OF(NAME, ...) | LAYER_BIT(LAYER_##NAME)
#define LAYERS_ALL ((0u LAYER_LIST(LAYER_BIT_OF)) & ~LAYER_BIT(LAYER_BY_DEPTH)) /* BY_DEPTH must be named */
#define LAYERS_AOV (0u AOV_LIST(LAYER_BIT_OF)) /* the default of mmlt: what compositors and denoisers ask for */

/* "albedo, normal, ... ": for texts about the layers of a list. */
#define LAYER_TEXT_OF(NAME, name, text, ...) text ", "

typedef struct RenderLayers {
    unsigned wanted; /* LAYER_BIT of each */
    bool keep_halves; /* even if they are not wanted: their difference is */
    Film halves[2];
    PixelSeries own[2], light[2]; /* for the variance of FILM_OWN and of FILM_LIGHT: of both halves */
    size_t size[2]; /* of the crop */
    float *stratified[2]; /* what is left of these two, per tile (pixel_series_stratified) */
    AovImage aovs[AOV_COUNT];
    unsigned aov_samples; /* samples per pixel so far */
} RenderLayers;

/* Whether the image's halves are compared, by its layers or for its error; their errors must then be independent.
 * layers: may be NULL. */
bool render_layers_compare_halves(const RenderLayers *layers);

/* Whether layers, or the halves, tell parts of the light apart: FILM_OWN and FILM_LIGHT, or depths. layers: may be
 * NULL. */
bool render_layers_split(const RenderLayers *layers);

/* Allocates the layers in `wanted`, and the halves if they are to be kept, for a film like `film`. Call
 * render_layers_destroy even on failure. */
bool render_layers_init(RenderLayers *layers, unsigned wanted, bool keep_halves, const Film *film, Error *error);
void render_layers_destroy(RenderLayers *layers);

/* Saves the layers, or restores them into layers made for the same film. */
void render_layers_archive(Archive *archive, RenderLayers *layers);

/* Adds an independent part of the picture to half 0 or 1 and to the variances. */
bool render_layers_add(RenderLayers *layers, const Film *part, unsigned half, Error *error);

/* Adds the layers of another shard of the picture. Its AOVs, which are the same in all shards, are taken (leaving
 * `from` with these) if they have more samples. */
bool render_layers_merge(RenderLayers *layers, RenderLayers *from, Error *error);

/* rgb[3 * count]: the estimated variance of scale x the picture in pixels first ... first + count - 1. */
void render_layers_variance(const RenderLayers *layers, float scale, size_t first, size_t count, float *rgb);

/* Renders the AOVs that the run's layers want, if any: brings them to as many samples per pixel as `samples` paths of
 * light make, at most 8, since AOVs are nearly noise-free. A shard makes those of the whole picture. */
bool render_layers_sample(RenderRun *run, uint64_t samples, Error *error);

#endif
