/* Reads pbrt-v4's text format into a Scene. man/twinlight-scene.5 describes the supported subset. */
#ifndef TWINLIGHT_PBRT_IMPORT_H
#define TWINLIGHT_PBRT_IMPORT_H

#include "pbrt/import_options.h"
#include "scene/scene.h"

/* Reads the file `path`; file names in it are relative to its folder. `scene` must come from scene_init; the caller
 * calls scene_finish. After an error `scene` is incomplete and may only be passed to scene_destroy; the message has
 * file:line:column. */
bool pbrt_import(const char *path, const ImportOptions *options, Scene *scene, Error *error);

/* The same, but reports all errors of the scene and calls scene_finish. The path "-" is standard input, with file names
 * relative to the current folder. */
bool pbrt_load(const char *path, bool lenient, Scene *scene, Error *error);

/* Records what the scene needs (needs_init); the path "-" is standard input. Fails only if it cannot be read at all. */
bool pbrt_needs(const char *path, SceneNeeds *needs, Error *error);

/* Like pbrt_import, from memory. `name` is the file name in messages; file names in the text are relative to
 * `directory`. */
bool pbrt_import_text(const char *text, size_t length, const char *name, const char *directory,
                      const ImportOptions *options, Scene *scene, Error *error);

#endif
