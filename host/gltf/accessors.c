/* Checks of accessors, and of the primitives that use them. */
#include "base/log.h"
#include "gltf/accessors.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

size_t gltf_component_size(size_t type)
{
    return type == GLTF_UNSIGNED_BYTE ? 1 : type == GLTF_UNSIGNED_SHORT ? 2 : 4;
}

size_t gltf_type_width(const char *type)
{
    size_t number = strcmp(type, "SCALAR") == 0 ? 1 : (size_t)(type[3] - '0');
    return type[0] == 'M' ? number * number : number;
}

/* Fails if `count` elements of `size` bytes, `stride` apart (0: without gaps), do not fit the view from `offset` on. */
static void range_check(GltfReader *reader, const char *name, GltfBytes view, size_t offset, size_t count, size_t size,
                        size_t stride)
{
    size_t step = stride > 0 ? stride : size;
    bool fits = offset <= view.size && size <= view.size - offset && (count - 1) <= (view.size - offset - size) / step;
    if (!reader->failed && !fits)
        gltf_fail(reader, "%s reaches beyond its bufferView of %zu bytes", name, view.size);
}

/* The view that `object` names, and its index in *index. */
static GltfBytes view_of(const Gltf *gltf, GltfReader *reader, const GltfObject *object, int *index)
{
    *index = gltf_index(reader, object, "bufferView", "bufferViews");
    if (!reader->failed && *index < 0)
        gltf_fail(reader, "%s names no bufferView", object->name);
    if (reader->failed)
        return (GltfBytes){0};
    return gltf_view(gltf, reader, (size_t)*index);
}

/* Elements that replace some of an accessor's. */
static void sparse_check(const Gltf *gltf, GltfReader *reader, const GltfObject *sparse, size_t count, size_t size)
{
    int view;
    const GltfObject indices = gltf_object(reader, sparse, "indices"), values = gltf_object(reader, sparse, "values");
    size_t replaced = gltf_size(reader, sparse, "count", 0);
    size_t type = gltf_size(reader, &indices, "componentType", 0);
    if (!reader->failed && (replaced < 1 || replaced > count || !indices.json || !values.json))
        gltf_fail(reader, "%s needs indices, values and a count from 1 to %zu", sparse->name, count);
    if (!reader->failed && type != GLTF_UNSIGNED_BYTE && type != GLTF_UNSIGNED_SHORT && type != GLTF_UNSIGNED_INT)
        gltf_fail(reader, "%s has a component type that is not one of indices", indices.name);
    GltfBytes bytes = view_of(gltf, reader, &indices, &view);
    range_check(reader, indices.name, bytes, gltf_size(reader, &indices, "byteOffset", 0), replaced,
                gltf_component_size(type), 0);
    bytes = view_of(gltf, reader, &values, &view);
    range_check(reader, values.name, bytes, gltf_size(reader, &values, "byteOffset", 0), replaced, size, 0);
}

static void data_check(const Gltf *gltf, GltfReader *reader, const GltfObject *object, size_t count, size_t size)
{
    int index;
    const GltfBytes view = view_of(gltf, reader, object, &index);
    if (reader->failed)
        return;
    const GltfObject view_object = gltf_entry(reader, "bufferViews", (size_t)index);
    size_t stride = gltf_size(reader, &view_object, "byteStride", 0);
    if (stride != 0 && (stride < size || stride > 252))
        gltf_fail(reader, "%s.byteStride is %zu, below the %zu bytes of an element or above 252", view_object.name,
                  stride, size);
    range_check(reader, object->name, view, gltf_size(reader, object, "byteOffset", 0), count, size, stride);
}

size_t gltf_accessor_check(const Gltf *gltf, GltfReader *reader, int accessor, const char *type, unsigned components)
{
    const GltfObject object = gltf_entry(reader, "accessors", (size_t)accessor);
    size_t count = gltf_size(reader, &object, "count", 0), component = gltf_size(reader, &object, "componentType", 0);
    const char *found = gltf_text(reader, &object, "type", "");
    if (reader->failed)
        return 0;
    if (strcmp(found, type) != 0)
        return gltf_fail(reader, "%s is of type \"%.20s\" instead of %s", object.name, found, type);
    if (component < 5120 || component > 5126 || !(components & 1u << (component - 5120))) {
        gltf_fail(reader, "%s has the component type %zu, which is not supported here", object.name, component);
        return error_fix(reader->error, components & GLTF_COMPONENT(GLTF_FLOAT)
                                            ? "export it with floats, unquantized"
                                            : "export indices as unsigned integers");
    }
    if (count < 1 || count > INT32_MAX)
        return gltf_fail(reader, "%s.count must be from 1 to %d", object.name, INT32_MAX);
    size_t size = gltf_component_size(component) * gltf_type_width(type);
    const GltfObject sparse = gltf_object(reader, &object, "sparse");
    if (!sparse.json || json_object_get(object.json, "bufferView"))
        data_check(gltf, reader, &object, count, size);
    if (sparse.json)
        sparse_check(gltf, reader, &sparse, count, size);
    return reader->failed ? 0 : count;
}

