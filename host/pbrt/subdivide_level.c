#include "pbrt/subdivide_level.h"

#include "math/elementary.h"

#include <string.h>

/* ---- rings ------------------------------------------------------------------------------------------------------- */

bool ring_collect(const Level *level, uint v, Array *ring, Error *error)
{
    const Vertex *vertex = &level->vertices[v];
    uint f = vertex->face;
    ring->count = 0;
    if (f == NONE)
        return true;
    const Face *face = &level->faces[f];
    while (vertex->boundary && face->across[corner_of(face, v)] != NONE) {
        f = face->across[corner_of(face, v)];
        face = &level->faces[f];
    }
    uint first = f, *out;
    if (vertex->boundary) {
        if (!(out = array_grow(ring, 1, error)))
            return false;
        *out = face->v[next_corner(corner_of(face, v))];
    }
    do {
        face = &level->faces[f];
        uint corner = corner_of(face, v);
        if (!(out = array_grow(ring, 1, error)))
            return false;
        *out = face->v[vertex->boundary ? previous_corner(corner) : next_corner(corner)];
        f = face->across[vertex->boundary ? previous_corner(corner) : corner];
    } while (f != NONE && f != first);
    return true;
}

static const float *ring_point(const Level *level, const Array *ring, size_t k)
{
    return level->vertices[ARRAY_AT(ring, uint, k)].p;
}

void ring_blend(const Level *level, uint v, const Array *ring, double inner, double outer, float out[3])
{
    const Vertex *vertex = &level->vertices[v];
    size_t n = ring->count;
    for (int k = 0; k < 3; ++k) {
        double sum = 0.0;
        for (size_t i = 0; i < n; ++i)
            if (!vertex->boundary || i == 0 || i + 1 == n)
                sum += (double)ring_point(level, ring, i)[k];
        double weight = vertex->boundary ? outer : inner, count = vertex->boundary ? 2.0 : (double)n;
        out[k] = (float)((1.0 - count * weight) * (double)vertex->p[k] + weight * sum);
    }
}

double loop_weight(size_t n)
{
    return n == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * (double)n);
}

/* ---- the limit --------------------------------------------------------------------------------------------------- */

/* Adds weight times the k-th vertex around to a tangent. */
static void tangent_add(const Level *level, const Array *ring, size_t k, float weight, float tangent[3])
{
    for (int i = 0; i < 3; ++i)
        tangent[i] += weight * ring_point(level, ring, k)[i];
}

/* Tangents at an interior vertex: the first two harmonics of the vertices around it. */
static void tangents_inside(const Level *level, const Array *ring, float s[3], float t[3])
{
    for (size_t j = 0; j < ring->count; ++j) {
        float sine, cosine;
        float_sincos(2.0f * PI * (float)j / (float)ring->count, &sine, &cosine);
        tangent_add(level, ring, j, cosine, s);
        tangent_add(level, ring, j, sine, t);
    }
}

/* At the boundary: along it, and across it (Hoppe et al. 1994, "Piecewise Smooth Surface Reconstruction"). */
static void tangents_boundary(const Level *level, uint v, const Array *ring, float s[3], float t[3])
{
    size_t n = ring->count;
    float at = 0.0f;
    tangent_add(level, ring, n - 1, 1.0f, s);
    tangent_add(level, ring, 0, -1.0f, s);
    if (n == 2) {
        tangent_add(level, ring, 0, 1.0f, t);
        tangent_add(level, ring, 1, 1.0f, t);
        at = -2.0f;
    } else if (n == 3) {
        tangent_add(level, ring, 1, 1.0f, t);
        at = -1.0f;
    } else if (n == 4) {
        static const float WEIGHTS[4] = {-1.0f, 2.0f, 2.0f, -1.0f};
        for (size_t k = 0; k < 4; ++k)
            tangent_add(level, ring, k, WEIGHTS[k], t);
        at = -2.0f;
    } else {
        float theta = PI / (float)(n - 1), sine, cosine;
        float_sincos(theta, &sine, &cosine);
        tangent_add(level, ring, 0, -sine, t);
        tangent_add(level, ring, n - 1, -sine, t);
        for (size_t k = 1; k + 1 < n; ++k)
            tangent_add(level, ring, k, (2.0f - 2.0f * cosine) * float_sin((float)k * theta), t);
    }
    for (int i = 0; i < 3; ++i)
        t[i] += at * level->vertices[v].p[i];
}

static void normal_set(const Level *level, uint v, const Array *ring, float normal[3])
{
    float s[3] = {0.0f, 0.0f, 0.0f}, t[3] = {0.0f, 0.0f, 0.0f};
    if (ring->count < 2)
        return;
    if (level->vertices[v].boundary)
        tangents_boundary(level, v, ring, s, t);
    else
        tangents_inside(level, ring, s, t);
    for (int i = 0; i < 3; ++i)
        normal[i] = s[(i + 1) % 3] * t[(i + 2) % 3] - s[(i + 2) % 3] * t[(i + 1) % 3];
}

bool limit_take(Level *level, float *positions, float *normals, Error *error)
{
    Array ring;
    bool good = true;
    array_init(&ring, sizeof(uint));
    for (size_t v = 0; good && v < level->vertex_count; ++v) {
        good = ring_collect(level, (uint)v, &ring, error);
        double inner = ring.count > 0 ? 1.0 / ((double)ring.count + 3.0 / (8.0 * loop_weight(ring.count))) : 0.0;
        ring_blend(level, (uint)v, &ring, inner, ring.count > 0 ? 0.2 : 0.0, positions + 3 * v);
    }
    for (size_t v = 0; v < level->vertex_count; ++v)
        memcpy(level->vertices[v].p, positions + 3 * v, 3 * sizeof(float));
    for (size_t v = 0; good && v < level->vertex_count; ++v) {
        good = ring_collect(level, (uint)v, &ring, error);
        normal_set(level, (uint)v, &ring, normals + 3 * v);
    }
    array_destroy(&ring);
    return good;
}
