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
    size_t width = (size_t)combination->size[0], height = (size_t)combination->size[1], end = (row + 1) * TILE_SIDE;
    return (PixelWindow){width, 0, row * TILE_SIDE, width, end < height ? end : height};
}

RowRange combination_row_pixels(const Combination *combination, size_t row)
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

/* An image of a generation, and the series that it is added to. */
typedef struct LearnedImage {
    const Film *film;
    const int64_t *sums, *less; /* less: what is not part of the image; NULL: all is */
    PixelSeries *pixels, *tiles; /* luminances of pixels, and summed over tiles */
    bool has_tiles;
} LearnedImage;

typedef struct FilmsLearning {
    Combination *combination;
    LearnedImage images[SERIES_COUNT + 1];
    int count;
    float *picture, *tiles; /* scratch: luminances of pixels, and their sums */
    const atomic_int *stop;
} FilmsLearning;

/* The luminances of an image in a row of tiles. */
static void row_image(const FilmsLearning *learning, const LearnedImage *image, RowRange pixels, RowRange tiles)
{
    const Film *film = image->film;
    double unit = ldexp((double)film_pixels(film) / (double)film->light_samples, film->quantum_exponent);
    memset(learning->tiles + tiles.first, 0, (tiles.end - tiles.first) * sizeof *learning->tiles);
    for (size_t i = pixels.first; i < pixels.end; ++i) {
        learning->picture[i] = luminance_of(image->sums + 3 * i, image->less ? image->less + 3 * i : NULL, unit);
        learning->tiles[combination_tile_of(learning->combination, i)] += learning->picture[i];
    }
}

static void row_learn(void *context, size_t row)
{
    const FilmsLearning *learning = context;
    RowRange pixels = combination_row_pixels(learning->combination, row),
             tiles = combination_row_tiles(learning->combination, row);
    for (int i = 0; i < learning->count && !*learning->stop; ++i) {
        const LearnedImage *image = &learning->images[i];
        row_image(learning, image, pixels, tiles);
        pixel_series_add_part(image->pixels, learning->picture, pixels.first, pixels.end);
        if (image->has_tiles)
            pixel_series_add_part(image->tiles, learning->tiles, tiles.first, tiles.end);
    }
}

static void image_learn(FilmsLearning *learning, int s, const Film *film, const int64_t *sums, const int64_t *less)
{
    Combination *combination = learning->combination;
    learning->images[learning->count++] =
        (LearnedImage){film, sums, less, &combination->pixels[s], &combination->sums[s], true};
}

void combination_films_learn(Combination *combination, Film *const films[], float *picture, float *tiles,
                             const atomic_int *stop)
{
    const Film *chains = films[ESTIMATOR_CHAINS], *paths = films[ESTIMATOR_PATHS];
    FilmsLearning learning = {.combination = combination, .picture = picture, .tiles = tiles, .stop = stop};
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        if (films[s]->light_samples > 0)
            image_learn(&learning, s, films[s], films[s]->light_sums, s == ESTIMATOR_PATHS ? paths->rare_sums : NULL);
    image_learn(&learning, SERIES_EXCESS, chains, chains->sums, NULL);
    image_learn(&learning, SERIES_RARE, chains, chains->rare_sums, NULL);
    if (paths->light_samples > 0) {
        image_learn(&learning, SERIES_PATHS_RARE, paths, paths->rare_sums, NULL);
        learning.images[learning.count++] = (LearnedImage){paths, paths->sums, NULL, &combination->direct, NULL, false};
    }
    if (*stop)
        return;
    for (int i = 0; i < learning.count; ++i) {
        const LearnedImage *image = &learning.images[i];
        pixel_series_begin(image->pixels, (double)image->film->light_samples);
        if (image->has_tiles)
            pixel_series_begin(image->tiles, (double)image->film->light_samples);
    }
    combination_rows_run(combination, row_learn, &learning);
}

/* ---- variances --------------------------------------------------------------------------------------------------- */

/* Degrees of freedom of the series' variances: the number of its pictures less one. */
static double freedom_of(const Combination *combination, int s)
{
    return fmax((double)pixel_series_pictures(&combination->pixels[s], 0) - 1.0, 0.0);
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
    double steps =
        pixel_series_weight(&combination->pixels[ESTIMATOR_CHAINS], pixel) / (double)combination->direct.pixels;
    double chains = (double)combination->pixels[ESTIMATOR_CHAINS].mean[pixel] +
                    (double)combination->pixels[SERIES_EXCESS].mean[pixel];
    double light = (double)combination->direct.mean[pixel] +
                   (steps * chains + LIGHT_STEPS * tile->indirect / area) / (steps + LIGHT_STEPS);
    light = fmin(fabs(light), LIGHT_OVER_TILE * tile->light / area);
    return light * light + dark;
}

