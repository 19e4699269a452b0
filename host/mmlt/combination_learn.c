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

size_t combination_patch_count(const Combination *combination)
{
    return (size_t)combination->patches[0] * (size_t)combination->patches[1];
}

/* The patch of a pixel, and the tile of a patch. */
static size_t patch_of(const Combination *combination, size_t pixel)
{
    size_t width = (size_t)combination->size[0], x = pixel % width, y = pixel / width;
    return y / PATCH_SIDE * (size_t)combination->patches[0] + x / PATCH_SIDE;
}

static size_t tile_of_patch(const Combination *combination, size_t patch)
{
    const size_t side = TILE_SIDE / PATCH_SIDE;
    size_t width = (size_t)combination->patches[0], x = patch % width, y = patch / width;
    return y / side * (size_t)combination->tiles[0] + x / side;
}

double combination_mean_light(const Combination *combination)
{
    double light = 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        light += combination->known[i].light / (double)combination_tile_count(combination);
    return light;
}

/* ---- rows of tiles ----------------------------------------------------------------------------------------------- */

/* Pixels of an image whose sums take longer than it takes to start threads. */
#define THREADED_PIXELS 65536u

void combination_rows_run(const Combination *combination, ParallelPart *part, void *context)
{
    size_t pixels = (size_t)combination->size[0] * (size_t)combination->size[1];
    parallel_run((size_t)combination->tiles[1], pixels < THREADED_PIXELS ? 1 : combination->threads, part, context);
}

PixelWindow combination_row_window(const Combination *combination, size_t row)
{
    const size_t side = TILE_SIDE / PATCH_SIDE;
    size_t width = (size_t)combination->patches[0], height = (size_t)combination->patches[1], end = (row + 1) * side;
    return (PixelWindow){width, 0, row * side, width, end < height ? end : height};
}

RowRange combination_row_pixels(const Combination *combination, size_t row)
{
    size_t width = (size_t)combination->size[0], height = (size_t)combination->size[1], end = (row + 1) * TILE_SIDE;
    return (RowRange){row * TILE_SIDE * width, (end < height ? end : height) * width};
}

RowRange combination_row_patches(const Combination *combination, size_t row)
{
    PixelWindow window = combination_row_window(combination, row);
    return (RowRange){window.y0 * window.width, window.y1 * window.width};
}

RowRange combination_row_tiles(const Combination *combination, size_t row)
{
    size_t columns = (size_t)combination->tiles[0];
    return (RowRange){row * columns, (row + 1) * columns};
}

/* ---- pictures ---------------------------------------------------------------------------------------------------- */

static float luminance_of(const int64_t *sums, const int64_t *less, double scale)
{
    float rgb[3];
    for (int c = 0; c < 3; ++c)
        rgb[c] = (float)(scale * (double)(film_sum_shown(sums[c]) - (less ? film_sum_shown(less[c]) : 0)));
    return rgb_luminance(vec3(rgb[0], rgb[1], rgb[2]));
}

static void image_learn(FilmLearning *learning, PixelSeries *patches, PixelSeries *tiles, const int64_t *sums,
                        const int64_t *less)
{
    int image = learning->count++;
    learning->images[image].sums = sums;
    learning->images[image].less = less;
    learning->images[image].patches = patches;
    learning->images[image].tiles = tiles;
    pixel_series_begin(patches, (double)learning->samples);
    if (tiles)
        pixel_series_begin(tiles, (double)learning->samples);
}

static void series_learn(FilmLearning *learning, int s, const int64_t *sums, const int64_t *less)
{
    Combination *combination = learning->combination;
    image_learn(learning, &combination->light[s], &combination->sums[s], sums, less);
}

