/* Several estimates of the same picture in one: what the chains of a generation show, what the pool's samples show from
 * which they began, and what path tracing sees. In easy light path tracing is the best of them, in hard light the chains,
 * and which it is changes from place to place.
 *
 * Each tile of the picture takes a share of every stream, in inverse proportion to its variance (Graybill and Deal 1959),
 * which is estimated from the generations before: a share that depends on nothing of the generation it is applied to
 * leaves the mean of that one right, where its chains are new. The blend of all is consistent.
 *
 * A path that carries more than a limit is a bright dot where a pool or path tracing has met it by chance; each shows as much of it as the limit, and the rest is left to the chains, which come by many of its like. What it
 * carries depends on how probable it is that the stream makes it, so both leave different parts. The same variances say how
 * the time is divided. */
#ifndef TWINLIGHT_BLEND_H
#define TWINLIGHT_BLEND_H

#include "film.h"
#include "pixel_series.h"

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

/* The work of so many samples of every stream, in samples of path tracing: with typical times of the CPU backend, not
 * those of the machine, so that the image does not depend on it. */
double blend_work(const double samples[BLEND_STREAMS]);

/* For films like `film`. */
bool blend_init(Blend *blend, const Film *film, Error *error);
void blend_destroy(Blend *blend);

/* The streams of one generation: light_sums from light_samples paths each (0: the stream has nothing this time). The
 * film of the paths has direct light in `sums`, that of the chains what pools do not show, and in rare_sums what path tracing
 * does not. Makes the film of the chains the blend of all, with that direct light, in the
 * shares that `teacher` has learnt, then teaches `blend` what they were. Both may be the same where generations know
 * nothing of each other. */
bool blend_generation(Blend *blend, Blend *teacher, Film *const films[BLEND_STREAMS], Error *error);

/* Relative square error of a tile's pixels from so many samples of every stream, direct light left out. Zeros before enough is
 * known. */
void blend_errors(const Blend *blend, const double samples[BLEND_STREAMS], double *errors);

/* How many samples for every step of a chain. */
typedef struct BlendPlan {
    double paths_per_step, pool_per_step;
} BlendPlan;

/* The plan that makes the relative error of the whole picture smallest in a given time; zeros before enough is known. */
BlendPlan blend_plan(const Blend *blend);

#endif
