/* A level of a subdivision surface, the vertices around a vertex of it, and the limit of all levels. */
#ifndef TWINLIGHT_PBRT_SUBDIVIDE_LEVEL_H
#define TWINLIGHT_PBRT_SUBDIVIDE_LEVEL_H

#include "base/array.h"
#include "math/platform.h"

/* A triangle: its vertices, and the neighbours across the edges from each vertex to the next; NONE at a boundary. */
typedef struct Face {
    uint v[3];
    uint across[3];
} Face;

typedef struct Vertex {
    float p[3];
    uint face; /* one of its triangles; NONE without */
    bool boundary;
} Vertex;

/* A mesh between two levels. */
typedef struct Level {
    Face *faces;
    Vertex *vertices;
    size_t face_count, vertex_count;
} Level;

static inline uint next_corner(uint k)
{
    return k == 2 ? 0 : k + 1;
}

static inline uint previous_corner(uint k)
{
    return k == 0 ? 2 : k - 1;
}

/* The corner of a face that is vertex v. */
static inline uint corner_of(const Face *face, uint v)
{
    return face->v[0] == v ? 0 : face->v[1] == v ? 1 : 2;
}

/* The vertices around v, in pbrt's order, from one end to the other at a boundary, appended to `ring` (uint), which is
 * emptied first. False when out of memory. */
bool ring_collect(const Level *level, uint v, Array *ring, Error *error);

/* (1 - n weight) p + weight times the sum of the n vertices around; of the two along the boundary for one on it. */
void ring_blend(const Level *level, uint v, const Array *ring, double inner, double outer, float out[3]);

/* Loop's weight of each vertex around one of valence n, by Warren's formula. */
double loop_weight(size_t n);

/* Moves the vertices to the limit, then takes normals from their new positions, as pbrt does: 3 values each per vertex.
 * False when out of memory. */
bool limit_take(Level *level, float *positions, float *normals, Error *error);

#endif