size_t gltf_integer_read(const unsigned char *at, size_t size)
{
    size_t integer = 0;
    for (size_t k = 0; k < size; ++k)
        integer |= (size_t)at[k] << (8 * k);
    return integer;
}

size_t gltf_indices_check(const Gltf *gltf, GltfReader *reader, int accessor, size_t vertex_count)
{
    size_t count = gltf_accessor_check(gltf, reader, accessor, "SCALAR", GLTF_INDEX_COMPONENTS);
    if (reader->failed)
        return 0;
    const GltfObject object = gltf_entry(reader, "accessors", (size_t)accessor);
    int index = gltf_index(reader, &object, "bufferView", "bufferViews");
    if (json_object_get(object.json, "sparse") || index < 0)
        return count;
    const GltfObject view_object = gltf_entry(reader, "bufferViews", (size_t)index);
    const GltfBytes view = gltf_view(gltf, reader, (size_t)index);
    size_t size = gltf_component_size(gltf_size(reader, &object, "componentType", 0));
    size_t given = gltf_size(reader, &view_object, "byteStride", 0), stride = given > 0 ? given : size;
    const unsigned char *data = view.data + gltf_size(reader, &object, "byteOffset", 0);
    for (size_t i = 0; i < count && !reader->failed; ++i) {
        size_t vertex = gltf_integer_read(data + i * stride, size);
        if (vertex >= vertex_count)
            gltf_fail(reader, "%s has the vertex index %zu, but there are %zu vertices", object.name, vertex,
                      vertex_count);
    }
    return reader->failed ? 0 : count;
}

/* ---- primitives -------------------------------------------------------------------------------------------------- */

static void primitive_read(Gltf *gltf, GltfReader *reader, const GltfObject *object, GltfPrimitive *primitive)
{
    size_t mode = gltf_size(reader, object, "mode", GLTF_MODE_TRIANGLES);
    int material = gltf_index(reader, object, "material", "materials");
    primitive->material = material >= 0 ? material : (int)gltf->material_count - 1;
    primitive->triangles = mode >= GLTF_MODE_TRIANGLES && mode <= GLTF_MODE_TRIANGLE_FAN;
    if (!reader->failed && mode > GLTF_MODE_TRIANGLE_FAN)
        gltf_fail(reader, "%s.mode is %zu, above %d", object->name, mode, GLTF_MODE_TRIANGLE_FAN);
    if (!reader->failed && !primitive->triangles)
        log_message(LOG_WARNING, "%s: %s has points or lines, which are left out", gltf->path, object->name);
}

GltfObject gltf_primitive_object(GltfReader *reader, size_t mesh, size_t number)
{
    size_t count;
    const GltfObject object = gltf_entry(reader, "meshes", mesh);
    GltfObject primitive = {json_array_get(gltf_array(reader, &object, "primitives", &count), number), ""};
    snprintf(primitive.name, sizeof primitive.name, "meshes[%zu].primitives[%zu]", mesh, number);
    if (!json_is_object(primitive.json))
        gltf_fail(reader, "%s must be an object", primitive.name);
    return primitive;
}

static bool meshes_count(Gltf *gltf, GltfReader *reader)
{
    void *meshes = NULL, *primitives = NULL;
    size_t count = gltf_count(reader, "meshes"), all = 0;
    if (reader->failed || !gltf_allocate(reader, &meshes, count, sizeof *gltf->meshes))
        return false;
    gltf->meshes = meshes;
    gltf->mesh_count = count;
    for (size_t i = 0; i < count && !reader->failed; ++i) {
        const GltfObject object = gltf_entry(reader, "meshes", i);
        gltf->meshes[i] = (GltfMesh){.number = i, .first_primitive = all, .pose = -1};
        gltf_array(reader, &object, "primitives", &gltf->meshes[i].primitive_count);
        all += gltf->meshes[i].primitive_count;
    }
    if (reader->failed || !gltf_allocate(reader, &primitives, all, sizeof *gltf->primitives))
        return false;
    gltf->primitives = primitives;
    gltf->primitive_count = all;
    return true;
}

bool gltf_primitives_read(Gltf *gltf, GltfReader *reader)
{
    if (!meshes_count(gltf, reader))
        return false;
    for (size_t i = 0; i < gltf->mesh_count; ++i)
        for (size_t k = 0; k < gltf->meshes[i].primitive_count && !reader->failed; ++k) {
            GltfPrimitive *primitive = &gltf->primitives[gltf->meshes[i].first_primitive + k];
            const GltfObject object = gltf_primitive_object(reader, i, k);
            primitive->mesh = i;
            primitive->number = k;
            primitive_read(gltf, reader, &object, primitive);
        }
    return !reader->failed;
}
