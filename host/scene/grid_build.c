#include "scene/grid_build.h"

#include "geometry/grid_emission.h"
#include "image/color.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLE_WORDS_MAX 6

/* ---- bricks ------------------------------------------------------------------------------------------------------ */

typedef struct Builder {
    Scene *scene;
    const GridSource *source;
    float *samples; /* of the brick at hand */
    uint constant; /* first word of the latest brick whose samples are all equal, or NONE */
} Builder;

/* Sample i of an axis has the coordinate i + 1; beyond the first and last there are zeros. */
static void sample_read(const Builder *builder, const uint corner[3], uint place, float *out)
{
    const GridSource *source = builder->source;
    const uint offset[3] = {place % GRID_EDGE, place / GRID_EDGE % GRID_EDGE, place / (GRID_EDGE * GRID_EDGE)};
    uint index[3];
    for (int i = 0; i < 3; ++i) {
        index[i] = corner[i] + offset[i] - 1u; /* NONE before the first */
        if (index[i] >= source->size[i] + source->ends) {
            memset(out, 0, source->words * sizeof *out);
            return;
        }
    }
    source->sample(source->context, index, out);
}

/* Whether the source knows that the brick is 0 throughout. */
static bool brick_empty(const GridSource *source, const uint corner[3])
{
    uint low[3], high[3];
    for (int i = 0; i < 3; ++i) {
        uint last = source->size[i] + source->ends - 1u;
        low[i] = corner[i] > 0 ? corner[i] - 1u : 0u;
        high[i] = corner[i] + GRID_BRICK - 1u < last ? corner[i] + GRID_BRICK - 1u : last;
        if (low[i] > last)
            return true;
    }
    return source->empty && source->empty(source->context, low, high);
}

static bool samples_equal(const float *samples, size_t words)
{
    for (size_t i = words; i < GRID_BRICK_SAMPLES * words; ++i)
        if (samples[i] != samples[i - words])
            return false;
    return true;
}

/* Reads the brick whose lowest cell is `corner`, and appends it to texels. *first: its first word there, NONE if it is
 * 0 throughout. Neighbours that have the same constant samples share them. */
static bool brick_add(Builder *builder, const uint corner[3], uint *first, Error *error)
{
    Array *texels = &builder->scene->texels;
    size_t words = builder->source->words, count = GRID_BRICK_SAMPLES * words;
    *first = NONE;
    if (brick_empty(builder->source, corner))
        return true;
    for (uint i = 0; i < GRID_BRICK_SAMPLES; ++i)
        sample_read(builder, corner, i, builder->samples + i * words);
    bool constant = samples_equal(builder->samples, words);
    bool empty = constant;
    for (size_t i = 0; i < words; ++i)
        empty = empty && builder->samples[i] == 0.0f;
    *first = empty ? NONE : builder->constant;
    if (empty || (constant && builder->constant != NONE &&
                  memcmp(&ARRAY_AT(texels, uint, builder->constant), builder->samples, count * sizeof(float)) == 0))
        return true;
    if (texels->count + count >= SCENE_WORDS_MAX) {
        error_set(error, "the scene's grids and textures need more than 16 GiB");
        return error_fix(error, "use grids of fewer samples, or smaller textures");
    }
    *first = (uint)texels->count;
    float *out = array_grow(texels, count, error);
    if (!out)
        return false;
    memcpy(out, builder->samples, count * sizeof *out);
    builder->constant = constant ? *first : builder->constant;
    return true;
}

static bool bricks_add(Builder *builder, const MediumGrid *grid, Error *error)
{
    uint corner[3], entry = grid->bricks;
    for (corner[2] = 0; corner[2] <= grid->size_z; corner[2] += GRID_BRICK)
        for (corner[1] = 0; corner[1] <= grid->size_y; corner[1] += GRID_BRICK)
            for (corner[0] = 0; corner[0] <= grid->size_x; corner[0] += GRID_BRICK) {
                uint first;
                if (!brick_add(builder, corner, &first, error))
                    return false;
                ARRAY_AT(&builder->scene->texels, uint, entry++) = first;
            }
    return true;
}

/* Divides the factors of each word by the largest. begin: first word of the samples in `texels`. */
static void factors_scale(Array *texels, size_t begin, uint words, float *largest)
{
    float *factors = (float *)texels->data + begin;
    size_t count = texels->count - begin;
    memset(largest, 0, words * sizeof *largest);
    for (size_t i = 0; i < count; ++i)
        largest[i % words] = factors[i] > largest[i % words] ? factors[i] : largest[i % words];
    for (size_t i = 0; i < count; ++i)
        if (largest[i % words] > 0.0f)
            factors[i] /= largest[i % words];
}

