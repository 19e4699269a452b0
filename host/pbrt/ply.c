#include "pbrt/ply.h"

#include "base/array.h"
#include "base/file_read.h"
#include "base/gzip.h"
#include "pbrt/ply_values.h"
#include "pbrt/polygon.h"

#include <stdlib.h>
#include <string.h>

/* State of reading the body. */
typedef struct Cursor {
    const PlyHeader *header;
    PlyReader values;
    PlyMesh *mesh;
    Array triangles, quads; /* uint */
    Array polygons; /* uint: of each, the number of vertices and their indices */
} Cursor;

/* Reads the `count` indices of one face. */
static bool face_next(Cursor *c, PlyType type, uint64_t count)
{
    if (count < 3) {
        ++c->mesh->small_count;
        return ply_values_skip(&c->values, type, count);
    }
    size_t least = c->values.format == PLY_ASCII ? 2 : ply_type_size(type);
    if (count >= NONE || count > ((uint64_t)(c->values.end - c->values.p) + 1) / least)
        return ply_truncated(&c->values);
    Array *faces = count == 3 ? &c->triangles : count == 4 ? &c->quads : &c->polygons;
    uint *out = array_grow(faces, (size_t)count + (count > 4 ? 1 : 0), c->values.source->error);
    if (out && count > 4)
        *out++ = (uint)count;
    for (uint64_t i = 0; out && i < count; ++i) {
        uint64_t index = 0;
        if (!ply_integer_next(&c->values, type, &index))
            return false;
        out[i] = index < NONE ? (uint)index : NONE;
    }
    return out != NULL;
}

/* Destination of floats with this meaning: base + *stride * vertex. */
static float *meaning_target(PlyMesh *mesh, PlyMeaning meaning, size_t *stride)
{
    *stride = meaning >= PLY_U ? 2 : 3;
    if (meaning <= PLY_Z)
        return mesh->positions + (meaning - PLY_X);
    return meaning <= PLY_NZ ? mesh->normals + (meaning - PLY_NX) : mesh->uvs + (meaning - PLY_U);
}

static bool property_next(Cursor *c, const PlyProperty *property, size_t index)
{
    uint64_t count = 1;
    if (property->count_type != PLY_NONE) {
        if (!ply_integer_next(&c->values, property->count_type, &count))
            return false;
        if (property->meaning == PLY_INDICES)
            return face_next(c, property->type, count);
    }
    if (property->meaning == PLY_IGNORED)
        return ply_values_skip(&c->values, property->type, count);
    size_t stride;
    float *target = meaning_target(c->mesh, property->meaning, &stride);
    return ply_float_next(&c->values, property->type, &target[stride * index]);
}

/* Reads any element value by value. */
static bool element_walk(Cursor *c, const PlyElement *element)
{
    for (size_t i = 0; element->property_count > 0 && i < element->count; ++i)
        for (int k = 0; k < element->property_count; ++k)
            if (!property_next(c, &element->properties[k], i))
                return false;
    return true;
}

/* Least number of bytes that an element takes. */
static size_t element_least_bytes(const PlyHeader *header, const PlyElement *element)
{
    size_t bytes = 0;
    for (int k = 0; k < element->property_count; ++k) {
        const PlyProperty *property = &element->properties[k];
        PlyType type = property->count_type != PLY_NONE ? property->count_type : property->type;
        bytes += header->format == PLY_ASCII ? 2 : ply_type_size(type);
    }
    return bytes;
}

/* Checked before memory is allocated, so that a short file cannot ask for much. The last ascii value needs no
 * separator. */
static bool element_fits(const Cursor *c, const PlyElement *element)
{
    size_t least = element_least_bytes(c->header, element), left = (size_t)(c->values.end - c->values.p) + 1;
    return least == 0 || element->count <= left / least || ply_truncated(&c->values);
}

static bool has_meaning(const PlyElement *element, PlyMeaning meaning)
{
    for (int k = 0; k < element->property_count; ++k)
        if (element->properties[k].meaning == meaning)
            return true;
    return false;
}

