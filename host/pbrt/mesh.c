#include "pbrt/mesh.h"

#include "base/log.h"
#include "pbrt/errors.h"
#include "pbrt/ply.h"
#include "pbrt/subdivide.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Vertices and indices as given in the parameters. */
typedef struct MeshParams {
    const float *positions, *normals, *uvs;
    const int *indices;
    size_t vertex_count, index_count;
} MeshParams;

/* Reads an array that must have one item per vertex. */
static const float *per_vertex(ParamList *list, const char *name, ParamType type, size_t per_item, size_t vertex_count)
{
    size_t count;
    const float *values = param_floats(list, name, type, &count);
    if (values && count != per_item * vertex_count)
        param_error(list, name, "\"%s\" has %zu values for %zu vertices", name, count / per_item, vertex_count);
    return values;
}

static void params_read(ParamList *list, MeshParams *mesh)
{
    size_t count;
    mesh->positions = param_floats(list, "P", PARAM_POINT3, &count);
    mesh->vertex_count = count / 3;
    if (!mesh->positions)
        param_error(list, "P", "%s lacks \"point3 P\", its vertices", list->owner);
    mesh->normals = per_vertex(list, "N", PARAM_NORMAL, 3, mesh->vertex_count);
    mesh->uvs = per_vertex(list, "uv", PARAM_POINT2, 2, mesh->vertex_count);
    mesh->indices = param_integers(list, "indices", &mesh->index_count);
    param_ignore(list, "faceIndices");
}

/* Reads and checks the indices, `corners` per face; by default a single face of all vertices, if their number fits. */
static uint *indices_make(ParamList *list, MeshParams *mesh, size_t corners)
{
    bool given = mesh->indices != NULL;
    if (!given && mesh->vertex_count == corners)
        mesh->index_count = corners;
    else if (!given)
        param_error(list, "indices", "%s lacks \"integer indices\"", list->owner);
    else if (mesh->index_count % corners != 0)
        param_error(list, "indices", "the number of indices, %zu, is not a multiple of %zu", mesh->index_count,
                    corners);
    for (size_t i = 0; given && !list->failed && i < mesh->index_count; ++i)
        if (mesh->indices[i] < 0 || (size_t)mesh->indices[i] >= mesh->vertex_count)
            param_error(list, "indices", "vertex index %d is out of range: there are %zu vertices", mesh->indices[i],
                        mesh->vertex_count);
    uint *indices = list->failed ? NULL : calloc(mesh->index_count + 1, sizeof *indices);
    if (!indices && !list->failed)
        list->failed = !error_memory(list->error, mesh->index_count * sizeof *indices, "a mesh");
    for (size_t i = 0; indices && i < mesh->index_count; ++i)
        indices[i] = given ? (uint)mesh->indices[i] : (uint)i;
    return indices;
}

static float *floats_copy(const float *values, size_t count, Error *error)
{
    float *copy = malloc(count * sizeof *copy);
    if (!copy) {
        error_memory(error, count * sizeof *copy, "a mesh");
        return NULL;
    }
    return memcpy(copy, values, count * sizeof *copy);
}

static bool singular_refuse(PbrtImport *im)
{
    error_at(im->error, im->place, "the current transform cannot be inverted, and the mesh has normals");
    return error_fix(im->error, "look for a Scale by 0, or leave the normals out");
}

static bool params_add(PbrtImport *im, const ShapeContext *context, uint kind, const MeshParams *params,
                       const uint *indices)
{
    if (params->normals && !context->has_inverse)
        return singular_refuse(im);
    size_t floats = 3 * params->vertex_count;
    float *positions = floats_copy(params->positions, floats, im->error);
    float *normals = positions && params->normals ? floats_copy(params->normals, floats, im->error) : NULL;
    MeshData mesh = {.uvs = params->uvs,
                     .vertex_count = params->vertex_count,
                     .indices = indices,
                     .triangle_count = params->index_count / (kind == PRIMITIVE_TRIANGLE ? 3 : 4)};
    bool good =
        positions && (normals || !params->normals) && shape_add_mesh(im, context, kind, positions, normals, &mesh);
    free(positions);
    free(normals);
    return good;
}

/* Reads trianglemesh and bilinearmesh. */
static bool params_mesh_read(PbrtImport *im, ParamList *list, const ShapeContext *context, uint kind)
{
    MeshParams params = {0};
    params_read(list, &params);
    if (kind == PRIMITIVE_TRIANGLE) {
        const Param *tangents = param_ignore(list, "S");
        if (tangents)
            log_message_at(LOG_INFO, tangents->place, "the tangents \"S\" are not used");
    } else if (param_string(list, "emissionfilename", NULL)) {
        if (!import_unsupported(im, param_place(list, "emissionfilename"), "an image of emission", "constant emission",
                                NULL))
            return false;
    }
    uint *indices = indices_make(list, &params, kind == PRIMITIVE_TRIANGLE ? 3 : 4);
    bool good = param_list_finish(list, im->options.lenient) && params_add(im, context, kind, &params, indices);
    free(indices);
    return good;
}

