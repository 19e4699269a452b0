#include "render/halves_error.h"

#include "base/largest_values.h"
#include "base/sample_statistics.h"
#include "compare/metrics.h"
#include "render/tile_light.h"

#include <math.h>
#include <stdlib.h>

#define TILE METRICS_TILE

/* What is resolved of a row of tiles. */
typedef enum Plane { HALF_0, HALF_1, PICTURE, DIFFERENCE, PLANES } Plane;

typedef struct Estimate {
    const Film *halves; /* NULL: they are images */
    const float *images[2];
    const ErrorGoal *goal;
    FilmScale scales[2];
    size_t width, height;
    float *planes[PLANES]; /* 3 x width x TILE; the difference has the picture's variance as its mean square */
    float *rgb[2]; /* one part of each half */
    double *squares; /* relative square of the error of each pixel, or of each tile */
    size_t count; /* of squares so far */
    LargestValues worst; /* of these, which the error of pixels leaves out */
    size_t *tile_ends; /* `count` after each tile */
    size_t tile_count;
} Estimate;

/* ---- a row of tiles ---------------------------------------------------------------------------------------------- */

/* Share of half 0 in a pixel's part that has these samples. */
static double share_of(double a, double b)
{
    return a + b > 0.0 ? a / (a + b) : 0.5;
}

/* Adds pixels first ... first + count - 1 of a part of both halves to the planes. */
static void part_add(const Estimate *estimate, FilmPart part, size_t first, size_t count)
{
    const Film *halves = estimate->halves;
    bool by_samples = part == FILM_OWN || halves[0].light_samples + halves[1].light_samples == 0;
    double share = share_of((double)halves[0].light_samples, (double)halves[1].light_samples);
    for (int half = 0; half < 2; ++half)
        film_resolve_pixels(&halves[half], part, estimate->scales[half], first, count, estimate->rgb[half]);
    for (size_t value = 0; value < 3 * count; ++value) {
        size_t pixel = first + value / 3;
        double a = (double)estimate->rgb[0][value], b = (double)estimate->rgb[1][value];
        double p = by_samples ? share_of(film_count(&halves[0], pixel), film_count(&halves[1], pixel)) : share;
        estimate->planes[HALF_0][value] += (float)a;
        estimate->planes[HALF_1][value] += (float)b;
        estimate->planes[PICTURE][value] += (float)(p * a + (1.0 - p) * b);
        estimate->planes[DIFFERENCE][value] += (float)(sqrt(p * (1.0 - p)) * (a - b));
    }
}

static void rows_take(const Estimate *estimate, size_t y, size_t rows)
{
    size_t first = 3 * y * estimate->width, count = 3 * rows * estimate->width;
    const float *a = estimate->images[0] + first, *b = estimate->images[1] + first;
    for (size_t value = 0; value < count; ++value) {
        estimate->planes[HALF_0][value] = a[value];
        estimate->planes[HALF_1][value] = b[value];
        estimate->planes[PICTURE][value] = (float)(0.5 * ((double)a[value] + (double)b[value]));
        estimate->planes[DIFFERENCE][value] = (float)(0.5 * ((double)a[value] - (double)b[value]));
    }
}

static void rows_resolve(const Estimate *estimate, size_t y, size_t rows)
{
    size_t first = y * estimate->width, count = rows * estimate->width;
    for (int plane = 0; plane < PLANES; ++plane)
        for (size_t value = 0; value < 3 * count; ++value)
            estimate->planes[plane][value] = 0.0f;
    part_add(estimate, FILM_OWN, first, count);
    if (estimate->halves[0].light_sums)
        part_add(estimate, FILM_LIGHT, first, count);
}

/* ---- a tile ------------------------------------------------------------------------------------------------------ */

/* A channel of a tile; pixels with a value that is not finite are black. */
static void tile_values(const Estimate *estimate, size_t x, size_t rows, size_t channel, TileValues *values)
{
    double *kinds[PLANES] = {values->halves[0], values->halves[1], values->picture, values->difference};
    size_t end = x + TILE < estimate->width ? x + TILE : estimate->width;
    values->count = 0;
    for (size_t row = 0; row < rows; ++row)
        for (size_t column = x; column < end; ++column) {
            size_t value = 3 * (row * estimate->width + column) + channel;
            bool finite = true;
            for (int plane = 0; plane < PLANES; ++plane)
                finite = finite && isfinite(estimate->planes[plane][value]);
            for (int plane = 0; plane < PLANES; ++plane)
                kinds[plane][values->count] = finite ? (double)estimate->planes[plane][value] : 0.0;
            ++values->count;
        }
}

