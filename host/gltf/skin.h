/* Skins: the pose that a mesh takes from the nodes that are its joints. */
#ifndef TWINLIGHT_GLTF_SKIN_H
#define TWINLIGHT_GLTF_SKIN_H

#include "gltf/document.h"

/* Moves the vertices of a primitive's mesh to where the nodes have them: in the world by the skin of the node that
 * poses it, each by the mean of its joints' transforms by its weights (linear blending). Normals keep to the surface,
 * and triangles that are mirrored keep their front. A primitive without joints follows the node. Does nothing to meshes
 * without a skin. Fails for joints that do not exist, and for weights that are negative or not finite. */
bool gltf_skin_apply(const Gltf *gltf, GltfReader *reader, const GltfPrimitive *primitive, PlyMesh *mesh);

/* Number of the joints that move a mesh; 0: it has no skin. */
size_t gltf_skin_joints(const Gltf *gltf, GltfReader *reader, const GltfMesh *mesh);

#endif