bool grid_add(Scene *scene, const GridSource *source, uint *number, float *largest, Error *error)
{
    const uint *size = source->size;
    size_t bricks = (size_t)grid_bricks(size[0]) * grid_bricks(size[1]) * grid_bricks(size[2]);
    MediumGrid *grid = array_grow(&scene->grids, 1, error);
    if (!grid || !array_grow(&scene->texels, bricks, error))
        return false;
    *grid = (MediumGrid){.grid_from_world = matrix_affine(source->grid_from_world.m),
                         .size_x = size[0],
                         .size_y = size[1],
                         .size_z = size[2],
                         .low = source->low,
                         .words = source->words,
                         .table = NONE,
                         .bricks = (uint)(scene->texels.count - bricks)};
    Builder builder = {scene, source, malloc(GRID_BRICK_SAMPLES * source->words * sizeof(float)), NONE};
    bool good = builder.samples ? bricks_add(&builder, grid, error)
                                : error_memory(error, GRID_BRICK_SAMPLES * source->words * sizeof(float), "a grid");
    free(builder.samples);
    *number = (uint)scene->grids.count;
    if (good)
        factors_scale(&scene->texels, grid->bricks + bricks, source->words, largest);
    return good;
}

/* ---- emission ---------------------------------------------------------------------------------------------------- */

/* The table of black bodies, which all of the scene's grids share. */
static bool blackbody_table_find(Scene *scene, uint *table, Error *error)
{
    for (size_t i = 0; i < scene->grids.count; ++i) {
        *table = ARRAY_AT(&scene->grids, MediumGrid, i).table;
        if (*table != NONE)
            return true;
    }
    *table = (uint)scene->lookup.count;
    float *rows = array_grow(&scene->lookup, BLACKBODY_WORDS, error);
    if (!rows)
        return false;
    for (uint i = 0; i < BLACKBODY_ROWS; ++i)
        color_blackbody_relative(BLACKBODY_MIDDLE * (float)i / (float)(BLACKBODY_ROWS - i), rows + (size_t)i * 3);
    return true; /* the last row, of infinite temperature, is 0 */
}

/* Whether one grid's cells are the other's. */
static bool grids_align(const MediumGrid *a, const MediumGrid *b)
{
    for (int i = 0; i < 12; ++i) {
        float difference = a->grid_from_world.m[i] - b->grid_from_world.m[i];
        float tolerance = i % 4 == 3 ? 1e-3f : 1e-6f * fabsf(a->grid_from_world.m[i]);
        if (!(fabsf(difference - (i % 4 == 3 ? rintf(difference) : 0.0f)) <= tolerance))
            return false;
    }
    return true;
}

bool grid_emission_add(Scene *scene, uint number, const GridSource *source, const GridKelvin *kelvin, float *largest,
                       Error *error)
{
    uint emission, table = NONE;
    if (!grid_add(scene, source, &emission, largest, error) || (kelvin && !blackbody_table_find(scene, &table, error)))
        return false;
    MediumGrid *grid = &ARRAY_AT(&scene->grids, MediumGrid, number - 1),
               *emits = &ARRAY_AT(&scene->grids, MediumGrid, emission - 1);
    grid->emission = emission;
    emits->aligned = grids_align(grid, emits) ? 1u : 0u;
    emits->table = table;
    if (kelvin) {
        emits->kelvin_scale = kelvin->scale * largest[0];
        emits->kelvin_offset = kelvin->offset;
    }
    return true;
}

Box grid_box(const MediumGrid *grid)
{
    Matrix grid_from_world = matrix_identity(), world_from_grid;
    const float size[3] = {(float)grid->size_x, (float)grid->size_y, (float)grid->size_z};
    Box box;
    for (int i = 0; i < 12; ++i)
        grid_from_world.m[i] = (double)grid->grid_from_world.m[i];
    for (int i = 0; i < 3; ++i) {
        box.low[i] = grid->low;
        box.high[i] = grid->low + size[i];
    }
    if (!matrix_inverse(&grid_from_world, &world_from_grid)) /* not after grid_add, whose transform can be inverted */
        return box_empty();
    return box_transform(&box, matrix_affine(world_from_grid.m));
}
