/* In a program built without Assimp. */
#include "gltf/gltf.h"

Gltf *gltf_open(const char *path, Error *error)
{
    error_set(error, "%s is a glTF file, and this program was built without Assimp, which unpacks their meshes", path);
    error_fix(error, "install libassimp-dev and libjansson-dev and configure again, or export the scene for pbrt-v4");
    return NULL;
}

void gltf_close(Gltf *gltf)
{
    (void)gltf;
}

bool gltf_import(Gltf *gltf, const ImportOptions *options, Scene *scene, Error *error)
{
    (void)gltf;
    (void)options;
    (void)scene;
    return error_set(error, "this program was built without Assimp");
}

bool gltf_convert(Gltf *gltf, const char *path, Error *error)
{
    (void)gltf;
    (void)path;
    return error_set(error, "this program was built without Assimp");
}
