/* The emission of meshes: area lights of pbrt have one radiance, so a mesh whose emission has a texture is divided. */
#ifndef TWINLIGHT_GLTF_EMISSION_H
#define TWINLIGHT_GLTF_EMISSION_H

#include "gltf/document.h"

/* Levels per channel that are told apart. */
#define EMISSION_LEVELS 16

/* Adds the mesh to gltf->parts, and leaves it empty: whole with the material's emission or, if that has a texture, a
 * part for the triangles that do not emit and one for those of every colour. A triangle's radiance is the mean of the
 * texture at points of it; its square root per channel, relative to the factor, is rounded to EMISSION_LEVELS to group
 * triangles, and a group has their mean by area. */
bool gltf_emission_split(Gltf *gltf, GltfReader *reader, const GltfMaterial *material, PlyMesh *mesh);

#endif
