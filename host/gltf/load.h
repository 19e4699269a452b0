/* Loads a scene file of any format that the program reads. */
#ifndef TWINLIGHT_GLTF_LOAD_H
#define TWINLIGHT_GLTF_LOAD_H

#include "scene/scene.h"

/* Reads `path`, glTF by its name (gltf_named) and else pbrt-v4, and calls scene_finish. `scene` must come from
 * scene_init; after an error it may only be passed to scene_destroy. The path "-" is standard input, a pbrt scene.
 * `lenient`: as in ImportOptions. Reports all errors of a pbrt scene. */
bool scene_file_load(const char *path, bool lenient, Scene *scene, Error *error);

#endif
