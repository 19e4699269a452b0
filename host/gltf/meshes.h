/* The meshes of a glTF file, unpacked by Assimp.
 *
 * Assimp 5.2 gets a document of its own with nothing but accessors and triangles, whose ranges have been checked, and
 * the buffers from memory: on whole files it reads beyond the end of sparse accessors, loads only what the first scene
 * reaches, in the order of that, misreads coordinates that are stored as integers, and knows neither the strength of
 * emission nor lights that several nodes share, nor more than four joints of a vertex. Skins (skin.h) are not in it. It
 * is called without post-processing, so vertices stay as they are. */
#ifndef TWINLIGHT_GLTF_MESHES_H
#define TWINLIGHT_GLTF_MESHES_H

#include "gltf/document.h"

/* Fills gltf->parts: the triangles of all primitives that the scene shows, a part for each. Fails, naming the accessor
 * or the primitive, for ranges beyond their buffers, indices beyond the vertices, and vertices that are not finite. */
bool gltf_meshes_read(Gltf *gltf, GltfReader *reader);

#endif
