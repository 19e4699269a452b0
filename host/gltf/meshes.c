#include "gltf/meshes.h"

#include "base/log.h"
#include "gltf/accessors.h"
#include "gltf/emission.h"
#include "gltf/memory_files.h"
#include "gltf/skin.h"
#include "gltf/uv_transform.h"

#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Vertices and joints of meshes that nodes pose, in all: each has its own, so that a small file could have many. */
#define POSED_MAX (1u << 28)

/* ---- the document for Assimp ------------------------------------------------------------------------------------- */

typedef struct Packing {
    Gltf *gltf;
    GltfReader *reader;
    char *document; /* JSON */
    size_t *primitives; /* the primitive of each of Assimp's meshes */
    size_t count;
    size_t posed; /* POSED_MAX */
} Packing;

/* Whether a material needs texture coordinates. */
static bool material_is_textured(const GltfMaterial *material)
{
    return material->base_texture.image >= 0 || material->metallic_roughness_texture.image >= 0 ||
           material->normal_texture.image >= 0 || material->emissive_texture.image >= 0 ||
           material->transmission_texture.image >= 0;
}

/* Adds attribute `from` as `to` if it is there. False if it has another number of elements than there are vertices. */
static bool attribute_add(Packing *packing, const GltfObject *attributes, const char *from, const char *to,
                          const char *type, size_t vertex_count, json_t *out)
{
    GltfReader *reader = packing->reader;
    int accessor = gltf_index(reader, attributes, from, "accessors");
    if (accessor < 0)
        return !reader->failed;
    size_t count = gltf_accessor_check(packing->gltf, reader, accessor, type, GLTF_COMPONENT(GLTF_FLOAT));
    if (!reader->failed && vertex_count > 0 && count != vertex_count)
        gltf_fail(reader, "%s.%s has %zu elements for %zu vertices", attributes->name, from, count, vertex_count);
    json_object_set_new(out, to, json_integer(accessor));
    return !reader->failed;
}

/* Sets how many triangles a primitive has. */
static void triangles_count(GltfReader *reader, const GltfObject *object, size_t corners, GltfPrimitive *primitive)
{
    bool separate = gltf_size(reader, object, "mode", GLTF_MODE_TRIANGLES) == GLTF_MODE_TRIANGLES;
    primitive->triangle_count = separate ? corners / 3 : corners < 3 ? 0 : corners - 2;
    if (!reader->failed && separate && corners % 3 != 0)
        gltf_fail(reader, "%s has %zu corners of triangles, not a multiple of 3", object->name, corners);
    if (!reader->failed && primitive->triangle_count == 0)
        log_message(LOG_WARNING, "%s: %s has no triangle and is left out", reader->path, object->name);
}

/* Number of vertices; 0: without triangles, to be left out. */
static size_t vertices_count(Packing *packing, const GltfObject *object, const GltfObject *attributes, int indices,
                             GltfPrimitive *primitive)
{
    GltfReader *reader = packing->reader;
    int positions = gltf_index(reader, attributes, "POSITION", "accessors");
    if (positions < 0)
        return 0;
    size_t count = gltf_accessor_check(packing->gltf, reader, positions, "VEC3", GLTF_COMPONENT(GLTF_FLOAT));
    if (reader->failed)
        return 0;
    triangles_count(reader, object, indices < 0 ? count : gltf_indices_check(packing->gltf, reader, indices, count),
                    primitive);
    return reader->failed || primitive->triangle_count == 0 ? 0 : count;
}

/* The attributes that are used, by the names that Assimp gets them by; NULL: without triangles, or after a failure. */
static json_t *attributes_make(Packing *packing, const GltfObject *object, GltfPrimitive *primitive, int indices,
                               size_t *vertex_count)
{
    GltfReader *reader = packing->reader;
    const GltfMaterial *material = &packing->gltf->materials[primitive->material];
    const GltfObject attributes = gltf_object(reader, object, "attributes");
    char set[16];
    size_t count = vertices_count(packing, object, &attributes, indices, primitive);
    *vertex_count = count;
    if (count == 0)
        return NULL;
    json_t *out = json_object();
    snprintf(set, sizeof set, "TEXCOORD_%d", material->uv_set);
    if (attribute_add(packing, &attributes, "POSITION", "POSITION", "VEC3", 0, out) &&
        attribute_add(packing, &attributes, "NORMAL", "NORMAL", "VEC3", count, out) && material_is_textured(material))
        attribute_add(packing, &attributes, set, "TEXCOORD_0", "VEC2", count, out);
    if (json_object_get(attributes.json, "COLOR_0"))
        log_message(LOG_WARNING, "%s: the vertex colours of %s are ignored", reader->path, object->name);
    return out;
}

