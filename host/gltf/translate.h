/* A glTF scene as directives of pbrt-v4. */
#ifndef TWINLIGHT_GLTF_TRANSLATE_H
#define TWINLIGHT_GLTF_TRANSLATE_H

#include "gltf/document.h"

/* What is being written. Names of meshes and images are PREFIX-meshes/N.ply for part N and PREFIX-textures/N.png, or
 * .exr, for derived image N. */
typedef struct Translation {
    Gltf *gltf;
    GltfReader *reader;
    FILE *out;
    const char *prefix;
} Translation;

/* Writes the scene. Images that materials need are added to gltf->derived. */
bool gltf_translate(Translation *translation);

/* Writes textures and named materials, "N name" (translate_materials.c); the names of the textures that shapes need. */
bool gltf_translate_materials(Translation *translation);

/* Prints the quoted name of a material. */
void gltf_material_name(const Translation *translation, int material, const char *suffix);

/* Prints the parameter alpha of shapes with this material, if it has any. */
void gltf_material_alpha(Translation *translation, int material);

/* Whether nothing is seen of a material: a mask whose alpha is below its cutoff everywhere, or alpha 0. */
bool gltf_material_invisible(const GltfMaterial *material);

#endif
