/* Learns the estimators' variances from the generations before. */
#include "mmlt/combination_learn.h"

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

size_t combination_run_end(const Combination *combination, size_t pixel, size_t side)
{
    size_t width = (size_t)combination->size[0], x = pixel % width, end = (x / side + 1) * side;
    return pixel - x + (end < width ? end : width);
}

size_t combination_patch_count(const Combination *combination)
{
    return (size_t)combination->patches[0] * (size_t)combination->patches[1];
}

static size_t patch_of(const Combination *combination, size_t pixel)
{
    size_t width = (size_t)combination->size[0], x = pixel % width, y = pixel / width;
    return y / PATCH_SIDE * (size_t)combination->patches[0] + x / PATCH_SIDE;
}

size_t combination_tile_of_patch(const Combination *combination, size_t patch)
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

void combination_rows_run(const Combination *combination, ParallelPart *part, void *context)
{
    size_t pixels = (size_t)combination->size[0] * (size_t)combination->size[1];
    parallel_run((size_t)combination->tiles[1], pixels < PARALLEL_PIXELS ? 1 : combination->threads, part, context);
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

static void image_learn(FilmLearning *learning, PixelSeries *patches, PixelSeries *tiles, double samples,
                        const int64_t *sums, const int64_t *less)
{
    if (!(samples > 0.0))
        return;
    int image = learning->count++;
    learning->images[image].samples = samples;
    learning->images[image].sums = sums;
    learning->images[image].less = less;
    learning->images[image].patches = patches;
    learning->images[image].tiles = tiles;
    pixel_series_begin(patches, samples);
    if (tiles)
        pixel_series_begin(tiles, samples);
}

static void series_learn(FilmLearning *learning, int s, double samples, const int64_t *sums, const int64_t *less)
{
    Combination *combination = learning->combination;
    image_learn(learning, &combination->light[s], &combination->sums[s], samples, sums, less);
}

void combination_learning_begin(FilmLearning *learning, Combination *combination, EstimatorKind kind, const Film *film,
                                double samples, double direct)
{
    *learning = (FilmLearning){.combination = combination, .film = film};
    series_learn(learning, (int)kind, samples, film->light_sums, kind == ESTIMATOR_PATHS ? film->rare_sums : NULL);
    if (kind == ESTIMATOR_CHAINS) {
        series_learn(learning, SERIES_EXCESS, samples, film->sums, NULL);
        series_learn(learning, SERIES_RARE, samples, film->rare_sums, NULL);
    } else if (kind == ESTIMATOR_PATHS) {
        series_learn(learning, SERIES_PATHS_RARE, samples, film->rare_sums, NULL);
        image_learn(learning, &combination->direct, NULL, direct, film->sums, NULL);
    }
}

/* The luminances of an image in a row of tiles, summed over patches and tiles. */
static void row_sum(const FilmLearning *learning, int image, size_t row)
{
    const int64_t *sums = learning->images[image].sums, *less = learning->images[image].less;
    const Combination *combination = learning->combination;
    const Film *film = learning->film;
    RowRange pixels = combination_row_pixels(combination, row), patches = combination_row_patches(combination, row),
             tiles = combination_row_tiles(combination, row);
    double unit = ldexp((double)film_pixels(film) / learning->images[image].samples, film->quantum_exponent);
    memset(combination->patch_sums + patches.first, 0, (patches.end - patches.first) * sizeof(float));
    memset(combination->tile_sums + tiles.first, 0, (tiles.end - tiles.first) * sizeof(float));
    for (size_t i = pixels.first, end; i < pixels.end; i = end) {
        float *sum = &combination->patch_sums[patch_of(combination, i)];
        end = combination_run_end(combination, i, PATCH_SIDE);
        for (size_t pixel = i; pixel < end; ++pixel)
            *sum += luminance_of(sums + 3 * pixel, less ? less + 3 * pixel : NULL, unit);
    }
    for (size_t i = patches.first; i < patches.end; ++i)
        combination->tile_sums[combination_tile_of_patch(combination, i)] += combination->patch_sums[i];
}

void combination_row_learn(const FilmLearning *learning, size_t row)
{
    const Combination *combination = learning->combination;
    RowRange patches = combination_row_patches(combination, row), tiles = combination_row_tiles(combination, row);
    for (int i = 0; i < learning->count; ++i) {
        row_sum(learning, i, row);
        pixel_series_add_part(learning->images[i].patches, combination->patch_sums, patches.first, patches.end);
        if (learning->images[i].tiles)
            pixel_series_add_part(learning->images[i].tiles, combination->tile_sums, tiles.first, tiles.end);
    }
}
