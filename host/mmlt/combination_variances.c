/* The variances of the estimators, from what a combination has learnt. */
#include "mmlt/combination_variances.h"

#include "base/sample_statistics.h"
#include "base/student.h"
#include "mmlt/combination_rare.h"
#include "mmlt/combination_stratified.h"
#include "mmlt/tuning.h"

#include <math.h>
#include <string.h>

/* Degrees of freedom of the series' variances: the number of its pictures less one. */
static double freedom_of(const Combination *combination, int s)
{
    return fmax((double)pixel_series_pictures(&combination->light[s], 0) - 1.0, 0.0);
}

/* How many standard errors are needed to tell light from noise that few pictures state. */
static void deviations_set(Combination *combination)
{
    for (int s = 0; s < SERIES_COUNT; ++s) {
        double freedom = freedom_of(combination, s);
        combination->deviations[s] = freedom >= 1.0 ? student_threshold(MISSING_PROBABILITY, freedom) : 0.0;
    }
}

/* A tile's light, or the lower confidence bound of it. 0 until the series' variance is known. */
static double tile_light(const Combination *combination, int s, size_t tile, bool bound)
{
    if (!(freedom_of(combination, s) >= 1.0))
        return 0.0;
    double error = bound ? sqrt(pixel_series_variance(&combination->sums[s], tile)) : 0.0;
    return (double)combination->sums[s].mean[tile] - combination->deviations[s] * error;
}

/* The largest over the estimates of the tile's whole light: path tracing plus rare, chains, or pool plus excess. */
static double tile_light_best(const Combination *combination, size_t tile, bool bound)
{
    double chains = tile_light(combination, ESTIMATOR_CHAINS, tile, bound),
           pool = tile_light(combination, ESTIMATOR_POOL, tile, bound);
    return fmax(tile_light(combination, ESTIMATOR_PATHS, tile, bound) +
                    tile_light(combination, SERIES_RARE, tile, bound),
                fmax(chains, pool) + tile_light(combination, SERIES_EXCESS, tile, bound));
}

/* The part of a tile's pixels that a patch has. */
#define PATCH_PART (1.0 / TILE_PATCHES)

/* Squared luminance of a patch, clamped to LIGHT_OVER_TILE times its tile's mean, plus `dark`. While chains have made
 * few steps per pixel, their mean of a patch is pulled toward that of its tile: otherwise the few patches they have
 * visited would count as bright, and the chains' relative variance as small. */
static double light_square(const Combination *combination, size_t patch, const CombinationTile *tile, double dark)
{
    double steps = pixel_series_weight(&combination->light[ESTIMATOR_CHAINS], patch) /
                   ((double)combination->size[0] * (double)combination->size[1]);
    double chains = (double)combination->light[ESTIMATOR_CHAINS].mean[patch] +
                    (double)combination->light[SERIES_EXCESS].mean[patch];
    double light = (double)combination->direct.mean[patch] +
                   (steps * chains + LIGHT_STEPS * tile->indirect * PATCH_PART) / (steps + LIGHT_STEPS);
    light = fmin(fabs(light), LIGHT_OVER_TILE * tile->light * PATCH_PART);
    return light * light + dark;
}

static void row_light(void *context, size_t row)
{
    Combination *combination = context;
    RowRange patches = combination_row_patches(combination, row), tiles = combination_row_tiles(combination, row);
    memset(&combination->known[tiles.first], 0, (tiles.end - tiles.first) * sizeof *combination->known);
    for (size_t i = patches.first; i < patches.end; ++i)
        combination->known[combination_tile_of_patch(combination, i)].light +=
            fabs((double)combination->direct.mean[i]);
    for (size_t i = tiles.first; i < tiles.end; ++i) {
        combination->known[i].indirect = tile_light_best(combination, i, false);
        combination->known[i].light += combination->known[i].indirect;
    }
}

/* A combination, the mean luminance of a tile, and DARK_PART of the squared mean luminance of a patch. */
typedef struct TilesSum {
    Combination *combination;
    double light, dark;
} TilesSum;

double tile_relative_square(const CombinationTile *tile, double mean_light)
{
    return fmax(tile->light * tile->light + DARK_PART * mean_light * mean_light, SPREAD_MIN);
}

