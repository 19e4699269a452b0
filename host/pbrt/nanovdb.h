/* NanoVDB files: sparse grids of floats.
 *
 * The format, as of version 32: segments of a header (16 bytes: magic number, version, number of grids, codec) with,
 * for each of its grids, metadata (176 bytes and a name) and then the grid itself, as it is in memory or compressed. A
 * grid is a tree: a root with a table of 32-byte tiles, upper nodes of 32^3 children, lower nodes of 16^3, and leaves
 * of 8^3 floats; what is not in a leaf has the value of a tile. */
#ifndef TWINLIGHT_PBRT_NANOVDB_H
#define TWINLIGHT_PBRT_NANOVDB_H

#include "base/array.h"
#include "base/matrix.h"

typedef struct NanoVdb {
    Array bytes; /* char: the grid */
    int low[3], high[3]; /* of the active values' indices, both included */
    Matrix medium_from_index;
    size_t root; /* place of the tree's root in `bytes` */
    uint tiles; /* of the root */
    float background;
} NanoVdb;

/* Reads the grid of that name, whose values must be floats and no distances to a surface. *found: there is one; else
 * nothing is to be destroyed. Uncompressed files and those compressed by zlib. Errors name the file but no place. */
bool nanovdb_read(const char *path, const char *name, NanoVdb *grid, bool *found, Error *error);
void nanovdb_destroy(NanoVdb *grid);

float nanovdb_value(const NanoVdb *grid, const int index[3]);

/* Whether all values from `low` to `high`, both included, are known to be 0 without a look into leaves. */
bool nanovdb_empty(const NanoVdb *grid, const int low[3], const int high[3]);

#endif