static void row_light(void *context, size_t row)
{
    Combination *combination = context;
    RowRange pixels = combination_row_pixels(combination, row), tiles = combination_row_tiles(combination, row);
    memset(&combination->known[tiles.first], 0, (tiles.end - tiles.first) * sizeof *combination->known);
    for (size_t i = pixels.first; i < pixels.end; ++i)
        combination->known[combination_tile_of(combination, i)].light += fabs((double)combination->direct.mean[i]);
    for (size_t i = tiles.first; i < tiles.end; ++i) {
        combination->known[i].indirect = light_bound_best(combination, i, 0.0);
        combination->known[i].light += combination->known[i].indirect;
    }
}

/* A combination, and DARK_PART of the squared mean luminance of a pixel and of a tile. */
typedef struct TilesSum {
    Combination *combination;
    double dark, dark_tile;
} TilesSum;

static void row_spreads(const TilesSum *sum, RowRange pixels)
{
    const double area = TILE_SIDE * TILE_SIDE;
    Combination *combination = sum->combination;
    for (size_t i = pixels.first; i < pixels.end; ++i) {
        CombinationTile *tile = &combination->known[combination_tile_of(combination, i)];
        double tile_mean = tile->light / area;
        double weight = (tile_mean * tile_mean + sum->dark) / light_square(combination, i, tile, sum->dark);
        for (int s = 0; s < SERIES_COUNT; ++s)
            tile->spread[s] += weight * pixel_series_spread(&combination->pixels[s], i);
        tile->direct += weight * pixel_series_spread(&combination->direct, i);
    }
}

/* Relative variances of a row's tiles and of its pixels, for correlation_of. */
static void row_correlate(const TilesSum *sum, RowRange pixels, RowRange tiles, CombinationRow *row)
{
    const Combination *combination = sum->combination;
    for (size_t i = tiles.first; i < tiles.end; ++i) {
        double light = combination->known[i].light, square = fmax(light * light + sum->dark_tile, SPREAD_MIN);
        for (int s = 0; s < SERIES_COUNT; ++s)
            row->sums[s] += pixel_series_spread(&combination->sums[s], i) / square;
    }
    for (size_t i = pixels.first; i < pixels.end; ++i) {
        double light = combination->known[combination_tile_of(combination, i)].light,
               square = fmax(light * light + sum->dark_tile, SPREAD_MIN);
        for (int s = 0; s < SERIES_COUNT; ++s)
            row->pixels[s] += pixel_series_spread(&combination->pixels[s], i) / square;
    }
}

static void row_variances(void *context, size_t row)
{
    const TilesSum *sum = context;
    RowRange pixels = combination_row_pixels(sum->combination, row),
             tiles = combination_row_tiles(sum->combination, row);
    sum->combination->rows[row] = (CombinationRow){.full = 0};
    row_spreads(sum, pixels);
    row_correlate(sum, pixels, tiles, &sum->combination->rows[row]);
}

/* Sums the tiles' variances, each pixel's weighted by the squared luminance of its tile over its own. */
static void tiles_sum(Combination *combination)
{
    combination_rows_run(combination, row_light, combination);
    double tile = combination_mean_light(combination), pixel = tile / (TILE_SIDE * TILE_SIDE);
    TilesSum sum = {combination, DARK_PART * pixel * pixel, DARK_PART * tile * tile};
    combination_rows_run(combination, row_variances, &sum);
}

/* By how much the variance of a tile's sum exceeds the sum of its pixels' variances, relative to light and over all
 * tiles: 1 if pixels are independent, more for chains, whose steps visit several of them. */
static double correlation_of(const Combination *combination, int s)
{
    double sums = 0.0, pixels = 0.0;
    for (int row = 0; row < combination->tiles[1]; ++row) {
        sums += combination->rows[row].sums[s];
        pixels += combination->rows[row].pixels[s];
    }
    return pixels > 0.0 ? fmin(fmax(sums / pixels, 1.0), TILE_SIDE * TILE_SIDE) : 1.0;
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
    double indirect, direct; /* mean luminances of a pixel */
} Replicas;

static void row_path_light(void *context, size_t row)
{
    const Replicas *replicas = context;
    const Combination *a = replicas->combination, *b = replicas->other;
    PixelWindow window = combination_row_window(a, row);
    a->rows[row].indirect_sum = pixel_series_sum(&a->pixels[ESTIMATOR_PATHS], &b->pixels[ESTIMATOR_PATHS], window);
    a->rows[row].direct_sum = pixel_series_sum(&a->direct, &b->direct, window);
}

static void row_path_variances(void *context, size_t row)
{
    const Replicas *replicas = context;
    const Combination *a = replicas->combination, *b = replicas->other;
    PixelWindow window = combination_row_window(a, row);
    a->rows[row].indirect = pixel_series_compare(&a->pixels[ESTIMATOR_PATHS], &b->pixels[ESTIMATOR_PATHS], window,
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
    combination->rare_chains = relative_variance(combination, SERIES_RARE);
    combination->rare_paths = relative_variance(combination, SERIES_PATHS_RARE);
}