static bool floats_take(float **out, size_t count, Error *error)
{
    *out = malloc(count * sizeof **out);
    return *out != NULL || error_memory(error, count * sizeof **out, "a PLY mesh");
}

/* Fast path for binary vertices with only scalar properties, whose values are at fixed offsets. */
static bool vertices_strided(Cursor *c, const PlyElement *element)
{
    size_t stride = element_least_bytes(c->header, element), offset = 0;
    bool little = c->values.format == PLY_LITTLE_ENDIAN;
    if (element->count > (size_t)(c->values.end - c->values.p) / stride)
        return ply_truncated(&c->values);
    for (int k = 0; k < element->property_count; ++k) {
        const PlyProperty *property = &element->properties[k];
        const char *from = c->values.p + offset;
        size_t step;
        offset += ply_type_size(property->type);
        if (property->meaning == PLY_IGNORED)
            continue;
        float *to = meaning_target(c->mesh, property->meaning, &step);
        if (property->type == PLY_FLOAT32 && little)
            for (size_t i = 0; i < element->count; ++i)
                to[step * i] = bits_float((uint)ply_bytes_integer(from + stride * i, 4, true));
        else
            for (size_t i = 0; i < element->count; ++i)
                to[step * i] = ply_float_decode(from + stride * i, property->type, little);
    }
    c->values.p += stride * element->count;
    return true;
}

static bool vertices_read(Cursor *c, const PlyElement *element)
{
    PlyMesh *mesh = c->mesh;
    Error *error = c->values.source->error;
    mesh->vertex_count = element->count;
    if (!floats_take(&mesh->positions, 3 * element->count, error) ||
        (has_meaning(element, PLY_NX) && !floats_take(&mesh->normals, 3 * element->count, error)) ||
        (has_meaning(element, PLY_U) && !floats_take(&mesh->uvs, 2 * element->count, error)))
        return false;
    bool lists = false;
    for (int k = 0; k < element->property_count; ++k)
        lists = lists || element->properties[k].count_type != PLY_NONE;
    return lists || c->values.format == PLY_ASCII ? element_walk(c, element) : vertices_strided(c, element);
}

/* Fast path for the usual face, a list of 32-bit indices after a count of one byte: reads triangles until another kind
 * of face; returns how many. */
static size_t triangles_packed(Cursor *c, size_t count)
{
    bool little = c->values.format == PLY_LITTLE_ENDIAN;
    size_t most = (size_t)(c->values.end - c->values.p) / 13, done = 0;
    most = most < count ? most : count;
    uint *out = array_grow(&c->triangles, 3 * most, c->values.source->error);
    for (; out && done < most && c->values.p[0] == 3; ++done, c->values.p += 13)
        for (size_t k = 0; k < 3; ++k) {
            uint index = (uint)ply_bytes_integer(c->values.p + 1 + 4 * k, 4, little);
            out[3 * done + k] = index;
        }
    c->triangles.count -= out ? 3 * (most - done) : 0;
    return done;
}

static bool faces_read(Cursor *c, const PlyElement *element)
{
    const PlyProperty *first = &element->properties[0];
    PlyElement rest = *element;
    if (c->values.format != PLY_ASCII && element->property_count == 1 && ply_type_size(first->count_type) == 1 &&
        ply_type_size(first->type) == 4)
        rest.count -= triangles_packed(c, element->count);
    return element_walk(c, &rest);
}

static bool indices_check(const Cursor *c, const uint *indices, size_t count)
{
    size_t vertex_count = c->mesh->vertex_count;
    for (size_t i = 0; i < count; ++i)
        if (indices[i] >= vertex_count)
            return ply_error(c->values.source, "vertex index %d is out of range: the file has %zu vertices",
                             (int)indices[i], vertex_count);
    return true;
}

