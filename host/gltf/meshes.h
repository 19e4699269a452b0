/* The meshes of a glTF file, unpacked by Assimp.
 *
 * Assimp 5.2 gets a document of its own with nothing but accessors and triangles, whose ranges have been checked, and the
 * buffers from memory: on whole files it reads beyond the end of sparse accessors, loads only what the first scene
 * reaches, in the order of that, misreads coordinates that are stored as integers, and knows neither the strength of
 * emission nor lights that several nodes share. It is called without post-processing, so vertices stay as they are. */
#ifndef TWINLIGHT_GLTF_MESHES_H
#define TWINLIGHT_GLTF_MESHES_H

#include "gltf/document.h"

/* Fills gltf->parts: the triangles of all primitives that the scene shows, a part for each. Fails, naming the accessor or the
 * primitive, for ranges beyond their buffers, indices beyond the vertices, and vertices that are not finite. */
bool gltf_meshes_read(Gltf *gltf, GltfReader *reader);

/* Checks that an accessor is of this type ("VEC3") with one of the component types, whose bits are set in `components`
 * (bit i: 5120 + i), and within its buffer. Its number of elements; 0 after a failure. */
size_t gltf_accessor_check(const Gltf *gltf, GltfReader *reader, int accessor, const char *type, unsigned components);

/* Checks that an accessor is one of indices below `vertex_count`. Their number; 0 after a failure. Indices that a sparse
 * accessor replaces are not checked: Assimp drops their triangles, which gltf_meshes_read notices. */
size_t gltf_indices_check(const Gltf *gltf, GltfReader *reader, int accessor, size_t vertex_count);

/* Modes of primitives: triangles, strips, fans; those below are points and lines. */
#define GLTF_MODE_TRIANGLES 4
#define GLTF_MODE_TRIANGLE_FAN 6

/* Component types. */
#define GLTF_UNSIGNED_BYTE 5121
#define GLTF_UNSIGNED_SHORT 5123
#define GLTF_UNSIGNED_INT 5125
#define GLTF_FLOAT 5126
#define GLTF_COMPONENT(type) (1u << ((type)-5120))
#define GLTF_INDEX_COMPONENTS                                                                                          \
    (GLTF_COMPONENT(GLTF_UNSIGNED_BYTE) | GLTF_COMPONENT(GLTF_UNSIGNED_SHORT) | GLTF_COMPONENT(GLTF_UNSIGNED_INT))

#endif
