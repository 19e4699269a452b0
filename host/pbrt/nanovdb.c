#include "pbrt/nanovdb.h"

#include "base/file_read.h"
#include "base/gzip.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FILE_MAGIC 0x304244566f6e614eu /* "NanoVDB0" */
#define FILE_MAJOR 32u
#define FILE_BYTES_MAX ((size_t)1 << 34)

enum { CODEC_NONE, CODEC_ZIP };
enum { GRID_TYPE_FLOAT = 1, GRID_CLASS_LEVEL_SET = 1 };

/* Sizes and offsets in bytes. */
enum {
    HEADER_BYTES = 16,
    META_BYTES = 176,
    META_NAME_SIZE = 136,
    GRID_BYTES = 672,
    GRID_MAP = 384, /* 3 x 3 doubles; the translation follows the inverse */
    GRID_TRANSLATION = 528,
    GRID_CLASS = 632,
    GRID_TYPE = 636,
    TREE_NODES = 0, /* offsets of leaves, lower, upper, root */
    TREE_COUNTS = 32, /* of leaves, lower, upper */
    ROOT_BYTES = 64,
    ROOT_TILES = 24,
    ROOT_BACKGROUND = 28,
    TILE_BYTES = 32,
    TILE_CHILD = 8,
    TILE_VALUE = 20,
    NODE_MASKS = 32, /* of values, then of children */
    UPPER_CHILDREN = 32768,
    UPPER_TABLE = 8256,
    UPPER_BYTES = 270400,
    LOWER_CHILDREN = 4096,
    LOWER_TABLE = 1088,
    LOWER_BYTES = 33856,
    LEAF_TABLE = 96,
    LEAF_BYTES = 2144
};

/* ---- numbers ----------------------------------------------------------------------------------------------------- */

static uint32_t word32(const char *at)
{
    uint32_t word;
    memcpy(&word, at, sizeof word);
    return word;
}

static uint64_t word64(const char *at)
{
    uint64_t word;
    memcpy(&word, at, sizeof word);
    return word;
}

static float number32(const char *at)
{
    return bits_float(word32(at));
}

static double number64(const char *at)
{
    double number;
    memcpy(&number, at, sizeof number);
    return number;
}

static const char *bytes_at(const NanoVdb *grid, size_t place)
{
    return (const char *)grid->bytes.data + place;
}

/* ---- the tree ---------------------------------------------------------------------------------------------------- */

/* A level of the tree: its nodes lie one behind the other. */
typedef struct Level {
    size_t first, bytes; /* of a node */
    uint count;
} Level;

/* Whether a child `offset` bytes from its parent is one of the level's nodes. */
static bool level_has(const Level *level, size_t parent, uint64_t offset)
{
    uint64_t place = parent + offset - level->first; /* wraps if the child comes before */
    return place % level->bytes == 0 && place / level->bytes < level->count;
}

static bool mask_bit(const char *mask, uint i)
{
    return (mask[i / 8] >> (i % 8) & 1) != 0;
}

/* Whether all children of the level's nodes are of the level below. table: place of children in a node. */
static bool children_check(const NanoVdb *grid, const Level *level, size_t table, uint children, const Level *below)
{
    for (uint n = 0; n < level->count; ++n) {
        size_t node = level->first + n * level->bytes;
        const char *mask = bytes_at(grid, node) + NODE_MASKS + children / 8;
        for (uint i = 0; i < children; ++i)
            if (mask_bit(mask, i) && !level_has(below, node, word64(bytes_at(grid, node) + table + 8 * (size_t)i)))
                return false;
    }
    return true;
}

static bool tiles_check(const NanoVdb *grid, const Level *upper)
{
    for (uint i = 0; i < grid->tiles; ++i) {
        uint64_t child = word64(bytes_at(grid, grid->root) + ROOT_BYTES + (size_t)i * TILE_BYTES + TILE_CHILD);
        if (child != 0 && !level_has(upper, grid->root, child))
            return false;
    }
    return true;
}

static bool level_fits(const NanoVdb *grid, const Level *level)
{
    return level->count == 0 || (level->first >= GRID_BYTES && level->first < grid->bytes.count &&
                                 level->count <= (grid->bytes.count - level->first) / level->bytes);
}