/* Adds a third of the relative squares of one channel: of the pixels, or of the tile. */
static void channel_add(const TileValues *values, bool blocks, double *squares)
{
    if (blocks) {
        double mean = tile_mean(values->picture, values->count),
               difference = tile_mean(values->difference, values->count);
        squares[0] += metrics_relative_square(difference * difference, mean) / 3.0;
        return;
    }
    double light[TILE_PIXELS];
    tile_light(values, light);
    for (size_t i = 0; i < values->count; ++i)
        squares[i] += metrics_relative_square(values->difference[i] * values->difference[i], light[i]) / 3.0;
}

static void tile_add(Estimate *estimate, size_t x, size_t rows)
{
    bool blocks = estimate->goal->blocks;
    double *squares = estimate->squares + estimate->count;
    TileValues values = {.count = 0};
    for (size_t channel = 0; channel < 3; ++channel) {
        tile_values(estimate, x, rows, channel, &values);
        channel_add(&values, blocks, squares);
    }
    size_t added = blocks ? 1 : values.count;
    for (size_t i = 0; i < added && estimate->worst.wanted > 0; ++i)
        largest_values_add(&estimate->worst, squares[i]);
    estimate->count += added;
    estimate->tile_ends[estimate->tile_count++] = estimate->count;
}

/* ---- the film ---------------------------------------------------------------------------------------------------- */

/* The film's worst pixels, which the error leaves out: those above a limit, and as many of those at it as are
 * needed. */
typedef struct Trimmed {
    double limit;
    size_t at_limit;
} Trimmed;

static Trimmed trimmed_of(const LargestValues *worst)
{
    Trimmed trimmed = {worst->count > 0 ? largest_values_least(worst) : (double)INFINITY, 0};
    for (size_t i = 0; i < worst->count; ++i)
        trimmed.at_limit += worst->heap[i] > trimmed.limit ? 0 : 1;
    return trimmed;
}

/* The sum of the squares in a tile that are not left out; those that are, in order of their pixels. */
static double tile_sum(const Estimate *estimate, size_t tile, Trimmed *trimmed)
{
    double sum = 0.0;
    for (size_t i = tile > 0 ? estimate->tile_ends[tile - 1] : 0; i < estimate->tile_ends[tile]; ++i) {
        double square = estimate->squares[i];
        bool out = square > trimmed->limit || (!(square < trimmed->limit) && trimmed->at_limit > 0);
        trimmed->at_limit -= out && !(square > trimmed->limit) ? 1 : 0;
        sum += out ? 0.0 : square;
    }
    return sum;
}

/* Root of the mean. Its standard error is, relative to it, half of that of the sum over the tiles, whose variance is
 * estimated from the differences between neighbours: tiles have different errors, but those of neighbours are alike. */
static HalvesError mean_error(const Estimate *estimate)
{
    double sum = 0.0, spread = 0.0, tiles = (double)estimate->tile_count, before = 0.0;
    Trimmed trimmed = trimmed_of(&estimate->worst);
    size_t pairs = estimate->tile_count / 2;
    for (size_t i = 0; i < estimate->tile_count; ++i) {
        double tile = tile_sum(estimate, i, &trimmed);
        sum += tile;
        if (i % 2 != 0)
            spread += (before - tile) * (before - tile);
        before = tile;
    }
    double value = sqrt(sum / (double)(estimate->count - estimate->worst.count));
    double deviation = pairs > 0 ? sqrt(spread * tiles / (2.0 * (double)pairs)) : sum;
    return (HalvesError){value, sum > 0.0 ? 0.5 * value * deviation / sum : 0.0};
}

