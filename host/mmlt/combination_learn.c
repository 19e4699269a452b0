/* Learns the estimators' variances from the generations before. */
#include "mmlt/combination_learn.h"

#include "base/sample_statistics.h"
#include "math/vec.h"
#include "mmlt/tuning.h"

#include <math.h>
#include <string.h>

size_t combination_tile_count(const Combination *combination)
{
    return (size_t)combination->tiles[0] * (size_t)combination->tiles[1];
}

size_t combination_tile_of(const Combination *combination, size_t pixel)
{
    size_t width = (size_t)combination->size[0], x = pixel % width, y = pixel / width;
    return y / TILE_SIDE * (size_t)combination->tiles[0] + x / TILE_SIDE;
}

double combination_mean_light(const Combination *combination)
{
    double light = 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        light += combination->known[i].light / (double)combination_tile_count(combination);
    return light;
}

/* ---- pictures ---------------------------------------------------------------------------------------------------- */

static float luminance_of(const int64_t *sums, double scale)
{
    float rgb[3];
    for (int c = 0; c < 3; ++c)
        rgb[c] = (float)(scale * (double)film_sum_shown(sums[c]));
    return rgb_luminance(vec3(rgb[0], rgb[1], rgb[2]));
}

/* The luminances of `sums`: picture, a value per pixel, and tiles, their sum per tile. */
static void image_of(const Combination *combination, const Film *film, const int64_t *sums, float *picture,
                     float *tiles)
{
    size_t pixels = film_pixels(film);
    double unit = ldexp((double)pixels / (double)film->light_samples, film->quantum_exponent);
    memset(tiles, 0, combination_tile_count(combination) * sizeof *tiles);
    for (size_t i = 0; i < pixels; ++i) {
        picture[i] = luminance_of(sums + 3 * i, unit);
        tiles[combination_tile_of(combination, i)] += picture[i];
    }
}

/* Adds the luminances of `sums` to series s. picture, tiles: scratch, a value per pixel and per tile. */
static void series_learn(Combination *combination, int s, const Film *film, const int64_t *sums, float *picture,
                         float *tiles)
{
    double samples = (double)film->light_samples;
    image_of(combination, film, sums, picture, tiles);
    pixel_series_add(&combination->pixels[s], picture, NULL, samples);
    pixel_series_add(&combination->sums[s], tiles, NULL, samples);
}

void combination_films_learn(Combination *combination, Film *const films[], float *picture, float *tiles,
                             const atomic_int *stop)
{
    const Film *chains = films[ESTIMATOR_CHAINS], *paths = films[ESTIMATOR_PATHS];
    for (int s = 0; s < ESTIMATOR_COUNT && !*stop; ++s)
        if (films[s]->light_samples > 0)
            series_learn(combination, s, films[s], films[s]->light_sums, picture, tiles);
    if (!*stop)
        series_learn(combination, SERIES_EXCESS, chains, chains->sums, picture, tiles);
    if (!*stop)
        series_learn(combination, SERIES_RARE, chains, chains->rare_sums, picture, tiles);
    if (!*stop && paths->light_samples > 0) {
        image_of(combination, paths, paths->sums, picture, tiles);
        pixel_series_add(&combination->direct, picture, NULL, (double)paths->light_samples);
    }
}

/* ---- variances --------------------------------------------------------------------------------------------------- */

/* Degrees of freedom of the series' variances: the number of its pictures less one. */
static double freedom_of(const Combination *combination, int s)
{
    return combination->pixels[s].pictures[0] > 0 ? combination->pixels[s].pictures[0] - 1.0 : 0.0;
}

/* Lower confidence bound of a tile's light: its mean less `deviations` standard errors. 0 until the series' variance is
 * known. */
static double light_bound(const Combination *combination, int s, size_t tile, double deviations)
{
    if (!(freedom_of(combination, s) >= 1.0))
        return 0.0;
    double error = sqrt(pixel_series_variance(&combination->sums[s], tile));
    return (double)combination->sums[s].mean[tile] - deviations * error;
}

