/* Reads pbrt-v4's text format into a Scene. man/twinlight-scene.5 says what of it is read. */
#ifndef TWINLIGHT_PBRT_IMPORT_H
#define TWINLIGHT_PBRT_IMPORT_H

#include "pbrt/import_options.h"
#include "scene/scene.h"

/* Reads the file `path`; names in it are relative to its folder. `scene` must come from scene_init; scene_finish is
 * left to the caller. On an error `scene` holds some part of the file and is good for scene_destroy only; the message
 * says file:line:column. */
bool pbrt_import(const char *path, const ImportOptions *options, Scene *scene, Error *error);

/* The same with all errors of the scene, and scene_finish. The path "-" is standard input, in which names lead from the
 * current folder. */
bool pbrt_load(const char *path, bool lenient, Scene *scene, Error *error);

/* As pbrt_import, from memory. `name` stands for the file's name in messages; `directory` is where names in the text
 * lead from. */
bool pbrt_import_text(const char *text, size_t length, const char *name, const char *directory,
                      const ImportOptions *options, Scene *scene, Error *error);

#endif
