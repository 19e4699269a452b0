/* Triangle meshes from PLY files: ascii, binary of either byte order, gzip'd or not. */
#ifndef TWINLIGHT_PBRT_PLY_H
#define TWINLIGHT_PBRT_PLY_H

#include "base/error.h"
#include "math/platform.h"

typedef struct PlyMesh {
    size_t vertex_count, triangle_count, quad_count;
    float *positions; /* 3 a vertex */
    float *normals; /* 3 a vertex, or NULL */
    float *uvs; /* 2 a vertex, or NULL */
    uint *triangles; /* 3 indices each, all below vertex_count */
    uint *quads; /* 4 indices each in the file's order, around the face */
    size_t polygon_count; /* faces with other than 3 or 4 vertices: left out */
} PlyMesh;

/* Reads element vertex (x y z, nx ny nz, u v | s t | texture_u texture_v | texture_s texture_t) and face
 * (vertex_indices or vertex_index); all else is skipped. Fails, naming the path at `place` (the scene's parameter),
 * when the file cannot be read, is damaged or truncated, or an index is out of range. Memory is bounded by a multiple
 * of the (inflated) file's size. */
bool ply_read(const char *path, SourcePlace place, PlyMesh *mesh, Error *error);

/* The same from memory, not gzip'd; `path` for messages. */
bool ply_read_memory(const char *path, SourcePlace place, const char *data, size_t size, PlyMesh *mesh, Error *error);

/* Safe on {0} and twice. */
void ply_destroy(PlyMesh *mesh);

#endif