/* The chains' variances of a row's patches and of its tiles, both relative to the tiles' light. */
static void row_correlation(const TilesSum *sum, size_t row)
{
    const Combination *combination = sum->combination;
    CombinationRow *sums = &combination->rows[row];
    RowRange patches = combination_row_patches(combination, row), tiles = combination_row_tiles(combination, row);
    sums->patches = sums->tiles = 0.0;
    for (size_t i = patches.first; i < patches.end; ++i) {
        const CombinationTile *tile = &combination->known[combination_tile_of_patch(combination, i)];
        sums->patches +=
            pixel_series_spread(&combination->light[ESTIMATOR_CHAINS], i) / tile_relative_square(tile, sum->light);
    }
    for (size_t i = tiles.first; i < tiles.end; ++i) {
        const CombinationTile *tile = &combination->known[i];
        sums->tiles +=
            pixel_series_spread(&combination->sums[ESTIMATOR_CHAINS], i) / tile_relative_square(tile, sum->light);
    }
}

/* The ratio of both in the whole image. */
static double chains_correlation(const Combination *combination)
{
    double patches = 0.0, tiles = 0.0;
    for (int row = 0; row < combination->tiles[1]; ++row) {
        patches += combination->rows[row].patches;
        tiles += combination->rows[row].tiles;
    }
    return patches > 0.0 && tiles > patches ? fmin(tiles / patches, TILE_PATCHES) : 1.0;
}

static void row_spreads(void *context, size_t row)
{
    const TilesSum *sum = context;
    Combination *combination = sum->combination;
    RowRange patches = combination_row_patches(combination, row);
    for (size_t i = patches.first; i < patches.end; ++i) {
        CombinationTile *tile = &combination->known[combination_tile_of_patch(combination, i)];
        double tile_mean = tile->light * PATCH_PART;
        double weight = (tile_mean * tile_mean + sum->dark) / light_square(combination, i, tile, sum->dark);
        for (int s = 0; s < SERIES_COUNT; ++s)
            tile->spread[s] += weight * pixel_series_spread(&combination->light[s], i);
        tile->direct += weight * pixel_series_spread(&combination->direct, i);
    }
    row_correlation(sum, row);
}

/* Sums the tiles' variances, each patch's weighted by the squared luminance of its tile over its own. */
static void tiles_sum(Combination *combination)
{
    combination_rows_run(combination, row_light, combination);
    double light = combination_mean_light(combination), patch = light * PATCH_PART;
    TilesSum sum = {combination, light, DARK_PART * patch * patch};
    combination_rows_run(combination, row_spreads, &sum);
    combination->chains_correlation = chains_correlation(combination);
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
    const PixelSeries *sums = combination->sums;
    double other, own = (double)sums[s].mean[tile];
    if (s == ESTIMATOR_CHAINS || s == ESTIMATOR_POOL) {
        other = tile_light(combination, s == ESTIMATOR_CHAINS ? ESTIMATOR_POOL : ESTIMATOR_CHAINS, tile, true);
    } else if (s == SERIES_PATHS_RARE) {
        other = tile_light(combination, SERIES_RARE, tile, true);
    } else {
        other = tile_light_best(combination, tile, true);
        if (s == SERIES_EXCESS)
            own += fmax((double)sums[ESTIMATOR_CHAINS].mean[tile], (double)sums[ESTIMATOR_POOL].mean[tile]);
        else if (s == ESTIMATOR_PATHS)
            own += (double)sums[SERIES_RARE].mean[tile];
    }
    double missing = fmax(other - own, 0.0);
    return missing * missing * pixel_series_weight(&sums[s], tile);
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

/* Samples of path tracing are stratified across generations (mmlt/paths_estimator.h): part of their variance is
 * left. */
static void stratification_apply(Combination *combination, const Combination *other)
{
    StratifiedParts left = combination_stratified(combination, other);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        combination->known[i].spread[ESTIMATOR_PATHS] *= left.indirect;
        combination->known[i].direct *= left.direct;
    }
}

/* A series' variance relative to light, of all tiles together. */
static double relative_variance(const Combination *combination, int s)
{
    double sum = 0.0, light = combination_mean_light(combination);
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        sum += combination->known[i].spread[s] / tile_relative_square(&combination->known[i], light);
    return sum;
}