/* The weights of a mesh's morph targets: those of the node that poses it, if it has any. */
static const json_t *weights_find(Packing *packing, const GltfMesh *mesh, size_t *count)
{
    GltfObject owner = gltf_entry(packing->reader, "meshes", mesh->number);
    if (mesh->pose >= 0) {
        const GltfObject node = gltf_entry(packing->reader, "nodes", (size_t)mesh->pose);
        owner = json_object_get(node.json, "weights") ? node : owner;
    }
    const json_t *weights = gltf_array(packing->reader, &owner, "weights", count);
    for (size_t i = 0; i < *count && !packing->reader->failed; ++i)
        if (!json_is_number(json_array_get(weights, i)))
            gltf_fail(packing->reader, "%s.weights[%zu] must be a number", owner.name, i);
    return weights;
}

/* Adds the morph targets whose weights are not 0 to a primitive, and these weights to its mesh. */
static void targets_pack(Packing *packing, const GltfMesh *mesh, const GltfObject *object, size_t vertex_count,
                         json_t *out_mesh, json_t *out)
{
    GltfReader *reader = packing->reader;
    size_t weight_count, count;
    const json_t *weights = weights_find(packing, mesh, &weight_count);
    const json_t *targets = gltf_array(reader, object, "targets", &count);
    json_t *out_weights = json_array(), *out_targets = json_array();
    for (size_t i = 0; i < count && i < weight_count && !reader->failed; ++i) {
        double weight = json_number_value(json_array_get(weights, i));
        GltfObject target = {json_array_get(targets, i), ""};
        snprintf(target.name, sizeof target.name, "%.120s.targets[%zu]", object->name, i);
        if (weight == 0.0)
            continue;
        json_t *attributes = json_object();
        if (attribute_add(packing, &target, "POSITION", "POSITION", "VEC3", vertex_count, attributes))
            attribute_add(packing, &target, "NORMAL", "NORMAL", "VEC3", vertex_count, attributes);
        json_array_append_new(out_targets, attributes);
        json_array_append_new(out_weights, json_real(weight));
    }
    json_object_set_new(out, "targets", out_targets);
    json_object_set_new(out_mesh, "weights", out_weights);
}

/* Counts what a mesh that a node poses takes. */
static void posed_count(Packing *packing, const GltfMesh *mesh, size_t vertex_count)
{
    if (mesh->pose < 0 || packing->reader->failed)
        return;
    packing->posed += vertex_count + gltf_skin_joints(packing->gltf, packing->reader, mesh);
    if (packing->posed <= POSED_MAX)
        return;
    gltf_fail(packing->reader, "the meshes that skins and weights of nodes pose have more than %u vertices and joints",
              POSED_MAX);
    error_fix(packing->reader->error, "let fewer nodes show them, or export them posed");
}

/* Adds a primitive to Assimp's document, as a mesh and a node of its own. */
static void primitive_pack(Packing *packing, size_t index, json_t *meshes, json_t *nodes, json_t *scene)
{
    GltfReader *reader = packing->reader;
    GltfPrimitive *primitive = &packing->gltf->primitives[index];
    const GltfMesh *mesh = &packing->gltf->meshes[primitive->mesh];
    const GltfObject object = gltf_primitive_object(reader, mesh->number, primitive->number);
    int indices = gltf_index(reader, &object, "indices", "accessors");
    size_t vertex_count;
    json_t *attributes = attributes_make(packing, &object, primitive, indices, &vertex_count);
    if (!attributes)
        return;
    json_t *out = json_pack("{s:o, s:I}", "attributes", attributes, "mode",
                            (json_int_t)gltf_size(reader, &object, "mode", GLTF_MODE_TRIANGLES));
    if (indices >= 0)
        json_object_set_new(out, "indices", json_integer(indices));
    json_t *out_mesh = json_object();
    posed_count(packing, mesh, vertex_count);
    targets_pack(packing, mesh, &object, vertex_count, out_mesh, out);
    json_object_set_new(out_mesh, "primitives", json_pack("[o]", out));
    json_array_append_new(meshes, out_mesh);
    json_array_append_new(nodes, json_pack("{s:I}", "mesh", (json_int_t)packing->count));
    json_array_append_new(scene, json_integer((json_int_t)packing->count));
    packing->primitives[packing->count++] = index;
}