static bool subdivided_add(PbrtImport *im, const ShapeContext *context, const MeshParams *params, const uint *indices,
                           unsigned levels)
{
    SubdividedMesh surface;
    Error error = {0};
    if (!context->has_inverse)
        return singular_refuse(im);
    if (!subdivide_loop(params->positions, params->vertex_count, indices, params->index_count / 3, levels, &surface,
                        &error)) {
        if (error_is_memory(&error)) {
            *im->error = error;
            return false;
        }
        error_at(im->error, context->place, "%s", error_text(&error));
        return error_fix(im->error, "%s", error.fix);
    }
    MeshData mesh = {
        .vertex_count = surface.vertex_count, .indices = surface.indices, .triangle_count = surface.triangle_count};
    bool good = shape_add_mesh(im, context, PRIMITIVE_TRIANGLE, surface.positions, surface.normals, &mesh);
    subdivided_destroy(&surface);
    return good;
}

static bool loopsubdiv_read(PbrtImport *im, ParamList *list, const ShapeContext *context)
{
    MeshParams params = {0};
    int levels = param_integer(list, "levels", 3);
    size_t count;
    params.positions = param_floats(list, "P", PARAM_POINT3, &count);
    params.vertex_count = count / 3;
    params.indices = param_integers(list, "indices", &params.index_count);
    param_string(list, "scheme", "loop");
    if (!params.positions)
        param_error(list, "P", "%s lacks \"point3 P\", its vertices", list->owner);
    if (levels < 0)
        param_error(list, "levels", "\"levels\" is negative");
    uint *indices = indices_make(list, &params, 3);
    bool good =
        param_list_finish(list, im->options.lenient) && subdivided_add(im, context, &params, indices, (unsigned)levels);
    free(indices);
    return good;
}

static bool small_faces_report(PbrtImport *im, SourcePlace place, const PlyMesh *ply)
{
    char what[96];
    if (ply->small_count == 0)
        return true;
    snprintf(what, sizeof what, "a PLY face with fewer than 3 vertices (there are %zu)", ply->small_count);
    return import_unsupported(im, place, what, "these faces are left out", "remove them from the mesh");
}

/* Triangles and bilinear patches of a file become two shapes, as in pbrt. The vertices of a quad go around the face;
 * those of a patch are (0,0) (1,0) (0,1) (1,1). */
static bool ply_add(PbrtImport *im, const ShapeContext *context, PlyMesh *ply)
{
    MeshData mesh = {.uvs = ply->uvs, .vertex_count = ply->vertex_count};
    if (ply->normals && !context->has_inverse)
        return singular_refuse(im);
    if (ply->quad_count > 0) {
        size_t floats = 3 * ply->vertex_count;
        float *positions = floats_copy(ply->positions, floats, im->error);
        float *normals = positions && ply->normals ? floats_copy(ply->normals, floats, im->error) : NULL;
        for (size_t i = 0; i < ply->quad_count; ++i) {
            uint swap = ply->quads[4 * i + 2];
            ply->quads[4 * i + 2] = ply->quads[4 * i + 3];
            ply->quads[4 * i + 3] = swap;
        }
        mesh.indices = ply->quads;
        mesh.triangle_count = ply->quad_count;
        bool good = positions && (normals || !ply->normals) &&
                    shape_add_mesh(im, context, PRIMITIVE_BILINEAR, positions, normals, &mesh);
        free(positions);
        free(normals);
        if (!good)
            return false;
    }
    mesh.indices = ply->triangles;
    mesh.triangle_count = ply->triangle_count;
    return ply->triangle_count == 0 ||
           shape_add_mesh(im, context, PRIMITIVE_TRIANGLE, ply->positions, ply->normals, &mesh);
}

/* The mesh of that name: from memory or from a file. */
static bool ply_find(PbrtImport *im, const char *name, SourcePlace place, PlyMesh *ply)
{
    const ImportMemory *memory = im->options.memory;
    if (memory)
        return memory->mesh(memory->owner, name, ply, im->error);
    const char *path = import_path(im, name);
    return path && ply_read(path, place, ply, im->error);
}

static bool plymesh_read(PbrtImport *im, ParamList *list, const ShapeContext *context)
{
    const char *name = param_string(list, "filename", NULL);
    const Param *displacement = param_find(list, "displacement", PARAM_BIT(PARAM_TEXTURE));
    param_float(list, "edgelength", 1.0f);
    if (!name)
        param_error(list, "filename", "plymesh lacks \"string filename\"");
    if (!param_list_finish(list, im->options.lenient))
        return false;
    if (displacement && !import_unsupported(im, displacement->place, "displacement of a mesh", "the mesh as it is",
                                            "use the material's displacement, a bump map"))
        return false;
    if (im->options.needs)
        return true;
    SourcePlace place = param_place(list, "filename");
    PlyMesh ply = {0};
    bool good = ply_find(im, name, place, &ply) && small_faces_report(im, place, &ply) && ply_add(im, context, &ply);
    ply_destroy(&ply);
    return good;
}

bool mesh_read(PbrtImport *im, const char *kind, ParamList *list, const ShapeContext *context)
{
    if (strcmp(kind, "plymesh") == 0)
        return plymesh_read(im, list, context);
    if (strcmp(kind, "loopsubdiv") == 0)
        return loopsubdiv_read(im, list, context);
    return params_mesh_read(im, list, context,
                            strcmp(kind, "trianglemesh") == 0 ? PRIMITIVE_TRIANGLE : PRIMITIVE_BILINEAR);
}