/* Chains visit a place with density light^(1 - EXPONENT) and leave light^EXPONENT at each visit: their variance is in
 * proportion to light^(1 + EXPONENT). */
static double chains_shape(const CombinationTile *tile)
{
    return tile->indirect * pow(fmax(tile->light, 0.0), EXPONENT);
}

/* The variance of all tiles together over that. */
static double chains_ratio(const Combination *combination, int s)
{
    double spread = 0.0, shape = 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        spread += combination->known[i].spread[s];
        shape += chains_shape(&combination->known[i]);
    }
    return shape > 0.0 ? spread / shape : 0.0;
}

/* So many samples of a tile tell as much of the series' variance there as all tiles together do; 0: any. Chains' own
 * light counts like their excess and rare light, which are few bright paths. */
static double samples_known(int s)
{
    if (s == ESTIMATOR_POOL)
        return POOL_KNOWN;
    return s == ESTIMATOR_CHAINS || s == SERIES_EXCESS || s == SERIES_RARE ? VISITS_KNOWN * VISIT_STEPS : 0.0;
}

/* Weight of that mean in a tile's variance, in generations, if the series has `known` degrees of freedom. Where few
 * samples come to a tile, most tiles have not met the bright paths and state too small a variance, and the median of
 * all is as small. */
static double mean_weight(const Combination *combination, int s, double known)
{
    double samples = pixel_series_weight(&combination->sums[s], 0) / (double)combination_tile_count(combination);
    return samples > 0.0 ? known * samples_known(s) / samples : 0.0;
}

/* Moves the variances of all tiles toward what is usual, and adds that of missing light. */
static void spreads_settle(Combination *combination, int s)
{
    double *ratios = combination->ratios, mean = chains_ratio(combination, s), known = freedom_of(combination, s),
           few = mean_weight(combination, s, known);
    spreads_share(combination, s, ratios);
    double usual = ratio_median(combination, s, ratios);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        CombinationTile *tile = &combination->known[i];
        double prior = PRIOR_GENERATIONS * usual * tile->indirect + few * mean * chains_shape(tile);
        tile->spread[s] = (known * tile->spread[s] + prior) / (known + PRIOR_GENERATIONS + few) +
                          (s == SERIES_RARE ? 0.0 : missing_spread(combination, s, i));
    }
    combination->ready[s] = known >= 1.0;
}

/* How many times the variance that the images of a replica's chains state is found between both replicas. */
static double chains_persistence(const Combination *combination, const Combination *other, int s)
{
    const PixelSeries *own = &combination->sums[s], *others = &other->sums[s];
    if (pixel_series_pictures(own, 0) < 2 || pixel_series_pictures(others, 0) < 2)
        return 1.0;
    const double light = combination_mean_light(combination);
    const PixelWindow all = {(size_t)combination->tiles[0], 0, 0, (size_t)combination->tiles[0],
                             (size_t)combination->tiles[1]};
    PixelVariances sums = pixel_series_compare(own, others, all, DARK_PART * light * light);
    return sums.stated > 0.0 ? fmin(fmax(sums.found / sums.stated, 1.0), PERSISTENCE_MOST) : 1.0;
}

static void persistence_apply(Combination *combination, const Combination *other)
{
    static const int series[] = {ESTIMATOR_CHAINS, SERIES_EXCESS, SERIES_RARE};
    for (size_t k = 0; k < sizeof series / sizeof series[0]; ++k) {
        const double factor = chains_persistence(combination, other, series[k]);
        for (size_t i = 0; i < combination_tile_count(combination); ++i)
            combination->known[i].spread[series[k]] *= factor;
    }
}

void combination_variances_update(Combination *combination, const Combination *other)
{
    deviations_set(combination);
    tiles_sum(combination);
    persistence_apply(combination, other);
    stratification_apply(combination, other);
    for (int s = 0; s < SERIES_COUNT; ++s)
        if (s != ESTIMATOR_BIDIRECTIONAL || pixel_series_pictures(&combination->light[s], 0) > 0)
            spreads_settle(combination, s);
    combination->rare_chains = relative_variance(combination, SERIES_RARE);
    combination->rare_paths = relative_variance(combination, SERIES_PATHS_RARE);
    combination_rare_update(combination);
}