/* The error at a fraction of the pixels in order of their errors. */
static double percentile_of(const Estimate *estimate, double part)
{
    double last = (double)(estimate->count - 1), place = ceil(part * (double)estimate->count) - 1.0;
    return sqrt(estimate->squares[(size_t)fmin(fmax(place, 0.0), last)]);
}

/* About how many pixels have one error between them, for the pixel filter spreads it. */
#define PIXELS_ALIKE 4.0

/* Its standard error is that of the rank of the errors below it. */
static HalvesError percentile_error(const Estimate *estimate)
{
    double part = 0.01 * estimate->goal->percentile;
    double independent = fmax(1.0, (double)estimate->count / (estimate->goal->blocks ? 1.0 : PIXELS_ALIKE));
    sample_sort(estimate->squares, estimate->count);
    double value = percentile_of(estimate, part);
    return (HalvesError){value, percentile_of(estimate, part + sqrt(part * (1.0 - part) / independent)) - value};
}

/* Whether the worst pixels are left out. */
static bool is_trimmed(const ErrorGoal *goal)
{
    return !goal->blocks && !(goal->percentile > 0.0);
}

static bool estimate_allocate(Estimate *estimate, Error *error)
{
    size_t values = 3 * estimate->width * TILE, pixels = estimate->width * estimate->height;
    size_t tiles = ((estimate->width + TILE - 1) / TILE) * ((estimate->height + TILE - 1) / TILE);
    bool complete = true;
    for (int plane = 0; plane < PLANES; ++plane)
        complete = (estimate->planes[plane] = calloc(values, sizeof(float))) && complete;
    for (int half = 0; half < 2; ++half)
        complete = (estimate->rgb[half] = calloc(values, sizeof(float))) && complete;
    estimate->squares = calloc(estimate->goal->blocks ? tiles : pixels, sizeof *estimate->squares);
    estimate->tile_ends = malloc(tiles * sizeof *estimate->tile_ends);
    estimate->worst.wanted = is_trimmed(estimate->goal) ? pixels / METRICS_TRIMMED_SHARE : 0;
    estimate->worst.heap = malloc((estimate->worst.wanted + 1) * sizeof *estimate->worst.heap);
    complete = complete && estimate->squares && estimate->tile_ends && estimate->worst.heap;
    return complete ||
           error_memory(error, (PLANES + 2) * values * sizeof(float) + pixels * sizeof(double), "the error's estimate");
}

static void estimate_free(Estimate *estimate)
{
    for (int plane = 0; plane < PLANES; ++plane)
        free(estimate->planes[plane]);
    for (int half = 0; half < 2; ++half)
        free(estimate->rgb[half]);
    free(estimate->squares);
    free(estimate->tile_ends);
    free(estimate->worst.heap);
}

static bool estimate_make(Estimate *estimate, HalvesError *error_found, Error *error)
{
    bool done = estimate_allocate(estimate, error);
    for (size_t y = 0; done && y < estimate->height; y += TILE) {
        size_t rows = y + TILE < estimate->height ? TILE : estimate->height - y;
        if (estimate->halves)
            rows_resolve(estimate, y, rows);
        else
            rows_take(estimate, y, rows);
        for (size_t x = 0; x < estimate->width; x += TILE)
            tile_add(estimate, x, rows);
    }
    if (done)
        *error_found = estimate->goal->percentile > 0.0 ? percentile_error(estimate) : mean_error(estimate);
    estimate_free(estimate);
    return done;
}

bool halves_error(const Film halves[2], const ErrorGoal *goal, HalvesError *error_found, Error *error)
{
    const int *crop = halves[0].crop;
    Estimate estimate = {
        .halves = halves, .goal = goal, .width = (size_t)(crop[2] - crop[0]), .height = (size_t)(crop[3] - crop[1])};
    for (int half = 0; half < 2; ++half)
        estimate.scales[half] = film_scale_of(&halves[half], (float)goal->scale);
    return estimate_make(&estimate, error_found, error);
}

bool halves_error_of_images(const float *const images[2], int width, int height, const ErrorGoal *goal,
                            HalvesError *error_found, Error *error)
{
    Estimate estimate = {
        .images = {images[0], images[1]}, .goal = goal, .width = (size_t)width, .height = (size_t)height};
    return estimate_make(&estimate, error_found, error);
}