/* Finds the nodes. False if they are not all inside of the grid. */
static bool tree_open(NanoVdb *grid)
{
    const char *tree = bytes_at(grid, GRID_BYTES);
    size_t places[4];
    for (size_t i = 0; i < 4; ++i) {
        places[i] = GRID_BYTES + word64(tree + TREE_NODES + 8 * i);
        if (places[i] < GRID_BYTES || places[i] > grid->bytes.count)
            return false;
    }
    const Level leaves = {places[0], LEAF_BYTES, word32(tree + TREE_COUNTS)},
                lower = {places[1], LOWER_BYTES, word32(tree + TREE_COUNTS + 4)},
                upper = {places[2], UPPER_BYTES, word32(tree + TREE_COUNTS + 8)};
    grid->root = places[3];
    if (grid->root + ROOT_BYTES > grid->bytes.count)
        return false;
    const char *root = bytes_at(grid, grid->root);
    grid->tiles = word32(root + ROOT_TILES);
    grid->background = number32(root + ROOT_BACKGROUND);
    for (size_t i = 0; i < 3; ++i) {
        grid->low[i] = (int)word32(root + 4 * i);
        grid->high[i] = (int)word32(root + 12 + 4 * i);
    }
    return grid->tiles <= (grid->bytes.count - grid->root - ROOT_BYTES) / TILE_BYTES && level_fits(grid, &leaves) &&
           level_fits(grid, &lower) && level_fits(grid, &upper) && tiles_check(grid, &upper) &&
           children_check(grid, &upper, UPPER_TABLE, UPPER_CHILDREN, &lower) &&
           children_check(grid, &lower, LOWER_TABLE, LOWER_CHILDREN, &leaves);
}

/* The root's tile for an index, or NULL. */
static const char *tile_find(const NanoVdb *grid, const int index[3])
{
    uint64_t key = (uint64_t)((uint)index[2] >> 12) | (uint64_t)((uint)index[1] >> 12) << 21 |
                   (uint64_t)((uint)index[0] >> 12) << 42;
    const char *tile = bytes_at(grid, grid->root) + ROOT_BYTES;
    for (uint i = 0; i < grid->tiles; ++i, tile += TILE_BYTES)
        if (word64(tile) == key)
            return tile;
    return NULL;
}

/* The number of an index among a node's children, each 2^shift wide, 2^bits along an axis. */
static uint child_number(const int index[3], uint shift, uint bits)
{
    uint mask = (1u << bits) - 1u, x = (uint)index[0] >> shift & mask, y = (uint)index[1] >> shift & mask,
         z = (uint)index[2] >> shift & mask;
    return (x << bits | y) << bits | z;
}

/* The leaf that has an index; NULL: *value is that of the tile there. */
static const char *leaf_find(const NanoVdb *grid, const int index[3], float *value)
{
    const char *tile = tile_find(grid, index);
    *value = tile ? number32(tile + TILE_VALUE) : grid->background;
    if (!tile || word64(tile + TILE_CHILD) == 0)
        return NULL;
    const char *node = bytes_at(grid, grid->root) + word64(tile + TILE_CHILD);
    for (int level = 0; level < 2; ++level) {
        uint number = level == 0 ? child_number(index, 7, 5) : child_number(index, 3, 4);
        uint children = level == 0 ? UPPER_CHILDREN : LOWER_CHILDREN;
        const char *entry = node + (level == 0 ? UPPER_TABLE : LOWER_TABLE) + 8 * (size_t)number;
        *value = number32(entry);
        if (!mask_bit(node + NODE_MASKS + children / 8, number))
            return NULL;
        node += word64(entry);
    }
    return node;
}

float nanovdb_value(const NanoVdb *grid, const int index[3])
{
    float value;
    const char *leaf = leaf_find(grid, index, &value);
    return leaf ? number32(leaf + LEAF_TABLE + 4 * (size_t)child_number(index, 0, 3)) : value;
}

bool nanovdb_empty(const NanoVdb *grid, const int low[3], const int high[3])
{
    int index[3];
    for (index[0] = low[0] & ~7; index[0] <= high[0]; index[0] += 8)
        for (index[1] = low[1] & ~7; index[1] <= high[1]; index[1] += 8)
            for (index[2] = low[2] & ~7; index[2] <= high[2]; index[2] += 8) {
                float value;
                if (leaf_find(grid, index, &value) || value != 0.0f)
                    return false;
            }
    return true;
}

/* ---- the file ---------------------------------------------------------------------------------------------------- */

static bool damaged(const char *path, Error *error)
{
    error_set(error, "%s is damaged or incomplete", path);
    return error_fix(error, "copy or make the file again");
}