void combination_learning_begin(FilmLearning *learning, Combination *combination, EstimatorKind kind, const Film *film,
                                uint64_t samples)
{
    *learning = (FilmLearning){.combination = combination, .film = film, .samples = samples};
    series_learn(learning, (int)kind, film->light_sums, kind == ESTIMATOR_PATHS ? film->rare_sums : NULL);
    if (kind == ESTIMATOR_CHAINS) {
        series_learn(learning, SERIES_EXCESS, film->sums, NULL);
        series_learn(learning, SERIES_RARE, film->rare_sums, NULL);
    } else if (kind == ESTIMATOR_PATHS) {
        series_learn(learning, SERIES_PATHS_RARE, film->rare_sums, NULL);
        image_learn(learning, &combination->direct, NULL, film->sums, NULL);
    }
}

/* The luminances of an image in a row of tiles, summed over patches and tiles. */
static void row_sum(const FilmLearning *learning, const int64_t *sums, const int64_t *less, size_t row)
{
    const Combination *combination = learning->combination;
    const Film *film = learning->film;
    RowRange pixels = combination_row_pixels(combination, row), patches = combination_row_patches(combination, row),
             tiles = combination_row_tiles(combination, row);
    double unit = ldexp((double)film_pixels(film) / (double)learning->samples, film->quantum_exponent);
    memset(combination->patch_sums + patches.first, 0, (patches.end - patches.first) * sizeof(float));
    memset(combination->tile_sums + tiles.first, 0, (tiles.end - tiles.first) * sizeof(float));
    for (size_t i = pixels.first; i < pixels.end; ++i)
        combination->patch_sums[patch_of(combination, i)] +=
            luminance_of(sums + 3 * i, less ? less + 3 * i : NULL, unit);
    for (size_t i = patches.first; i < patches.end; ++i)
        combination->tile_sums[tile_of_patch(combination, i)] += combination->patch_sums[i];
}

void combination_row_learn(const FilmLearning *learning, size_t row)
{
    const Combination *combination = learning->combination;
    RowRange patches = combination_row_patches(combination, row), tiles = combination_row_tiles(combination, row);
    for (int i = 0; i < learning->count; ++i) {
        row_sum(learning, learning->images[i].sums, learning->images[i].less, row);
        pixel_series_add_part(learning->images[i].patches, combination->patch_sums, patches.first, patches.end);
        if (learning->images[i].tiles)
            pixel_series_add_part(learning->images[i].tiles, combination->tile_sums, tiles.first, tiles.end);
    }
}

/* ---- variances --------------------------------------------------------------------------------------------------- */

/* Degrees of freedom of the series' variances: the number of its pictures less one. */
static double freedom_of(const Combination *combination, int s)
{
    return fmax((double)pixel_series_pictures(&combination->light[s], 0) - 1.0, 0.0);
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

/* The part of a tile's pixels that a patch has. */
#define PATCH_PART ((double)(PATCH_SIDE * PATCH_SIDE) / (TILE_SIDE * TILE_SIDE))

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
        combination->known[tile_of_patch(combination, i)].light += fabs((double)combination->direct.mean[i]);
    for (size_t i = tiles.first; i < tiles.end; ++i) {
        combination->known[i].indirect = light_bound_best(combination, i, 0.0);
        combination->known[i].light += combination->known[i].indirect;
    }
}

/* A combination, and DARK_PART of the squared mean luminance of a patch. */
typedef struct TilesSum {
    Combination *combination;
    double dark;
} TilesSum;

static void row_spreads(void *context, size_t row)
{
    const TilesSum *sum = context;
    Combination *combination = sum->combination;
    RowRange patches = combination_row_patches(combination, row);
    for (size_t i = patches.first; i < patches.end; ++i) {
        CombinationTile *tile = &combination->known[tile_of_patch(combination, i)];
        double tile_mean = tile->light * PATCH_PART;
        double weight = (tile_mean * tile_mean + sum->dark) / light_square(combination, i, tile, sum->dark);
        for (int s = 0; s < SERIES_COUNT; ++s)
            tile->spread[s] += weight * pixel_series_spread(&combination->light[s], i);
        tile->direct += weight * pixel_series_spread(&combination->direct, i);
    }
}