/* Appends the triangles of a polygon. */
static bool polygon_add(Cursor *c, const uint *corner, size_t count, Array *scratch)
{
    scratch->count = 0;
    uint *out = array_grow(&c->triangles, 3 * (count - 2), c->values.source->error);
    uint *room = out ? array_grow(scratch, 3 * count, c->values.source->error) : NULL;
    if (!room)
        return false;
    if (polygon_triangulate(c->mesh->positions, corner, count, out, room))
        return true;
    return ply_error(c->values.source, "a face has %zu vertices and is not convex: at most %u can be triangulated",
                     count, POLYGON_CONCAVE_MAX);
}

/* Polygons wait until all vertices are known, since the element vertex may come last. */
static bool polygons_add(Cursor *c)
{
    Array scratch;
    bool good = true;
    array_init(&scratch, sizeof(uint));
    for (size_t i = 0, count; good && i < c->polygons.count; i += 1 + count) {
        const uint *face = &ARRAY_AT(&c->polygons, uint, i);
        count = face[0];
        good = indices_check(c, face + 1, count) && polygon_add(c, face + 1, count, &scratch);
    }
    array_destroy(&scratch);
    return good;
}

static bool body_read(Cursor *c)
{
    for (int i = 0; i < c->header->element_count; ++i) {
        const PlyElement *element = &c->header->elements[i];
        if (!element_fits(c, element))
            return false;
        bool good = element->kind == PLY_VERTEX ? vertices_read(c, element)
                    : element->kind == PLY_FACE ? faces_read(c, element)
                                                : element_walk(c, element);
        if (!good)
            return false;
    }
    return indices_check(c, c->triangles.data, c->triangles.count) && indices_check(c, c->quads.data, c->quads.count) &&
           polygons_add(c);
}

bool ply_read_memory(const char *path, SourcePlace place, const char *data, size_t size, PlyMesh *mesh, Error *error)
{
    PlySource source = {path, place, error};
    PlyHeader header;
    *mesh = (PlyMesh){0};
    if (!ply_header_read(&source, data, size, &header))
        return false;
    Cursor c = {.header = &header, .values = {&source, header.format, data + header.size, data + size}, .mesh = mesh};
    array_init(&c.triangles, sizeof(uint));
    array_init(&c.quads, sizeof(uint));
    array_init(&c.polygons, sizeof(uint));
    bool good = body_read(&c);
    array_destroy(&c.polygons);
    mesh->triangles = c.triangles.data;
    mesh->triangle_count = c.triangles.count / 3;
    mesh->quads = c.quads.data;
    mesh->quad_count = c.quads.count / 4;
    if (!good)
        ply_destroy(mesh);
    return good;
}

void ply_destroy(PlyMesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->triangles);
    free(mesh->quads);
    *mesh = (PlyMesh){0};
}

/* Limit of a file, compressed or not: four times 10^8 triangles at 13 bytes per face and 32 bytes per vertex, with one
 * vertex per two triangles. Deflate expands up to 1032-fold, so without a limit a small file could take all memory. */
#define PLY_BYTES_MAX ((size_t)12 << 30)

bool ply_read(const char *path, SourcePlace place, PlyMesh *mesh, Error *error)
{
    PlySource source = {path, place, error};
    FileData file;
    *mesh = (PlyMesh){0};
    if (!file_read(path, PLY_BYTES_MAX, place, &file, error))
        return false;
    bool gzip = gzip_is(file.data, file.size);
    Array inflated;
    Error reason = {{0}, {0}};
    array_init(&inflated, 1);
    bool good = !gzip || gzip_inflate(file.data, file.size, PLY_BYTES_MAX, &inflated, &reason);
    if (!good && error_is_memory(&reason))
        *error = reason;
    else if (!good)
        ply_error(&source, "%s", error_text(&reason));
    if (good)
        good = gzip ? ply_read_memory(path, place, inflated.data, inflated.count, mesh, error)
                    : ply_read_memory(path, place, file.data, file.size, mesh, error);
    array_destroy(&inflated);
    free(file.data);
    return good;
}
