/* The accessors of a glTF file, whose elements lie in buffers. */
#ifndef TWINLIGHT_GLTF_ACCESSORS_H
#define TWINLIGHT_GLTF_ACCESSORS_H

#include "gltf/document.h"

/* Component types. */
#define GLTF_UNSIGNED_BYTE 5121
#define GLTF_UNSIGNED_SHORT 5123
#define GLTF_UNSIGNED_INT 5125
#define GLTF_FLOAT 5126
#define GLTF_COMPONENT(type) (1u << ((type)-5120))
#define GLTF_INDEX_COMPONENTS                                                                                          \
    (GLTF_COMPONENT(GLTF_UNSIGNED_BYTE) | GLTF_COMPONENT(GLTF_UNSIGNED_SHORT) | GLTF_COMPONENT(GLTF_UNSIGNED_INT))

/* Modes of primitives: triangles, strips, fans; those below are points and lines. */
#define GLTF_MODE_TRIANGLES 4
#define GLTF_MODE_TRIANGLE_FAN 6

/* Checks that an accessor is of this type ("VEC3") with one of the component types, whose bits are set in `components`
 * (bit i: 5120 + i), and within its buffer. Its number of elements; 0 after a failure. */
size_t gltf_accessor_check(const Gltf *gltf, GltfReader *reader, int accessor, const char *type, unsigned components);

/* The values of an accessor, checked as by gltf_accessor_check, element by element; integers that are `normalized` as
 * fractions of the largest. *count: elements. Allocated; NULL after a failure. */
float *gltf_accessor_floats(const Gltf *gltf, GltfReader *reader, int accessor, const char *type, unsigned components,
                            size_t *count);

/* Bytes of a component; components of an element ("VEC3": 3, "MAT4": 16); an unsigned integer of `size` bytes,
 * little-endian. */
size_t gltf_component_size(size_t type);
size_t gltf_type_width(const char *type);
size_t gltf_integer_read(const unsigned char *at, size_t size);

/* Checks that an accessor is one of indices below `vertex_count`. Their number; 0 after a failure. Indices that a
 * sparse accessor replaces are not checked: Assimp drops their triangles, which gltf_meshes_read notices. */
size_t gltf_indices_check(const Gltf *gltf, GltfReader *reader, int accessor, size_t vertex_count);

#endif
