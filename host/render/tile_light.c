#include "render/tile_light.h"

#include "base/largest_values.h"

#include <math.h>
#include <stdbool.h>

/* One in this many pixels may have more noise than is usual in the tile, because the pixel filter spreads a bright path
 * over several; and how many times the usual noise counts as noise. docs/NUMERICS.md. */
#define UNUSUAL_SHARE 7
#define USUAL_FACTOR 3.0

/* The noise that most pixels of the tile do not exceed, with a margin. */
static double usual_noise(const TileValues *values)
{
    double heap[TILE_PIXELS] = {0.0};
    LargestValues largest = {.heap = heap, .wanted = values->count / UNUSUAL_SHARE + 1};
    for (size_t i = 0; i < values->count; ++i)
        largest_values_add(&largest, fabs(values->difference[i]));
    return USUAL_FACTOR * largest_values_least(&largest);
}

double tile_mean(const double *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i)
        sum += values[i];
    return sum / (double)count;
}

/* A pixel's value without the part of its difference that is more than its noise: toward the darker half or the
 * brighter one. */
static double without_excess(const TileValues *values, size_t pixel, double noise, bool lower)
{
    double difference = fabs(values->difference[pixel]), value = values->picture[pixel];
    double a = values->halves[0][pixel], b = values->halves[1][pixel];
    double excess = difference > noise ? (difference - noise) / difference : 0.0;
    return value + excess * ((lower ? fmin(a, b) : fmax(a, b)) - value);
}

/* Takes from the values what differs by more than the tile's usual noise, and keeps the rest as noise. Values are moved
 * toward the tile's mean, as it is without any bright path that one half alone has met. */
static void excess_remove(const TileValues *values, double light[TILE_PIXELS], double noise[TILE_PIXELS])
{
    double usual = usual_noise(values);
    for (size_t i = 0; i < values->count; ++i) {
        noise[i] = fmin(fabs(values->difference[i]), usual);
        light[i] = without_excess(values, i, noise[i], true);
    }
    double mean = tile_mean(light, values->count);
    for (size_t i = 0; i < values->count; ++i)
        light[i] = without_excess(values, i, noise[i], values->picture[i] > mean);
}

void tile_light(const TileValues *values, double light[TILE_PIXELS])
{
    double noise[TILE_PIXELS], variety = 0.0, tile_noise = 0.0, count = (double)values->count;
    excess_remove(values, light, noise);
    double mean = tile_mean(light, values->count);
    for (size_t i = 0; i < values->count; ++i) {
        variety += (light[i] - mean) * (light[i] - mean) / count;
        tile_noise += noise[i] * noise[i] / count;
    }
    double variance = fmax(variety - tile_noise, 0.0); /* of the light */
    for (size_t i = 0; i < values->count; ++i) {
        double own = 0.75 * tile_noise + 0.25 * noise[i] * noise[i]; /* one difference alone tells little */
        light[i] = variance > 0.0 ? mean + variance / (variance + own) * (light[i] - mean) : mean;
    }
}
