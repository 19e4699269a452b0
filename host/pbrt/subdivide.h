/* Loop subdivision surfaces. */
#ifndef TWINLIGHT_PBRT_SUBDIVIDE_H
#define TWINLIGHT_PBRT_SUBDIVIDE_H

#include "base/error.h"
#include "math/platform.h"

#include <stddef.h>

/* A triangle mesh with a normal at each vertex, not of unit length; zero where the surface has none. */
typedef struct SubdividedMesh {
    float *positions, *normals; /* 3 per vertex */
    uint *indices; /* 3 per triangle */
    size_t vertex_count, triangle_count;
} SubdividedMesh;

/* Triangles after subdivision: about 1.5 GiB. */
#define SUBDIVIDE_TRIANGLES_MAX ((size_t)1 << 24)

/* Divides every triangle into four, `levels` times (Loop 1987, "Smooth Subdivision Surfaces Based on Triangles"), moves
 * the vertices to where they would be in the limit, and derives normals from the limit's tangents; boundaries become
 * curves of their own. The weights are those of pbrt. positions: 3 floats each of vertex_count; indices: 3 each of
 * triangle_count, below vertex_count. Vertices without a triangle are kept. Fails if an edge has more than two
 * triangles, or two that go along it in the same direction, if there would be more than SUBDIVIDE_TRIANGLES_MAX
 * triangles, or when out of memory; *out is then empty. */
bool subdivide_loop(const float *positions, size_t vertex_count, const uint *indices, size_t triangle_count,
                    unsigned levels, SubdividedMesh *out, Error *error);

/* Safe on {0} and twice. */
void subdivided_destroy(SubdividedMesh *mesh);

#endif
