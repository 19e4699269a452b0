/* Opening a glTF file, and adding it to a scene. */
#include "gltf/images.h"
#include "gltf/meshes.h"
#include "gltf/translate.h"
#include "pbrt/import.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool document_read(Gltf *gltf, GltfReader *reader)
{
    return gltf_container_read(gltf, reader) && gltf_extensions_check(gltf, reader) &&
           gltf_buffers_read(gltf, reader) && gltf_materials_read(gltf, reader) && gltf_primitives_read(gltf, reader) &&
           gltf_nodes_read(gltf, reader) && gltf_poses_make(gltf, reader) && gltf_meshes_read(gltf, reader);
}

Gltf *gltf_open(const char *path, Error *error)
{
    Gltf *gltf = calloc(1, sizeof *gltf);
    GltfReader reader = {.path = path, .error = error};
    if (!gltf) {
        error_memory(error, sizeof *gltf, "a glTF scene");
        return NULL;
    }
    gltf->path = path;
    array_init(&gltf->parts, sizeof(GltfPart));
    array_init(&gltf->derived, sizeof(DerivedImage));
    if (document_read(gltf, &reader))
        return gltf;
    gltf_close(gltf);
    return NULL;
}

void gltf_close(Gltf *gltf)
{
    if (!gltf)
        return;
    for (size_t i = 0; i < gltf->buffer_count; ++i)
        free(gltf->buffers[i].owned);
    for (size_t i = 0; i < gltf->parts.count; ++i)
        ply_destroy(&ARRAY_AT(&gltf->parts, GltfPart, i).mesh);
    array_destroy(&gltf->parts);
    array_destroy(&gltf->derived);
    free(gltf->file.owned);
    free(gltf->buffers);
    free(gltf->materials);
    free(gltf->meshes);
    free(gltf->primitives);
    free(gltf->nodes);
    free(gltf->cameras);
    free(gltf->lights);
    json_decref(gltf->root);
    free(gltf);
}

/* ---- import ------------------------------------------------------------------------------------------------------ */

/* The number N of a name "...-meshes/N.ply". */
static size_t name_number(const char *name)
{
    const char *slash = strrchr(name, '/');
    return strtoul(slash ? slash + 1 : name, NULL, 10);
}

static void *bytes_copy(const void *from, size_t size)
{
    void *copy = from ? malloc(size + 1) : NULL;
    return copy ? memcpy(copy, from, size) : NULL;
}

/* A copy of a part: the importer transforms it in place, and may read the scene twice. */
static bool memory_mesh(void *owner, const char *name, PlyMesh *mesh, Error *error)
{
    const Gltf *gltf = owner;
    const PlyMesh *from = &ARRAY_AT(&gltf->parts, GltfPart, name_number(name)).mesh;
    size_t vertex = sizeof(float) * from->vertex_count;
    *mesh = *from;
    mesh->positions = bytes_copy(from->positions, 3 * vertex);
    mesh->normals = bytes_copy(from->normals, 3 * vertex);
    mesh->uvs = bytes_copy(from->uvs, 2 * vertex);
    mesh->triangles = bytes_copy(from->triangles, 3 * sizeof(uint) * from->triangle_count);
    if (mesh->positions && mesh->triangles && (mesh->normals || !from->normals) && (mesh->uvs || !from->uvs))
        return true;
    ply_destroy(mesh);
    return error_memory(error, 8 * vertex, "a mesh");
}

static bool memory_image(void *owner, const char *name, Image *image, Error *error)
{
    Gltf *gltf = owner;
    return gltf_derived_make(gltf, &ARRAY_AT(&gltf->derived, DerivedImage, name_number(name)), image, error);
}

bool gltf_import(Gltf *gltf, const ImportOptions *options, Scene *scene, Error *error)
{
    GltfReader reader = {.path = gltf->path, .root = gltf->root, .error = error};
    const ImportMemory memory = {memory_mesh, memory_image, gltf};
    ImportOptions own = *options;
    char *text = NULL;
    size_t length = 0;
    Translation translation = {
        .gltf = gltf, .reader = &reader, .out = open_memstream(&text, &length), .prefix = "scene"};
    own.memory = &memory;
    if (!translation.out)
        return error_memory(error, 0, "a glTF scene");
    bool good = gltf_translate(&translation);
    bool written = !ferror(translation.out);
    written = fclose(translation.out) == 0 && written;
    if (good && !written)
        good = error_memory(error, length, "a glTF scene");
    good = good && (pbrt_import_text(text, length, NULL, "", &own, scene, error) || error_in(error, gltf->path));
    free(text);
    return good;
}
