#include "gltf/load.h"

#include "base/path_name.h"
#include "gltf/gltf.h"
#include "pbrt/import.h"

bool gltf_named(const char *path)
{
    return path_ends(path, ".gltf") || path_ends(path, ".glb");
}

bool scene_file_load(const char *path, bool lenient, Scene *scene, Error *error)
{
    const ImportOptions options = {.lenient = lenient};
    if (!gltf_named(path))
        return pbrt_load(path, lenient, scene, error);
    Gltf *gltf = gltf_open(path, error);
    bool good = gltf && gltf_import(gltf, &options, scene, error);
    gltf_close(gltf);
    return good && (scene_finish(scene, error) || error_in(error, path));
}
