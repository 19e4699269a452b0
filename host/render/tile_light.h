/* The light of a tile's pixels, as far as two halves of a picture tell it: what an error is relative to.
 *
 * A pixel's own value is not enough: one that noise has made bright would have a small relative error, one that noise
 * has made dark a large one. Nor is the tile's mean, where pixels differ or where a bright path has met one of them. */
#ifndef TWINLIGHT_RENDER_TILE_LIGHT_H
#define TWINLIGHT_RENDER_TILE_LIGHT_H

#include "compare/metrics.h"

#define TILE_PIXELS (METRICS_TILE * METRICS_TILE)

/* One channel of a tile; all values are finite. */
typedef struct TileValues {
    size_t count; /* 1 ... TILE_PIXELS */
    double halves[2][TILE_PIXELS];
    double picture[TILE_PIXELS]; /* between the halves, nearer to the one with more samples */
    double difference[TILE_PIXELS]; /* of the halves, with the picture's variance as its mean square */
} TileValues;

/* The mean of a tile's values of one kind. count >= 1. */
double tile_mean(const double *values, size_t count);

/* Estimates the light of each pixel. What one half alone has of a pixel beyond the noise that is usual in the tile does
 * not count; the rest is taken from the pixel and from the tile's mean, in proportion to what they differ by and to the
 * pixel's own noise (empirical Bayes; Efron and Morris, "Stein's Estimation Rule and Its Competitors", 1973). */
void tile_light(const TileValues *values, double light[TILE_PIXELS]);

#endif
