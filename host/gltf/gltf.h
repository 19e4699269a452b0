/* glTF 2.0 files (.gltf, .glb).
 *
 * A file is translated to directives of pbrt-v4, which the reader of room pbrt then takes from memory, together with
 * the meshes and images that they name; gltf_convert writes the same directives, meshes and images to files. So a file
 * and its conversion give the same picture. man/twinlight-scene.5 describes the supported subset and what each
 * parameter becomes.
 *
 * The JSON is read and checked here, Assimp unpacks the meshes (gltf/meshes.h). In a program without Assimp gltf_open
 * fails, with advice (gltf_absent.c). */
#ifndef TWINLIGHT_GLTF_GLTF_H
#define TWINLIGHT_GLTF_GLTF_H

#include "pbrt/import_options.h"
#include "scene/scene.h"

typedef struct Gltf Gltf;

/* Whether the name ends in .gltf or .glb. */
bool gltf_named(const char *path);

/* Reads a file with its buffers and meshes; images are read when they are needed. Notes and warnings about what is left
 * out go to the log. `path` is borrowed. NULL with `error` filled, naming the file, if it is damaged or needs something
 * that is not supported. */
Gltf *gltf_open(const char *path, Error *error);

/* Safe on NULL. */
void gltf_close(Gltf *gltf);

/* Adds the content to a scene that comes from scene_init; the caller calls scene_finish. */
bool gltf_import(Gltf *gltf, const ImportOptions *options, Scene *scene, Error *error);

/* Writes the scene to `path`, NAME.pbrt, its meshes to the folder NAME-meshes beside it and its images to
 * NAME-textures. Each file appears whole or not at all, the scene last. */
bool gltf_convert(Gltf *gltf, const char *path, Error *error);

#endif