/* Views reach to the end of their padded buffers; which bytes accessors may use has been checked. */
static json_t *views_make(Packing *packing)
{
    GltfReader *reader = packing->reader;
    size_t count = gltf_count(reader, "bufferViews");
    json_t *views = json_array();
    for (size_t i = 0; i < count && !reader->failed; ++i) {
        const GltfObject object = gltf_entry(reader, "bufferViews", i);
        int buffer = gltf_index(reader, &object, "buffer", "buffers");
        size_t offset = gltf_size(reader, &object, "byteOffset", 0),
               stride = gltf_size(reader, &object, "byteStride", 0);
        gltf_view(packing->gltf, reader, i);
        if (reader->failed)
            break;
        size_t length = packing->gltf->buffers[buffer].size + BUFFER_PADDING - offset;
        json_t *view = json_pack("{s:i, s:I, s:I}", "buffer", buffer, "byteOffset", (json_int_t)offset, "byteLength",
                                 (json_int_t)length);
        if (stride > 0)
            json_object_set_new(view, "byteStride", json_integer((json_int_t)stride));
        json_array_append_new(views, view);
    }
    return views;
}

static json_t *buffers_make(const Gltf *gltf)
{
    json_t *buffers = json_array();
    for (size_t i = 0; i < gltf->buffer_count; ++i) {
        char name[32];
        snprintf(name, sizeof name, "%zu.bin", i);
        json_array_append_new(buffers, json_pack("{s:s, s:I}", "uri", name, "byteLength",
                                                 (json_int_t)gltf->buffers[i].size + BUFFER_PADDING));
    }
    return buffers;
}

/* Makes the document; no mesh: packing->count is 0. */
static bool document_make(Packing *packing)
{
    Gltf *gltf = packing->gltf;
    GltfReader *reader = packing->reader;
    json_t *meshes = json_array(), *nodes = json_array(), *scene = json_array();
    json_t *accessors = json_deep_copy(json_object_get(gltf->root, "accessors"));
    for (size_t i = 0; i < gltf->primitive_count && !reader->failed; ++i)
        if (gltf->primitives[i].triangles && gltf->meshes[gltf->primitives[i].mesh].uses > 0)
            primitive_pack(packing, i, meshes, nodes, scene);
    json_t *root =
        json_pack("{s:{s:s}, s:i, s:[{s:o}], s:o, s:o, s:o, s:o, s:o}", "asset", "version", "2.0", "scene", 0, "scenes",
                  "nodes", scene, "nodes", nodes, "meshes", meshes, "accessors", accessors ? accessors : json_array(),
                  "bufferViews", views_make(packing), "buffers", buffers_make(gltf));
    packing->document = reader->failed ? NULL : json_dumps(root, JSON_COMPACT);
    json_decref(root);
    if (!packing->document && !reader->failed)
        reader->failed = !error_memory(reader->error, 0, "a glTF scene");
    return !reader->failed;
}

/* ---- what Assimp returns ----------------------------------------------------------------------------------------- */

static float *floats_allocate(size_t count)
{
    return malloc((count + 1) * sizeof(float));
}

/* Adds `weight` times what a morph target moves vectors by. */
static void vectors_morph(float *out, const struct aiVector3D *base, const struct aiVector3D *moved, size_t count,
                          float weight)
{
    for (size_t i = 0; out && moved && i < count; ++i) {
        out[3 * i] += weight * (moved[i].x - base[i].x);
        out[3 * i + 1] += weight * (moved[i].y - base[i].y);
        out[3 * i + 2] += weight * (moved[i].z - base[i].z);
    }
}

static float *vectors_copy(const struct aiVector3D *from, size_t count)
{
    float *out = from ? floats_allocate(3 * count) : NULL;
    for (size_t i = 0; out && i < count; ++i) {
        out[3 * i] = from[i].x;
        out[3 * i + 1] = from[i].y;
        out[3 * i + 2] = from[i].z;
    }
    return out;
}

/* Assimp has turned v around, as pbrt has it. */
static float *uvs_copy(const struct aiVector3D *from, size_t count, const UvTransform *bake)
{
    const UvTransform to = uv_of_pbrt(bake);
    bool same = uv_is_identity(bake);
    float *out = from ? floats_allocate(2 * count) : NULL;
    for (size_t i = 0; out && i < count; ++i) {
        double u = (double)from[i].x, v = (double)from[i].y;
        out[2 * i] = same ? from[i].x : (float)(to.m[0] * u + to.m[1] * v + to.m[2]);
        out[2 * i + 1] = same ? from[i].y : (float)(to.m[3] * u + to.m[4] * v + to.m[5]);
    }
    return out;
}

static bool floats_finite(const float *values, size_t count)
{
    for (size_t i = 0; values && i < count; ++i)
        if (!isfinite(values[i]))
            return false;
    return true;
}

