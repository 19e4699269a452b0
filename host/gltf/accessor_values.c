/* The values of accessors that Assimp does not return. */
#include "gltf/accessors.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Where elements lie: `width` components of `size` bytes each. */
typedef struct Elements {
    const unsigned char *data;
    size_t stride, width, size;
    bool is_float, normalized;
} Elements;

static float component_value(const Elements *elements, const unsigned char *at)
{
    size_t bits = gltf_integer_read(at, elements->size);
    uint32_t word = (uint32_t)bits;
    float value;
    if (!elements->is_float)
        return elements->normalized ? (float)((double)bits / (elements->size == 1 ? 255.0 : 65535.0)) : (float)bits;
    memcpy(&value, &word, sizeof value);
    return value;
}

static void element_read(const Elements *elements, size_t i, float *out)
{
    for (size_t k = 0; k < elements->width; ++k)
        out[k] = component_value(elements, elements->data + i * elements->stride + k * elements->size);
}

/* Points `elements` at the view that an accessor or a part of a sparse one names. */
static void elements_place(const Gltf *gltf, GltfReader *reader, const GltfObject *object, Elements *elements)
{
    int index = gltf_index(reader, object, "bufferView", "bufferViews");
    if (index < 0)
        return;
    const GltfObject view = gltf_entry(reader, "bufferViews", (size_t)index);
    size_t stride = gltf_size(reader, &view, "byteStride", 0);
    elements->stride = stride > 0 ? stride : elements->size * elements->width;
    elements->data = gltf_view(gltf, reader, (size_t)index).data + gltf_size(reader, object, "byteOffset", 0);
}

/* Replaces the elements that a sparse accessor has other values for. */
static void sparse_apply(const Gltf *gltf, GltfReader *reader, const GltfObject *sparse, Elements values, size_t count,
                         float *out)
{
    const GltfObject at = gltf_object(reader, sparse, "indices"), with = gltf_object(reader, sparse, "values");
    Elements indices = {.width = 1, .size = gltf_component_size(gltf_size(reader, &at, "componentType", 0))};
    size_t replaced = gltf_size(reader, sparse, "count", 0);
    elements_place(gltf, reader, &at, &indices);
    elements_place(gltf, reader, &with, &values);
    indices.stride = indices.size; /* these views have no gaps */
    values.stride = values.size * values.width;
    for (size_t i = 0; i < replaced && !reader->failed; ++i) {
        size_t index = gltf_integer_read(indices.data + i * indices.stride, indices.size);
        if (index >= count)
            gltf_fail(reader, "%s replaces element %zu of %zu", sparse->name, index, count);
        else
            element_read(&values, i, out + index * values.width);
    }
}

float *gltf_accessor_floats(const Gltf *gltf, GltfReader *reader, int accessor, const char *type, unsigned components,
                            size_t *count)
{
    void *out = NULL;
    *count = gltf_accessor_check(gltf, reader, accessor, type, components);
    if (reader->failed)
        return NULL;
    const GltfObject object = gltf_entry(reader, "accessors", (size_t)accessor);
    const GltfObject sparse = gltf_object(reader, &object, "sparse");
    size_t component = gltf_size(reader, &object, "componentType", 0);
    Elements elements = {.width = gltf_type_width(type),
                         .size = gltf_component_size(component),
                         .is_float = component == GLTF_FLOAT,
                         .normalized = gltf_bool(reader, &object, "normalized", false)};
    if (!gltf_allocate(reader, &out, *count * elements.width, sizeof(float)))
        return NULL;
    elements_place(gltf, reader, &object, &elements);
    for (size_t i = 0; elements.data && i < *count; ++i)
        element_read(&elements, i, (float *)out + i * elements.width);
    if (sparse.json)
        sparse_apply(gltf, reader, &sparse, elements, *count, out);
    if (!reader->failed)
        return out;
    free(out);
    return NULL;
}
