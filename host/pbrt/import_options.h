/* Options of reading a scene. */
#ifndef TWINLIGHT_PBRT_IMPORT_OPTIONS_H
#define TWINLIGHT_PBRT_IMPORT_OPTIONS_H

#include "image/image.h"
#include "pbrt/needs.h"
#include "pbrt/ply.h"

/* Meshes and images that a text refers to by name and that are in memory. A function fills its last argument but one,
 * which the importer destroys, or fails. */
typedef struct ImportMemory {
    bool (*mesh)(void *owner, const char *name, PlyMesh *mesh, Error *error);
    bool (*image)(void *owner, const char *name, Image *image, Error *error);
    void *owner;
} ImportMemory;

struct MediaPlaces;

typedef struct ImportOptions {
    bool lenient; /* replace unsupported features, with a warning that names the substitute, instead of failing */
    bool all_errors; /* continue after errors, up to IMPORT_ERRORS_MAX, and print all but the last */
    const ImportMemory *memory; /* in place of the files of plymesh and of textures; NULL: none */
    struct MediaPlaces *places; /* records lights for media_places_check; NULL: nothing */
    SceneNeeds *needs; /* records what the scene needs, instead of failing; NULL: an ordinary reading */
} ImportOptions;

#endif