static bool triangles_copy(GltfReader *reader, const char *name, const struct aiMesh *from, PlyMesh *mesh)
{
    for (size_t i = 0; i < from->mNumFaces; ++i) {
        const struct aiFace *face = &from->mFaces[i];
        for (unsigned k = 0; k < 3; ++k) {
            if (face->mNumIndices != 3 || face->mIndices[k] >= from->mNumVertices)
                return gltf_fail(reader, "%s has the vertex index %u, but there are %u vertices", name,
                                 face->mNumIndices == 3 ? face->mIndices[k] : 0u, from->mNumVertices);
            mesh->triangles[3 * i + k] = face->mIndices[k];
        }
    }
    mesh->triangle_count = from->mNumFaces;
    return true;
}

static bool mesh_copy(GltfReader *reader, const char *name, const struct aiMesh *from, const UvTransform *bake,
                      PlyMesh *mesh)
{
    size_t count = from->mNumVertices;
    *mesh = (PlyMesh){.vertex_count = count};
    mesh->positions = vectors_copy(from->mVertices, count);
    mesh->normals = vectors_copy(from->mNormals, count);
    for (unsigned k = 0; k < from->mNumAnimMeshes; ++k) {
        const struct aiAnimMesh *moved = from->mAnimMeshes[k];
        vectors_morph(mesh->positions, from->mVertices, moved->mVertices, count, moved->mWeight);
        vectors_morph(mesh->normals, from->mNormals, moved->mNormals, count, moved->mWeight);
    }
    mesh->uvs = uvs_copy(from->mTextureCoords[0], count, bake);
    mesh->triangles = malloc((3 * (size_t)from->mNumFaces + 1) * sizeof(uint));
    if (!mesh->positions || !mesh->triangles || (from->mNormals && !mesh->normals) ||
        (from->mTextureCoords[0] && !mesh->uvs)) {
        reader->failed = !error_memory(reader->error, 32 * count, "a mesh");
        return false;
    }
    return triangles_copy(reader, name, from, mesh);
}

static bool vertices_check(GltfReader *reader, const char *name, const PlyMesh *mesh)
{
    size_t count = mesh->vertex_count;
    if (floats_finite(mesh->positions, 3 * count) && floats_finite(mesh->normals, 3 * count) &&
        floats_finite(mesh->uvs, 2 * count))
        return true;
    gltf_fail(reader, "%s has vertices that are not finite", name);
    return error_fix(reader->error, "repair the mesh in the program that made it");
}

/* Adds the parts of one primitive. */
static bool primitive_unpack(Packing *packing, const struct aiMesh *from, size_t index)
{
    Gltf *gltf = packing->gltf;
    GltfReader *reader = packing->reader;
    GltfPrimitive *primitive = &gltf->primitives[index];
    GltfMaterial *material = &gltf->materials[primitive->material];
    char name[96];
    PlyMesh mesh = {0};
    snprintf(name, sizeof name, "meshes[%zu].primitives[%zu]", gltf->meshes[primitive->mesh].number, primitive->number);
    primitive->first_part = gltf->parts.count;
    bool good = mesh_copy(reader, name, from, &material->bake, &mesh) &&
                gltf_skin_apply(gltf, reader, primitive, &mesh) && vertices_check(reader, name, &mesh) &&
                gltf_emission_split(gltf, reader, material, &mesh);
    material->used = true;
    primitive->part_count = gltf->parts.count - primitive->first_part;
    ply_destroy(&mesh);
    return good;
}

static bool document_import(Packing *packing)
{
    GltfReader *reader = packing->reader;
    MemoryFiles files = {packing->document, packing->gltf->buffers, packing->gltf->buffer_count};
    struct aiFileIO io = memory_files_io(&files);
    const struct aiScene *scene = aiImportFileEx(DOCUMENT_NAME, 0, &io);
    if (!scene)
        return gltf_fail(reader, "Assimp cannot unpack the meshes: %.300s", aiGetErrorString());
    if (scene->mNumMeshes != packing->count)
        gltf_fail(reader, "Assimp unpacks %u meshes of %zu", scene->mNumMeshes, packing->count);
    for (size_t i = 0; i < packing->count && !reader->failed; ++i)
        primitive_unpack(packing, scene->mMeshes[i], packing->primitives[i]);
    aiReleaseImport(scene);
    return !reader->failed;
}

bool gltf_meshes_read(Gltf *gltf, GltfReader *reader)
{
    Packing packing = {.gltf = gltf, .reader = reader};
    void *primitives = NULL;
    array_init(&gltf->parts, sizeof(GltfPart));
    if (!gltf_allocate(reader, &primitives, gltf->primitive_count, sizeof *packing.primitives))
        return false;
    packing.primitives = primitives;
    bool good = document_make(&packing) && (packing.count == 0 || document_import(&packing));
    free(packing.document);
    free(packing.primitives);
    return good;
}
