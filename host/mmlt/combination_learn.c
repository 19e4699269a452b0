/* What a combination learns of its estimators from the generations before. */
#include "mmlt/combination_learn.h"

#include "base/sample_statistics.h"
#include "math/vec.h"

#include <math.h>
#include <string.h>

/* A tile's variance from few generations is uncertain, and that of independent samples is too small until a rare bright
 * path has been met. All are drawn toward the variance that tiles usually have for their brightness (the median), as if
 * that had been seen in so many generations more. */
#define PRIOR_GENERATIONS 2.0

/* Standard errors by which one estimator must be brighter than another before that counts as light which the other
 * misses: few while little is known, half of these after so many generations. Had it been all of them from the first
 * on, rare bright paths would be believed too long to be absent: six times the error of blocks in short pictures of
 * scenes/windows.pbrt. With none, chance would be taken for light: a fifth more noise on a door ajar. */
#define MISSING_DEVIATIONS 2.0
#define MISSING_GENERATIONS 5.0

/* And so many more where the other is as uncertain as it is bright. In a large picture chains are in few tiles, and
 * their chance was taken for light that path tracing misses: a tenth of the square error of a diffuse room, and a fifth
 * of that of lamps in glass. */
#define MISSING_UNCERTAIN 3.0

/* A pixel counts as no brighter than so many times its tile's mean: it may be noise. */
#define LIGHT_OVER_TILE 4.0

/* A pixel's own light counts as much as its tile's where chains have shown so many steps of it. */
#define LIGHT_STEPS 16.0

/* A pool's variance is no less than this part of what is seen, whatever a correction, itself an estimate, says. */
#define POOL_SPREAD_LEAST 0.25

size_t combination_tile_count(const Combination *combination)
{
    return (size_t)combination->tiles[0] * (size_t)combination->tiles[1];
}

size_t combination_tile_of(const Combination *combination, size_t pixel)
{
    size_t width = (size_t)combination->size[0], x = pixel % width, y = pixel / width;
    return y / TILE_SIDE * (size_t)combination->tiles[0] + x / TILE_SIDE;
}

/* ---- pictures ----------------------------------------------------------------------------------------------------- */

static float luminance_of(const int64_t *sums, double scale)
{
    float rgb[3];
    for (int c = 0; c < 3; ++c)
        rgb[c] = (float)(scale * (double)film_sum_shown(sums[c]));
    return rgb_luminance(vec3(rgb[0], rgb[1], rgb[2]));
}

/* The picture that `sums` are from `samples` paths. picture, tiles: room for as many values. */
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

static void series_learn(Combination *combination, int s, const Film *film, const int64_t *sums, float *picture,
                         float *tiles)
{
    double samples = (double)film->light_samples;
    image_of(combination, film, sums, picture, tiles);
    pixel_series_add(&combination->pixels[s], picture, NULL, samples);
    pixel_series_add(&combination->sums[s], tiles, NULL, samples);
    for (size_t i = 0; s == ESTIMATOR_POOL && i < combination_tile_count(combination); ++i)
        combination->gaps[i] += fmax(combination->density_ratio[i] - samples / (double)film_pixels(film), 0.0);
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

/* ---- variances ---------------------------------------------------------------------------------------------------- */

/* Generations in which the estimator's variance was seen. */
static double seen(const Combination *combination, int s)
{
    return combination->pixels[s].pictures[0] > 0 ? combination->pixels[s].pictures[0] - 1.0 : 0.0;
}

/* Luminance of a tile that the series is sure of: its mean less so many standard errors, and some more where it knows
 * little; its mean for none. */
static double sure_of(const Combination *combination, int s, size_t tile, double deviations)
{
    if (!(seen(combination, s) >= 1.0))
        return 0.0;
    double mean = (double)combination->sums[s].mean[tile],
           error = sqrt(pixel_series_variance(&combination->sums[s], tile));
    if (deviations > 0.0)
        deviations += MISSING_UNCERTAIN * (error < mean ? error / mean : 1.0);
    return mean - deviations * error;
}

/* The same of the brightest way to see the tile. */
static double brightest_of(const Combination *combination, size_t tile, double deviations)
{
    double chains = sure_of(combination, ESTIMATOR_CHAINS, tile, deviations),
           pool = sure_of(combination, ESTIMATOR_POOL, tile, deviations);
    return fmax(sure_of(combination, ESTIMATOR_PATHS, tile, deviations) +
                    sure_of(combination, SERIES_RARE, tile, deviations),
                fmax(chains, pool) + sure_of(combination, SERIES_EXCESS, tile, deviations));
}

/* A pixel's luminance, no brighter than so many times its tile's mean, and at least that of a dark place. Of a pixel
 * that chains have rarely been to they know no more than of its tile; were it what they have shown there, the few
 * pixels where they have been would count as bright, and chains as sure. */
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

/* Corrects what a tile has seen of pools too small to visit all pixels: which of them they visit changes from pool to
 * pool, but evens out over all of them. A pixel of mean m that a part q of the pools visits seems to vary by m^2 (1 / q
 * - 1) more than it does; q is the pool's samples over the pixels and over the density_ratio. */
static void pool_correct(Combination *combination)
{
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        CombinationTile *tile = &combination->known[i];
        double gap = seen(combination, ESTIMATOR_POOL) > 0.0
                         ? combination->gaps[i] / (seen(combination, ESTIMATOR_POOL) + 1.0)
                         : 0.0;
        double light = (double)combination->sums[ESTIMATOR_POOL].mean[i], *pool = &tile->spread[ESTIMATOR_POOL];
        double less = gap * (double)combination->direct.pixels * light * light / (TILE_SIDE * TILE_SIDE);
        *pool = fmax(*pool - less, POOL_SPREAD_LEAST * *pool);
    }
}