/* The largest such bound over the estimates of the tile's whole light: path tracing plus rare, chains, or pool plus
 * excess. */
static double light_bound_best(const Combination *combination, size_t tile, double deviations)
{
    double chains = light_bound(combination, ESTIMATOR_CHAINS, tile, deviations),
           pool = light_bound(combination, ESTIMATOR_POOL, tile, deviations);
    return fmax(light_bound(combination, ESTIMATOR_PATHS, tile, deviations) +
                    light_bound(combination, SERIES_RARE, tile, deviations),
                fmax(chains, pool) + light_bound(combination, SERIES_EXCESS, tile, deviations));
}

/* Squared luminance of a pixel, clamped to LIGHT_OVER_TILE times its tile's mean, plus `dark`. While chains have made
 * few steps per pixel, their mean of a pixel is pulled toward that of its tile: otherwise the few pixels they have
 * visited would count as bright, and the chains' relative variance as small. */
static double light_square(const Combination *combination, size_t pixel, const CombinationTile *tile, double dark)
{
    const double area = TILE_SIDE * TILE_SIDE;
    double steps = (double)combination->pixels[ESTIMATOR_CHAINS].weight[pixel] / (double)combination->direct.pixels;
    double chains = (double)combination->pixels[ESTIMATOR_CHAINS].mean[pixel] +
                    (double)combination->pixels[SERIES_EXCESS].mean[pixel];
    double light = (double)combination->direct.mean[pixel] +
                   (steps * chains + LIGHT_STEPS * tile->indirect / area) / (steps + LIGHT_STEPS);
    light = fmin(fabs(light), LIGHT_OVER_TILE * tile->light / area);
    return light * light + dark;
}

/* Sums the tiles' variances, each pixel's weighted by the squared luminance of its tile over its own. */
static void tiles_sum(Combination *combination)
{
    const double area = TILE_SIDE * TILE_SIDE;
    double mean = 0.0;
    memset(combination->known, 0, combination_tile_count(combination) * sizeof *combination->known);
    for (size_t i = 0; i < combination->direct.pixels; ++i)
        combination->known[combination_tile_of(combination, i)].light += fabs((double)combination->direct.mean[i]);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        combination->known[i].indirect = light_bound_best(combination, i, 0.0);
        combination->known[i].light += combination->known[i].indirect;
        mean += combination->known[i].light / (area * (double)combination_tile_count(combination));
    }
    for (size_t i = 0; i < combination->direct.pixels; ++i) {
        CombinationTile *tile = &combination->known[combination_tile_of(combination, i)];
        double tile_mean = tile->light / area, dark = DARK_PART * mean * mean;
        double weight = (tile_mean * tile_mean + dark) / light_square(combination, i, tile, dark);
        for (int s = 0; s < SERIES_COUNT; ++s)
            tile->spread[s] += weight * pixel_series_spread(&combination->pixels[s], i);
        tile->direct += weight * pixel_series_spread(&combination->direct, i);
    }
}

/* By how much the variance of a tile's sum exceeds the sum of its pixels' variances, relative to light and over all
 * tiles: 1 if pixels are independent, more for chains, whose steps visit several of them. */
static double correlation_of(const Combination *combination, int s)
{
    const double area = TILE_SIDE * TILE_SIDE;
    double sums = 0.0, pixels = 0.0, mean = combination_mean_light(combination), dark = DARK_PART * mean * mean;
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        double light = combination->known[i].light;
        sums += pixel_series_spread(&combination->sums[s], i) / fmax(light * light + dark, SPREAD_MIN);
    }
    for (size_t i = 0; i < combination->direct.pixels; ++i) {
        double light = combination->known[combination_tile_of(combination, i)].light;
        pixels += pixel_series_spread(&combination->pixels[s], i) / fmax(light * light + dark, SPREAD_MIN);
    }
    return pixels > 0.0 ? fmin(fmax(sums / pixels, 1.0), area) : 1.0;
}

