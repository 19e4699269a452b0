#include "mmlt/importance.h"

#include "layout/item.h"
#include "mmlt/tuning.h"

#include <math.h>
#include <stdlib.h>

void importance_even(float importance[IMPORTANCE_CELLS])
{
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        importance[i] = 1.0f;
}

/* Range of the tiles that overlap cell `cell` of an axis of `size` pixels, and their neighbours. */
static void tiles_near(int cell, int size, int tiles, int *first, int *last)
{
    double unit = (double)size / (double)IMPORTANCE_SIDE;
    *first = (int)(cell * unit) / TILE_SIDE - 1;
    *last = ((int)ceil((cell + 1) * unit) - 1) / TILE_SIDE + 1;
    *first = *first > 0 ? *first : 0;
    *last = *last < tiles ? *last : tiles - 1;
}

static int tile_pixels(int tile, int size)
{
    int left = size - tile * TILE_SIDE;
    return left < TILE_SIDE ? left : TILE_SIDE;
}

/* Mean luminance of the pixels in and around a cell. */
static double light_around(const Combination *combination, int column, int row)
{
    int x0, x1, y0, y1;
    double light = 0.0, pixels = 0.0;
    tiles_near(column, combination->size[0], combination->tiles[0], &x0, &x1);
    tiles_near(row, combination->size[1], combination->tiles[1], &y0, &y1);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            light += combination->known[(size_t)y * (size_t)combination->tiles[0] + (size_t)x].light;
            pixels += (double)tile_pixels(x, combination->size[0]) * (double)tile_pixels(y, combination->size[1]);
        }
    return light / pixels;
}

static bool importance_sound(const float importance[IMPORTANCE_CELLS])
{
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        if (!((double)importance[i] >= IMPORTANCE_LEAST && (double)importance[i] <= IMPORTANCE_MOST))
            return false;
    return true;
}

void importance_learn(const Combination *combination, float importance[IMPORTANCE_CELLS])
{
    double light[IMPORTANCE_CELLS], sum = 0.0, worth = 0.0;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        light[i] = light_around(combination, (int)(i % IMPORTANCE_SIDE), (int)(i / IMPORTANCE_SIDE));
        sum += light[i];
    }
    importance_even(importance);
    if (!(sum > 0.0))
        return;
    double least = LIGHT_LEAST * sum / IMPORTANCE_CELLS;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        double inverse = pow(light[i] + least, -EXPONENT);
        worth += light[i] * inverse;
        importance[i] = (float)inverse;
    }
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        importance[i] = (float)((double)importance[i] * (sum / worth));
    if (!importance_sound(importance))
        importance_even(importance);
}

/* ---- visits ------------------------------------------------------------------------------------------------------ */

static uint cell_pixels(const int size[2], uint cell)
{
    uint width = (uint)size[0], height = (uint)size[1];
    uint column = cell % IMPORTANCE_SIDE, row = cell / IMPORTANCE_SIDE;
    return (cell_begin(column + 1, width) - cell_begin(column, width)) *
           (cell_begin(row + 1, height) - cell_begin(row, height));
}

/* Mean relative error of the tiles that overlap a cell that has pixels. */
static double error_around(const Combination *combination, const double *errors, uint cell)
{
    uint width = (uint)combination->size[0], height = (uint)combination->size[1];
    uint column = cell % IMPORTANCE_SIDE, row = cell / IMPORTANCE_SIDE, tiles = 0;
    double sum = 0.0;
    for (uint y = cell_begin(row, height) / TILE_SIDE; y <= (cell_begin(row + 1, height) - 1) / TILE_SIDE; ++y)
        for (uint x = cell_begin(column, width) / TILE_SIDE; x <= (cell_begin(column + 1, width) - 1) / TILE_SIDE;
             ++x, ++tiles)
            sum += errors[(size_t)y * (size_t)combination->tiles[0] + x];
    return sum / tiles;
}

bool importance_visits(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                       const double visited[IMPORTANCE_CELLS], uint visits[IMPORTANCE_CELLS + 1], Error *error)
{
    double *errors = malloc((size_t)combination->tiles[0] * (size_t)combination->tiles[1] * sizeof *errors);
    double deviation[IMPORTANCE_CELLS] = {0.0}, sum = 0.0,
           pixels = (double)combination->size[0] * (double)combination->size[1];
    uint64_t all = 0;
    visits[IMPORTANCE_CELLS] = 0;
    if (!errors)
        return error_memory(error, (size_t)combination->tiles[0] * (size_t)combination->tiles[1] * sizeof *errors,
                            "errors of tiles");
    combination_errors(combination, samples, errors);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        uint count = cell_pixels(combination->size, i);
        if (count > 0)
            deviation[i] = sqrt(error_around(combination, errors, i) * visited[i]);
        sum += count * deviation[i];
    }
    free(errors);
    if (!(sum > 0.0) || VISITS_MOST * pixels > 0x1p31)
        return true;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        double each = rint(VISITS_MEAN * deviation[i] * pixels / sum);
        visits[i] = (uint)all;
        all += cell_pixels(combination->size, i) * (uint64_t)fmin(fmax(each, 1.0), VISITS_MOST);
    }
    visits[IMPORTANCE_CELLS] = (uint)all;
    return true;
}

/* Whether all pixels of a cell have the same whole number of visits, and these add up from 0 on. */
static bool visits_sound(const uint visits[IMPORTANCE_CELLS + 1], const int size[2])
{
    uint64_t all = 0;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        uint pixels = cell_pixels(size, i), own = visits[i + 1] - visits[i];
        if (own < pixels || own > (uint64_t)VISITS_MOST * pixels || (pixels > 0 && own % pixels != 0))
            return false;
        all += own;
    }
    return visits[IMPORTANCE_CELLS] == all;
}

void importance_visits_archive(Archive *archive, uint visits[IMPORTANCE_CELLS + 1], const int size[2])
{
    archive_bytes(archive, visits, (IMPORTANCE_CELLS + 1) * sizeof *visits);
    if (!archive->saves && visits[IMPORTANCE_CELLS] > 0 && !visits_sound(visits, size))
        archive_fail(archive, "the visits of a pool's pixels do not add up");
}

double importance_density_ratio(const Combination *combination, const uint visits[IMPORTANCE_CELLS + 1], uint cell)
{
    double count = (double)cell_pixels(combination->size, cell),
           pixels = (double)combination->size[0] * (double)combination->size[1];
    if (!(count > 0.0))
        return 0.0;
    uint all = visits[IMPORTANCE_CELLS];
    return all > 0 ? (double)all / pixels / ((double)(visits[cell + 1] - visits[cell]) / count) : 1.0;
}
