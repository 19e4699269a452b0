/* Meshes that nodes pose: a copy of its own for each such node. */
#include "gltf/document.h"

#include <stdlib.h>
#include <string.h>

static bool node_poses(GltfReader *reader, const Gltf *gltf, size_t i)
{
    const GltfNode *node = &gltf->nodes[i];
    if (!node->used || node->mesh < 0)
        return false;
    return node->skin >= 0 || json_object_get(gltf_entry(reader, "nodes", i).json, "weights") != NULL;
}

/* Replaces an array by a longer one. */
static bool array_lengthen(GltfReader *reader, void **array, size_t count, size_t added, size_t size)
{
    void *longer = NULL;
    if (!gltf_allocate(reader, &longer, count + added, size))
        return false;
    if (count > 0)
        memcpy(longer, *array, count * size);
    free(*array);
    *array = longer;
    return true;
}

static bool meshes_lengthen(Gltf *gltf, GltfReader *reader, size_t meshes, size_t primitives)
{
    void *all = gltf->meshes;
    if (!array_lengthen(reader, &all, gltf->mesh_count, meshes, sizeof *gltf->meshes))
        return false;
    gltf->meshes = all;
    all = gltf->primitives;
    if (!array_lengthen(reader, &all, gltf->primitive_count, primitives, sizeof *gltf->primitives))
        return false;
    gltf->primitives = all;
    return true;
}

/* Gives node i a copy of its mesh; there is room for it. */
static void mesh_copy_for(Gltf *gltf, size_t i)
{
    GltfNode *node = &gltf->nodes[i];
    GltfMesh *from = &gltf->meshes[node->mesh], *mesh = &gltf->meshes[gltf->mesh_count];
    *mesh = *from;
    mesh->first_primitive = gltf->primitive_count;
    mesh->uses = 1;
    mesh->pose = (int)i;
    --from->uses;
    for (size_t k = 0; k < mesh->primitive_count; ++k) {
        GltfPrimitive *primitive = &gltf->primitives[gltf->primitive_count++];
        *primitive = gltf->primitives[from->first_primitive + k];
        primitive->mesh = gltf->mesh_count;
    }
    node->mesh = (int)gltf->mesh_count++;
}

bool gltf_poses_make(Gltf *gltf, GltfReader *reader)
{
    size_t meshes = 0, primitives = 0;
    for (size_t i = 0; i < gltf->node_count && !reader->failed; ++i)
        if (node_poses(reader, gltf, i)) {
            ++meshes;
            primitives += gltf->meshes[gltf->nodes[i].mesh].primitive_count;
        }
    if (meshes == 0 || reader->failed)
        return !reader->failed;
    if (!meshes_lengthen(gltf, reader, meshes, primitives))
        return false;
    for (size_t i = 0; i < gltf->node_count; ++i)
        if (node_poses(reader, gltf, i))
            mesh_copy_for(gltf, i);
    return true;
}
