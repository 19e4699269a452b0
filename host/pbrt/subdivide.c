#include "pbrt/subdivide.h"

#include "pbrt/subdivide_level.h"

#include <stdlib.h>
#include <string.h>

static void level_destroy(Level *level)
{
    free(level->faces);
    free(level->vertices);
    *level = (Level){0};
}

static bool level_allocate(Level *level, size_t faces, size_t vertices, Error *error)
{
    *level = (Level){.face_count = faces, .vertex_count = vertices};
    level->faces = calloc(faces + 1, sizeof *level->faces);
    level->vertices = calloc(vertices + 1, sizeof *level->vertices);
    if (level->faces && level->vertices)
        return true;
    error_memory(error, faces * sizeof(Face), "a subdivision surface");
    return false;
}

/* ---- the control mesh -------------------------------------------------------------------------------------------- */

typedef struct Edge {
    uint low, high; /* vertices */
    uint face, corner; /* goes from this corner of the face to the next */
} Edge;

static int edge_compare(const void *a, const void *b)
{
    const Edge *e = a, *f = b;
    if (e->low != f->low)
        return e->low < f->low ? -1 : 1;
    if (e->high != f->high)
        return e->high < f->high ? -1 : 1;
    return e->face < f->face ? -1 : e->face > f->face;
}

/* Connects the faces of two edges with the same ends. */
static bool edges_join(Level *level, const Edge *a, const Edge *b, Error *error)
{
    Face *f = &level->faces[a->face], *g = &level->faces[b->face];
    if (f->v[a->corner] == g->v[b->corner]) {
        error_set(error, "triangles %u and %u have different orientations", a->face, b->face);
        return error_fix(error, "make all triangles of a subdivision surface go around the same way");
    }
    f->across[a->corner] = b->face;
    g->across[b->corner] = a->face;
    return true;
}

static bool faces_connect(Level *level, Edge *edges, Error *error)
{
    size_t count = 3 * level->face_count;
    for (size_t i = 0; i < count; ++i) {
        const Face *face = &level->faces[i / 3];
        uint corner = (uint)(i % 3), a = face->v[corner], b = face->v[next_corner(corner)];
        edges[i] = (Edge){a < b ? a : b, a < b ? b : a, (uint)(i / 3), corner};
    }
    qsort(edges, count, sizeof *edges, edge_compare);
    for (size_t i = 0; i + 1 < count; ++i) {
        if (edges[i].low != edges[i + 1].low || edges[i].high != edges[i + 1].high)
            continue;
        if (i + 2 < count && edges[i].low == edges[i + 2].low && edges[i].high == edges[i + 2].high) {
            error_set(error, "the edge between vertices %u and %u has more than two triangles", edges[i].low,
                      edges[i].high);
            return error_fix(error, "divide the surface into several shapes");
        }
        if (!edges_join(level, &edges[i], &edges[i + 1], error))
            return false;
        ++i;
    }
    return true;
}

/* Whether the fan of a vertex has an end. */
static bool vertex_on_boundary(const Level *level, uint v)
{
    uint first = level->vertices[v].face, f = first;
    if (first == NONE)
        return false;
    do {
        const Face *face = &level->faces[f];
        f = face->across[corner_of(face, v)];
    } while (f != NONE && f != first);
    return f == NONE;
}

static bool control_make(const float *positions, const uint *indices, Level *level, Error *error)
{
    for (size_t v = 0; v < level->vertex_count; ++v) {
        memcpy(level->vertices[v].p, positions + 3 * v, 3 * sizeof *positions);
        level->vertices[v].face = NONE;
    }
    for (size_t i = 0; i < level->face_count; ++i) {
        Face *face = &level->faces[i];
        for (uint k = 0; k < 3; ++k) {
            face->v[k] = indices[3 * i + k];
            face->across[k] = NONE;
            level->vertices[face->v[k]].face = (uint)i;
        }
        if (face->v[0] == face->v[1] || face->v[1] == face->v[2] || face->v[2] == face->v[0]) {
            error_set(error, "triangle %zu uses a vertex twice", i);
            return error_fix(error, "remove it from the subdivision surface");
        }
    }
    Edge *edges = malloc((3 * level->face_count + 1) * sizeof *edges);
    if (!edges)
        return error_memory(error, 3 * level->face_count * sizeof *edges, "a subdivision surface");
    bool good = faces_connect(level, edges, error);
    free(edges);
    for (size_t v = 0; good && v < level->vertex_count; ++v)
        level->vertices[v].boundary = vertex_on_boundary(level, (uint)v);
    return good;
}

/* ---- one level --------------------------------------------------------------------------------------------------- */

/* Numbers the new vertex of every edge, edge_vertex[3 f + k]; returns how many vertices there are with them. */
static size_t edges_number(const Level *from, uint *edge_vertex)
{
    size_t count = from->vertex_count;
    for (size_t f = 0; f < from->face_count; ++f)
        for (uint k = 0; k < 3; ++k) {
            uint other = from->faces[f].across[k];
            if (other < f) /* NONE is larger than any face */
                edge_vertex[3 * f + k] =
                    edge_vertex[3 * (size_t)other + corner_of(&from->faces[other], from->faces[f].v[next_corner(k)])];
            else
                edge_vertex[3 * f + k] = (uint)count++;
        }
    return count;
}