static bool header_check(const char *header, const char *path, Error *error)
{
    uint version = word32(header + 8) >> 21;
    if (word64(header) != FILE_MAGIC) {
        error_set(error, "%s is not a NanoVDB file", path);
        return error_fix(error, "convert OpenVDB files by nanovdb_convert, of OpenVDB");
    }
    if (version != FILE_MAJOR) {
        error_set(error, "%s is of NanoVDB's version %u, not %u", path, version, FILE_MAJOR);
        return error_fix(error, "make it by nanovdb_convert of OpenVDB 9 or 10");
    }
    if ((word32(header + 12) >> 16) <= CODEC_ZIP)
        return true;
    error_set(error, "%s is compressed by Blosc", path);
    return error_fix(error, "compress it by zip, or not at all (nanovdb_convert --zip)");
}

/* Appends the grid's bytes, which are `stored` bytes at `data`. */
static bool grid_unpack(const char *data, size_t stored, size_t size, bool zip, NanoVdb *grid, Error *error)
{
    if (zip)
        return stored >= 8 && word64(data) <= stored - 8 && size / 1040 <= stored &&
               zlib_inflate(data + 8, word64(data), size, &grid->bytes, error) && grid->bytes.count == size;
    char *out = stored == size ? array_grow(&grid->bytes, size, error) : NULL;
    if (out)
        memcpy(out, data, size);
    return out != NULL;
}

static bool grid_check(const char *path, const char *name, NanoVdb *grid, Error *error)
{
    const char *data = grid->bytes.data;
    if (word32(data + GRID_TYPE) != GRID_TYPE_FLOAT) {
        error_set(error, "the grid \"%s\" of %s is not of 32-bit floats", name, path);
        return error_fix(error, "write it without quantization");
    }
    if (word32(data + GRID_CLASS) == GRID_CLASS_LEVEL_SET) {
        error_set(error, "the grid \"%s\" of %s is a level set, not a fog volume", name, path);
        return error_fix(error, "convert it to a fog volume");
    }
    grid->medium_from_index = matrix_identity();
    for (size_t i = 0; i < 3; ++i) {
        for (size_t k = 0; k < 3; ++k)
            grid->medium_from_index.m[4 * i + k] = number64(data + GRID_MAP + 8 * (3 * i + k));
        grid->medium_from_index.m[4 * i + 3] = number64(data + GRID_TRANSLATION + 8 * i);
    }
    return tree_open(grid) || damaged(path, error);
}

/* The grids of a segment that begins at *place, which becomes its end. names: receives those of all grids. */
static bool segment_read(const FileData *file, const char *path, const char *name, size_t *place, NanoVdb *grid,
                         bool *found, Error *error)
{
    const char *header = file->data + *place;
    if (file->size - *place < HEADER_BYTES)
        return damaged(path, error);
    if (!header_check(header, path, error))
        return false;
    uint count = word32(header + 12) & 0xffffu;
    size_t meta = *place + HEADER_BYTES, data = meta;
    for (uint i = 0; i < count; ++i) {
        if (data > file->size || file->size - data < META_BYTES)
            return damaged(path, error);
        data += META_BYTES + (size_t)word32(file->data + data + META_NAME_SIZE);
    }
    for (uint i = 0; i < count; ++i) {
        const char *entry = file->data + meta, *called = entry + META_BYTES;
        size_t name_size = word32(entry + META_NAME_SIZE);
        uint64_t size = word64(entry), stored = word64(entry + 8);
        if (data > file->size || stored > file->size - data || name_size == 0 || called[name_size - 1] != '\0' ||
            size < GRID_BYTES + ROOT_BYTES || size > FILE_BYTES_MAX)
            return damaged(path, error);
        *found = strcmp(called, name) == 0;
        if (*found)
            return (grid_unpack(file->data + data, stored, size, (word32(header + 12) >> 16) == CODEC_ZIP, grid,
                                error) ||
                    (!error_is_memory(error) && damaged(path, error))) &&
                   grid_check(path, name, grid, error);
        meta += META_BYTES + name_size;
        data += stored;
    }
    *place = data;
    return true;
}

bool nanovdb_read(const char *path, const char *name, NanoVdb *grid, bool *found, Error *error)
{
    FileData file;
    size_t place = 0;
    bool good = true;
    *grid = (NanoVdb){.tiles = 0};
    *found = false;
    array_init(&grid->bytes, 1);
    if (!file_read(path, FILE_BYTES_MAX, (SourcePlace){0}, &file, error))
        return false;
    do
        good = segment_read(&file, path, name, &place, grid, found, error);
    while (good && !*found && place < file.size);
    free(file.data);
    if (!good || !*found)
        nanovdb_destroy(grid);
    return good;
}

void nanovdb_destroy(NanoVdb *grid)
{
    array_destroy(&grid->bytes);
}
