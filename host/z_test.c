#include "z_test.h"

#include "student.h"

#include <math.h>
#include <stdlib.h>

#define NEIGHBOURS 2 /* tiles on either side whose correlation is averaged */

/* EXRs hold 24 bits: differences of that size are none. */
#define ROUNDING 0x1p-20

/* One channel of a tile of both renderings. */
typedef struct TileValue {
    double mean[2];
    double squares, fourths; /* sums of d^2 and d^4 over both renderings */
    double of_sums; /* sum over the renderings of (sum of d)^2 */
    int pixels;
} TileValue;

typedef struct Tiles {
    int columns, rows;
    TileValue *values; /* 3 a tile */
} Tiles;

static double finite_or_zero(float x)
{
    return isfinite(x) ? (double)x : 0.0;
}

/* Adds the pixels of rendering `which` to a tile's channel. */
static void tile_add(TileValue *tile, int which, const float *const halves[2], int width, const int box[4], int channel)
{
    double sum = 0.0, differences = 0.0;
    tile->pixels = (box[2] - box[0]) * (box[3] - box[1]);
    for (int y = box[1]; y < box[3]; ++y) {
        for (int x = box[0]; x < box[2]; ++x) {
            size_t i = 3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)channel;
            double a = finite_or_zero(halves[0][i]), b = finite_or_zero(halves[1][i]), d = 0.5 * (a - b);
            sum += 0.5 * (a + b);
            differences += d;
            tile->squares += d * d;
            tile->fourths += d * d * d * d;
        }
    }
    tile->mean[which] = sum / tile->pixels;
    tile->of_sums += differences * differences;
}

static void tiles_fill(Tiles *tiles, const float *const halves[2][2], int width, int height)
{
    for (int j = 0; j < tiles->rows; ++j) {
        for (int i = 0; i < tiles->columns; ++i) {
            int x = i * Z_TEST_TILE, y = j * Z_TEST_TILE;
            const int box[4] = {x, y, x + Z_TEST_TILE < width ? x + Z_TEST_TILE : width,
                                y + Z_TEST_TILE < height ? y + Z_TEST_TILE : height};
            for (int c = 0; c < 3; ++c)
                for (int which = 0; which < 2; ++which)
                    tile_add(&tiles->values[3 * (j * tiles->columns + i) + c], which, halves[which], width, box, c);
        }
    }
}

/* The mean of R around a tile. */
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
                if (!(values[c].squares > 0.0))
                    continue;
                sum += values[c].of_sums / values[c].squares;
                ++count;
            }
        }
    }
    return count > 0 ? fmax(sum / count, 1.0) : 1.0;
}

/* The probability of a difference as large as the tile's; negative when there is nothing to test. */
static double tile_probability(const TileValue *tile, double neighbours)
{
    double difference = tile->mean[0] - tile->mean[1];
    double rounding = ROUNDING * (fabs(tile->mean[0]) + fabs(tile->mean[1]));
    double own = tile->squares > 0.0 ? tile->of_sums / tile->squares : 1.0, correlation = fmax(own, neighbours);
    double variance = correlation * tile->squares / ((double)tile->pixels * tile->pixels) + rounding * rounding;
    double most = 2.0 * tile->pixels, freedom = most;
    if (tile->squares == 0.0 && fabs(difference) <= rounding)
        return -1.0;
    if (tile->fourths > 0.0)
        freedom = (3.0 * tile->squares * tile->squares / tile->fourths - 2.0) / correlation;
    freedom = fmin(fmax(freedom, 1.0), most);
    return student_two_sided(difference / sqrt(variance), freedom);
}

/* Every tile's probabilities; returns how many were tested. */
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
