#include "compare/z_test.h"

#include "base/student.h"

#include <math.h>
#include <stdlib.h>

#define NEIGHBOURS 2 /* tiles on each side over which the correlation is averaged */

/* Relative difference that is attributed to the rounding of files to 24 bits. */
#define ROUNDING 0x1p-20

/* Sums of x^2 and x^4 over pixels. */
typedef struct Moments {
    double squares, fourths;
} Moments;

/* One channel of a tile in both renderings. */
typedef struct TileValue {
    double mean[2];
    Moments halves; /* of d, over both renderings */
    Moments between; /* of the difference between the renderings */
    double of_sums; /* sum over both renderings of (sum of d)^2 */
    int pixels;
} TileValue;

typedef struct Tiles {
    int columns, rows;
    TileValue *values; /* 3 per tile */
} Tiles;

static double finite_or_zero(float x)
{
    return isfinite(x) ? (double)x : 0.0;
}

static void moments_add(Moments *moments, double x)
{
    moments->squares += x * x;
    moments->fourths += x * x * x * x;
}

/* Estimated degrees of freedom of a sum of squares. */
static double moments_freedom(const Moments *moments)
{
    return moments->fourths > 0.0 ? 3.0 * moments->squares * moments->squares / moments->fourths - 2.0 : HUGE_VAL;
}

static TileValue tile_measure(const float *const halves[2][2], int width, const int box[4], int channel)
{
    TileValue tile = {.pixels = (box[2] - box[0]) * (box[3] - box[1])};
    double differences[2] = {0.0, 0.0};
    for (int y = box[1]; y < box[3]; ++y) {
        for (int x = box[0]; x < box[2]; ++x) {
            size_t i = 3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)channel;
            double values[2];
            for (int which = 0; which < 2; ++which) {
                double a = finite_or_zero(halves[which][0][i]), b = finite_or_zero(halves[which][1][i]);
                values[which] = 0.5 * (a + b);
                tile.mean[which] += values[which] / tile.pixels;
                differences[which] += 0.5 * (a - b);
                moments_add(&tile.halves, 0.5 * (a - b));
            }
            moments_add(&tile.between, values[0] - values[1]);
        }
    }
    tile.of_sums = differences[0] * differences[0] + differences[1] * differences[1];
    return tile;
}

static void tiles_fill(Tiles *tiles, const float *const halves[2][2], int width, int height)
{
    for (int j = 0; j < tiles->rows; ++j) {
        for (int i = 0; i < tiles->columns; ++i) {
            int x = i * Z_TEST_TILE, y = j * Z_TEST_TILE;
            const int box[4] = {x, y, x + Z_TEST_TILE < width ? x + Z_TEST_TILE : width,
                                y + Z_TEST_TILE < height ? y + Z_TEST_TILE : height};
            for (int c = 0; c < 3; ++c)
                tiles->values[3 * (j * tiles->columns + i) + c] = tile_measure(halves, width, box, c);
        }
    }
}

/* Mean of R over the tiles around a tile. */
static double tile_correlation(const Tiles *tiles, int column, int row)
{
    double sum = 0.0;
    int count = 0;
    for (int j = row - NEIGHBOURS; j <= row + NEIGHBOURS; ++j) {
        for (int i = column - NEIGHBOURS; i <= column + NEIGHBOURS; ++i) {
            if (i < 0 || j < 0 || i >= tiles->columns || j >= tiles->rows)
                continue;
            const TileValue *values = &tiles->values[3 * (j * tiles->columns + i)];
            for (int c = 0; c < 3; ++c) {
                if (!(values[c].halves.squares > 0.0))
                    continue;
                sum += values[c].of_sums / values[c].halves.squares;
                ++count;
            }
        }
    }
    return count > 0 ? fmax(sum / count, 1.0) : 1.0;
}

/* Probability of a difference at least as large as the tile's; negative if there is nothing to test. */
static double tile_probability(const TileValue *tile, double neighbours)
{
    double difference = tile->mean[0] - tile->mean[1], squares = tile->halves.squares;
    double rounding = ROUNDING * (fabs(tile->mean[0]) + fabs(tile->mean[1]));
    double own = squares > 0.0 ? tile->of_sums / squares : 1.0, correlation = fmax(own, neighbours);
    double variance = correlation * squares / ((double)tile->pixels * tile->pixels) + rounding * rounding;
    double most = 2.0 * tile->pixels;
    if (squares == 0.0 && fabs(difference) <= rounding)
        return -1.0;
    double freedom = fmin(moments_freedom(&tile->halves), moments_freedom(&tile->between)) / correlation;
    return student_two_sided(difference / sqrt(variance), fmin(fmax(freedom, 1.0), most));
}

/* Computes the probabilities of all tiles; returns the number of values tested. */
static size_t probabilities_fill(const Tiles *tiles, ZTest *test, double *probabilities)
{
    size_t count = 0;
    for (int j = 0; j < tiles->rows; ++j) {
        for (int i = 0; i < tiles->columns; ++i) {
            double correlation = tile_correlation(tiles, i, j);
            test->correlation += correlation / ((double)tiles->columns * tiles->rows);
            for (int c = 0; c < 3; ++c) {
                double p = tile_probability(&tiles->values[3 * (j * tiles->columns + i) + c], correlation);
                if (p >= 0.0)
                    probabilities[count++] = p;
            }
        }
    }
    return count;
}

static void test_judge(ZTest *test, const double *probabilities)
{
    size_t below = 0;
    test->least = 1.0;
    test->bound = test->values > 0 ? -expm1(log1p(-Z_TEST_ALPHA) / (double)test->values) : Z_TEST_ALPHA;
    for (size_t i = 0; i < test->values; ++i) {
        test->least = fmin(test->least, probabilities[i]);
        test->outside += probabilities[i] < test->bound;
        below += probabilities[i] < 0.05;
    }
    test->below_5_percent = test->values > 0 ? (double)below / (double)test->values : 0.0;
    test->passed = (double)test->outside <= (1.0 - Z_TEST_SHARE) * (double)test->values;
}

bool z_test_compute(const float *const halves[2][2], int width, int height, ZTest *test, Error *error)
{
    Tiles tiles = {(width + Z_TEST_TILE - 1) / Z_TEST_TILE, (height + Z_TEST_TILE - 1) / Z_TEST_TILE, NULL};
    size_t values = 3 * (size_t)tiles.columns * (size_t)tiles.rows;
    *test = (ZTest){0};
    tiles.values = calloc(values, sizeof *tiles.values);
    double *probabilities = malloc(values * sizeof *probabilities);
    bool good = tiles.values && probabilities;
    if (good) {
        tiles_fill(&tiles, halves, width, height);
        test->values = probabilities_fill(&tiles, test, probabilities);
        test_judge(test, probabilities);
    } else {
        error_memory(error, values * (sizeof *tiles.values + sizeof *probabilities), "the test of differences");
    }
    free(tiles.values);
    free(probabilities);
    return good;
}