/* Sums the tiles' variances, each patch's weighted by the squared luminance of its tile over its own. */
static void tiles_sum(Combination *combination)
{
    combination_rows_run(combination, row_light, combination);
    double patch = combination_mean_light(combination) * PATCH_PART;
    TilesSum sum = {combination, DARK_PART * patch * patch};
    combination_rows_run(combination, row_spreads, &sum);
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
    } else if (s == SERIES_PATHS_RARE) {
        other = light_bound(combination, SERIES_RARE, tile, deviations);
    } else {
        other = light_bound_best(combination, tile, deviations);
        if (s == SERIES_EXCESS)
            own += fmax((double)sums[ESTIMATOR_CHAINS].mean[tile], (double)sums[ESTIMATOR_POOL].mean[tile]);
        else
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

/* Two replicas, whose path tracing is compared. */
typedef struct Replicas {
    Combination *combination;
    const Combination *other;
    double indirect, direct; /* mean luminances of a patch */
} Replicas;

static void row_path_light(void *context, size_t row)
{
    const Replicas *replicas = context;
    const Combination *a = replicas->combination, *b = replicas->other;
    PixelWindow window = combination_row_window(a, row);
    a->rows[row].indirect_sum = pixel_series_sum(&a->light[ESTIMATOR_PATHS], &b->light[ESTIMATOR_PATHS], window);
    a->rows[row].direct_sum = pixel_series_sum(&a->direct, &b->direct, window);
}

static void row_path_variances(void *context, size_t row)
{
    const Replicas *replicas = context;
    const Combination *a = replicas->combination, *b = replicas->other;
    PixelWindow window = combination_row_window(a, row);
    a->rows[row].indirect = pixel_series_compare(&a->light[ESTIMATOR_PATHS], &b->light[ESTIMATOR_PATHS], window,
                                                 DARK_PART * replicas->indirect * replicas->indirect);
    a->rows[row].direct =
        pixel_series_compare(&a->direct, &b->direct, window, DARK_PART * replicas->direct * replicas->direct);
}

/* Samples of path tracing are stratified across the generations of a replica (paths_estimator.h). What is left of their
 * stated variance shows in the difference to the other replica, if there is one: pixel_series_stratified of the image. */
static void stratification_apply(Combination *combination, const Combination *other)
{
    Replicas replicas = {combination, other, 0.0, 0.0};
    PixelVariances indirect = {0.0, 0.0}, direct = {0.0, 0.0};
    if (other == combination)
        return;
    combination_rows_run(combination, row_path_light, &replicas);
    for (int row = 0; row < combination->tiles[1]; ++row) {
        replicas.indirect += combination->rows[row].indirect_sum / (double)combination->direct.pixels;
        replicas.direct += combination->rows[row].direct_sum / (double)combination->direct.pixels;
    }
    combination_rows_run(combination, row_path_variances, &replicas);
    for (int row = 0; row < combination->tiles[1]; ++row) {
        indirect.found += combination->rows[row].indirect.found;
        indirect.stated += combination->rows[row].indirect.stated;
        direct.found += combination->rows[row].direct.found;
        direct.stated += combination->rows[row].direct.stated;
    }
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        combination->known[i].spread[ESTIMATOR_PATHS] *= pixel_variances_left(indirect);
        combination->known[i].direct *= pixel_variances_left(direct);
    }
}

/* A series' variance relative to light, of all tiles together. */
static double relative_variance(const Combination *combination, int s)
{
    double sum = 0.0, light = combination_mean_light(combination);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        const CombinationTile *tile = &combination->known[i];
        sum += tile->spread[s] / fmax(tile->light * tile->light + DARK_PART * light * light, SPREAD_MIN);
    }
    return sum;
}

void combination_variances_update(Combination *combination, const Combination *other)
{
    double *ratios = combination->ratios;
    tiles_sum(combination);
    stratification_apply(combination, other);
    for (int s = 0; s < SERIES_COUNT; ++s) {
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
    combination->rare_chains = relative_variance(combination, SERIES_RARE);
    combination->rare_paths = relative_variance(combination, SERIES_PATHS_RARE);
}
