/* Reads meshes from PLY files: ascii, binary of either byte order, gzip-compressed or not. */
#ifndef TWINLIGHT_PBRT_PLY_H
#define TWINLIGHT_PBRT_PLY_H

#include "base/error.h"
#include "math/platform.h"

typedef struct PlyMesh {
    size_t vertex_count, triangle_count, quad_count;
    float *positions; /* 3 per vertex */
    float *normals; /* 3 per vertex, or NULL */
    float *uvs; /* 2 per vertex, or NULL */
    uint *triangles; /* 3 indices each, all below vertex_count; those of polygons come last */
    uint *quads; /* 4 indices each, in the file's order, around the face */
    size_t small_count; /* number of faces with fewer than 3 vertices, which are left out */
} PlyMesh;

/* Reads element vertex (x y z, nx ny nz, u v | s t | texture_u texture_v | texture_s texture_t) and element face
 * (vertex_indices or vertex_index); everything else is skipped. Faces of more than 4 vertices are divided into
 * triangles (pbrt/polygon.h). Fails, naming the path at `place` (the parameter in the scene), if the file cannot be
 * read, is damaged or truncated, or an index is out of range. Memory is bounded by a multiple of the (decompressed)
 * file's size. */
bool ply_read(const char *path, SourcePlace place, PlyMesh *mesh, Error *error);

/* The same from memory, not compressed; `path` is for messages. */
bool ply_read_memory(const char *path, SourcePlace place, const char *data, size_t size, PlyMesh *mesh, Error *error);

/* Safe on {0} and twice. */
void ply_destroy(PlyMesh *mesh);

#endif