/* The new vertex of the edge from corner k of a face. */
static void edge_vertex_set(const Level *from, size_t f, uint k, Vertex *out)
{
    const Face *face = &from->faces[f];
    uint other = face->across[k];
    const float *a = from->vertices[face->v[k]].p, *b = from->vertices[face->v[next_corner(k)]].p;
    out->boundary = other == NONE;
    out->face = (uint)(4 * f + 3);
    for (int i = 0; i < 3; ++i)
        out->p[i] = (float)(0.5 * ((double)a[i] + (double)b[i]));
    if (other == NONE)
        return;
    const Face *across = &from->faces[other];
    uint opposite = across->v[previous_corner(corner_of(across, face->v[next_corner(k)]))];
    const float *c = from->vertices[face->v[previous_corner(k)]].p, *d = from->vertices[opposite].p;
    for (int i = 0; i < 3; ++i)
        out->p[i] = (float)(0.375 * ((double)a[i] + (double)b[i]) + 0.125 * ((double)c[i] + (double)d[i]));
}

/* The child of face `f` at vertex v; NONE for no face. */
static uint child_at(const Level *from, uint f, uint v)
{
    return f == NONE ? NONE : 4 * f + corner_of(&from->faces[f], v);
}

/* Children k < 3 lie at the corners of their face, child 3 in the middle. */
static void face_divide(const Level *from, size_t f, const uint *edge_vertex, Face *children)
{
    const Face *face = &from->faces[f];
    uint first = (uint)(4 * f);
    for (uint k = 0; k < 3; ++k) {
        uint next = next_corner(k), previous = previous_corner(k);
        children[k].v[k] = face->v[k];
        children[k].v[next] = edge_vertex[3 * f + k];
        children[k].v[previous] = edge_vertex[3 * f + previous];
        children[k].across[k] = child_at(from, face->across[k], face->v[k]);
        children[k].across[next] = first + 3;
        children[k].across[previous] = child_at(from, face->across[previous], face->v[k]);
        children[3].v[k] = edge_vertex[3 * f + k];
        children[3].across[k] = first + next;
    }
}

static bool level_divide(const Level *from, Level *to, Error *error)
{
    uint *edge_vertex = malloc((3 * from->face_count + 1) * sizeof *edge_vertex);
    Array ring;
    if (!edge_vertex)
        return error_memory(error, 3 * from->face_count * sizeof *edge_vertex, "a subdivision surface");
    array_init(&ring, sizeof(uint));
    bool good = level_allocate(to, 4 * from->face_count, edges_number(from, edge_vertex), error);
    for (size_t v = 0; good && v < from->vertex_count; ++v) {
        const Vertex *old = &from->vertices[v];
        good = ring_collect(from, (uint)v, &ring, error);
        to->vertices[v] = *old;
        if (old->face == NONE || !good)
            continue;
        to->vertices[v].face = child_at(from, old->face, (uint)v);
        ring_blend(from, (uint)v, &ring, loop_weight(ring.count), 0.125, to->vertices[v].p);
    }
    for (size_t f = 0; good && f < from->face_count; ++f) {
        face_divide(from, f, edge_vertex, to->faces + 4 * f);
        for (uint k = 0; k < 3; ++k)
            if (!(from->faces[f].across[k] < f))
                edge_vertex_set(from, f, k, &to->vertices[edge_vertex[3 * f + k]]);
    }
    array_destroy(&ring);
    free(edge_vertex);
    return good;
}

/* ---- all levels --------------------------------------------------------------------------------------------------- */

static bool result_allocate(const Level *level, SubdividedMesh *out, Error *error)
{
    out->vertex_count = level->vertex_count;
    out->triangle_count = level->face_count;
    out->positions = calloc(3 * level->vertex_count + 1, sizeof *out->positions);
    out->normals = calloc(3 * level->vertex_count + 1, sizeof *out->normals);
    out->indices = calloc(3 * level->face_count + 1, sizeof *out->indices);
    return (out->positions && out->normals && out->indices) ||
           error_memory(error, 3 * level->vertex_count * sizeof *out->positions, "a subdivision surface");
}

/* Whether `levels` fit; an error if not. */
static bool levels_fit(size_t triangle_count, unsigned levels, Error *error)
{
    size_t most = SUBDIVIDE_TRIANGLES_MAX;
    unsigned fit = 0;
    while (triangle_count <= most / 4 && fit < levels) {
        most /= 4;
        ++fit;
    }
    if (fit == levels && triangle_count <= SUBDIVIDE_TRIANGLES_MAX)
        return true;
    error_set(error, "%u levels of subdivision would make more than %zu triangles", levels, SUBDIVIDE_TRIANGLES_MAX);
    return error_fix(error, "use at most %u levels", fit);
}

bool subdivide_loop(const float *positions, size_t vertex_count, const uint *indices, size_t triangle_count,
                    unsigned levels, SubdividedMesh *out, Error *error)
{
    Level level = {0};
    *out = (SubdividedMesh){0};
    bool good = levels_fit(triangle_count, levels, error) &&
                level_allocate(&level, triangle_count, vertex_count, error) &&
                control_make(positions, indices, &level, error);
    for (unsigned i = 0; good && i < levels; ++i) {
        Level finer = {0};
        good = level_divide(&level, &finer, error);
        level_destroy(&level);
        level = finer;
    }
    good = good && result_allocate(&level, out, error) && limit_take(&level, out->positions, out->normals, error);
    for (size_t i = 0; good && i < 3 * level.face_count; ++i)
        out->indices[i] = level.faces[i / 3].v[i % 3];
    level_destroy(&level);
    if (!good)
        subdivided_destroy(out);
    return good;
}

void subdivided_destroy(SubdividedMesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->indices);
    *mesh = (SubdividedMesh){0};
}