/* Variances count relative to the square of the light of their pixel, in units of that of their tile. */
static void tiles_sum(Combination *combination)
{
    const double area = TILE_SIDE * TILE_SIDE;
    double mean = 0.0;
    memset(combination->known, 0, combination_tile_count(combination) * sizeof *combination->known);
    for (size_t i = 0; i < combination->direct.pixels; ++i)
        combination->known[combination_tile_of(combination, i)].light += fabs((double)combination->direct.mean[i]);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        combination->known[i].indirect = brightest_of(combination, i, 0.0);
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
    pool_correct(combination);
}

/* The median (the upper one of an even number) over the tiles of a estimator's variance over the tile's light. */
static double ratio_median(const Combination *combination, int s, double *ratios)
{
    size_t count = 0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        if (combination->known[i].indirect > 0.0)
            ratios[count++] = combination->known[i].spread[s] / combination->known[i].indirect;
    sample_sort(ratios, count);
    return count > 0 ? ratios[count / 2] : 0.0;
}

/* When another series is sure enough of more light in the tile than series s has seen there, s meets it about once or
 * less in all its samples: its variance is that of one such event. */
static double missing_spread(const Combination *combination, int s, size_t tile)
{
    double deviations = MISSING_DEVIATIONS * seen(combination, s) / (seen(combination, s) + MISSING_GENERATIONS);
    const PixelSeries *sums = combination->sums;
    double other, own = (double)sums[s].mean[tile];
    if (s == ESTIMATOR_CHAINS || s == ESTIMATOR_POOL) {
        other = sure_of(combination, s == ESTIMATOR_CHAINS ? ESTIMATOR_POOL : ESTIMATOR_CHAINS, tile, deviations);
    } else {
        other = brightest_of(combination, tile, deviations);
        if (s == SERIES_EXCESS)
            own += fmax((double)sums[ESTIMATOR_CHAINS].mean[tile], (double)sums[ESTIMATOR_POOL].mean[tile]);
        else
            own += (double)sums[SERIES_RARE].mean[tile];
    }
    double missing = fmax(other - own, 0.0);
    return missing * missing * (double)sums[s].weight[tile];
}

/* A estimator's variance over the light, in the tile and those beside it. */
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

/* What a tile knows of a estimator is no less than what it and those beside it know together: where one has met a rare
 * bright path, the others only have not yet. On a glossy room this divides the square error by 1.5, on a pool with
 * caustics by 1.3. */
static void spreads_share(Combination *combination, int s, double *ratios)
{
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        ratios[i] = ratio_around(combination, s, i);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        CombinationTile *tile = &combination->known[i];
        tile->spread[s] = fmax(tile->spread[s], ratios[i] * tile->indirect);
    }
}

void combination_variances_update(Combination *combination, double *ratios)
{
    tiles_sum(combination);
    for (int s = 0; s < SERIES_COUNT; ++s) {
        spreads_share(combination, s, ratios);
        double usual = ratio_median(combination, s, ratios), known = seen(combination, s);
        combination->ready[s] = known >= 1.0;
        for (size_t i = 0; i < combination_tile_count(combination); ++i) {
            CombinationTile *tile = &combination->known[i];
            tile->spread[s] =
                (known * tile->spread[s] + PRIOR_GENERATIONS * usual * tile->indirect) / (known + PRIOR_GENERATIONS) +
                (s == SERIES_RARE ? 0.0 : missing_spread(combination, s, i));
        }
    }
}
