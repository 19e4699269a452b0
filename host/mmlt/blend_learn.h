/* What a blend (mmlt/blend.h) knows of its streams, and learns of them in every generation. */
#ifndef TWINLIGHT_MMLT_BLEND_LEARN_H
#define TWINLIGHT_MMLT_BLEND_LEARN_H

#include "film/film.h"
#include "film/pixel_series.h"

#include <stdatomic.h>

#define BLEND_TILE 8 /* pixels a side */

typedef enum BlendStream { BLEND_CHAINS, BLEND_POOL, BLEND_PATHS, BLEND_STREAMS } BlendStream;

/* Series of pictures more: what chains see that pools do not show, and that path tracing does not. */
#define BLEND_EXCESS BLEND_STREAMS
#define BLEND_RARE (BLEND_STREAMS + 1)
#define BLEND_SERIES (BLEND_STREAMS + 2)

typedef struct BlendTile {
    double spread[BLEND_SERIES]; /* variance of one sample, summed over the pixels */
    double direct; /* the same of direct light */
    double light, indirect; /* sums of luminances */
    double share[BLEND_STREAMS]; /* of the latest generation */
} BlendTile;

typedef struct Blend {
    int size[2], tiles[2];
    PixelSeries pixels[BLEND_SERIES], sums[BLEND_SERIES]; /* luminances of pixels, and summed over tiles */
    PixelSeries direct; /* of pixels */
    double *rarity; /* of a tile: by how much more rarely pools visit it than if they visited all alike */
    double *gaps; /* of a tile: that less what a pool has visited of a pixel, where it is less, summed over pools */
    BlendTile *known; /* a tile */
    bool ready[BLEND_SERIES]; /* the stream's variances are there */
    double share[BLEND_STREAMS]; /* of the latest generation, mean over the tiles */
    int shown; /* 1 + the stream that has all of it in generations that have samples of it; 0: as is best */
} Blend;

/* Errors of places darker than the root of this part of the mean square light count as there. */
#define DARK_PART 0.1

size_t blend_tile_count(const Blend *blend);
size_t blend_tile_of(const Blend *blend, size_t pixel);

/* What the streams of a generation show joins the series, as long as *stop is 0. picture, tiles: room for as many values. */
void blend_films_learn(Blend *blend, Film *const films[], float *picture, float *tiles, const atomic_int *stop);

/* What is known of the tiles from the series. ratios: room for as many as there are tiles. */
void blend_spreads_update(Blend *blend, double *ratios);

#endif