/* Median over the tiles (the upper one of an even number) of an estimator's variance over light. ratios: scratch. */
static double ratio_median(const Combination *combination, int s, double *ratios)
{
    size_t count = 0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        if (combination->known[i].indirect > 0.0)
            ratios[count++] = combination->known[i].spread[s] / combination->known[i].indirect;
    sample_sort(ratios, count);
    return count > 0 ? ratios[count / 2] : 0.0;
}

/* If another series has significantly more light in the tile than series s, then s finds that light about once in all
 * its samples or less: adds the variance of one such event. */
static double missing_spread(const Combination *combination, int s, size_t tile)
{
    const double deviations = MISSING_DEVIATIONS;
    const PixelSeries *sums = combination->sums;
    double other, own = (double)sums[s].mean[tile];
    if (s == ESTIMATOR_CHAINS || s == ESTIMATOR_POOL) {
        other = light_bound(combination, s == ESTIMATOR_CHAINS ? ESTIMATOR_POOL : ESTIMATOR_CHAINS, tile, deviations);
    } else {
        other = light_bound_best(combination, tile, deviations);
        if (s == SERIES_EXCESS)
            own += fmax((double)sums[ESTIMATOR_CHAINS].mean[tile], (double)sums[ESTIMATOR_POOL].mean[tile]);
        else
            own += (double)sums[SERIES_RARE].mean[tile];
    }
    double missing = fmax(other - own, 0.0);
    return missing * missing * (double)sums[s].weight[tile];
}

/* An estimator's variance over light in the 3 x 3 tiles around. */
static double ratio_around(const Combination *combination, int s, size_t tile)
{
    int columns = combination->tiles[0], rows = combination->tiles[1], x = (int)(tile % (size_t)columns),
        y = (int)(tile / (size_t)columns);
    double spread = 0.0, light = 0.0;
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < rows; ++j)
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < columns; ++i) {
            const CombinationTile *near = &combination->known[(size_t)j * (size_t)columns + (size_t)i];
            spread += near->spread[s];
            light += near->indirect;
        }
    return light > 0.0 ? spread / light : 0.0;
}

/* Raises a tile's variance to that of the 3 x 3 tiles around it: if one of them has found a rare bright path, the
 * others may just not have found it yet; docs/TUNING.md. */
static void spreads_share(Combination *combination, int s, double *ratios)
{
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        ratios[i] = ratio_around(combination, s, i);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        CombinationTile *tile = &combination->known[i];
        tile->spread[s] = fmax(tile->spread[s], ratios[i] * tile->indirect);
    }
}

/* Samples of path tracing are stratified across the generations of a replica (paths_estimator.h); `other` is the other one, if there are two. */
static void stratification_apply(Combination *combination, const Combination *other)
{
    const int s = ESTIMATOR_PATHS;
    const PixelWindow all = {(size_t)combination->size[0], 0, 0, (size_t)combination->size[0],
                             (size_t)combination->size[1]};
    double indirect = pixel_series_stratified(&combination->pixels[s], &other->pixels[s], all, DARK_PART),
           direct = pixel_series_stratified(&combination->direct, &other->direct, all, DARK_PART);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        combination->known[i].spread[s] *= indirect;
        combination->known[i].direct *= direct;
    }
}

void combination_variances_update(Combination *combination, const Combination *other, double *ratios)
{
    tiles_sum(combination);
    stratification_apply(combination, other);
    for (int s = 0; s < SERIES_COUNT; ++s) {
        double factor = 1.0 + CORRELATION_PART * (correlation_of(combination, s) - 1.0);
        for (size_t i = 0; i < combination_tile_count(combination); ++i)
            combination->known[i].spread[s] *= factor;
        spreads_share(combination, s, ratios);
        double usual = ratio_median(combination, s, ratios), known = freedom_of(combination, s);
        combination->ready[s] = known >= 1.0;
        for (size_t i = 0; i < combination_tile_count(combination); ++i) {
            CombinationTile *tile = &combination->known[i];
            tile->spread[s] =
                (known * tile->spread[s] + PRIOR_GENERATIONS * usual * tile->indirect) / (known + PRIOR_GENERATIONS) +
                (s == SERIES_RARE ? 0.0 : missing_spread(combination, s, i));
        }
    }
}
