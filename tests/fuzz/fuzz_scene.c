/* Arbitrary bytes for the scene reader or, if they begin with "ply", for the PLY reader. */
#include "fuzz/fuzz.h"

#include "base/log.h"
#include "pbrt/import.h"
#include "pbrt/ply.h"

#include <string.h>

static void ply_try(const uint8_t *data, size_t size)
{
    PlyMesh mesh;
    Error error;
    if (ply_read_memory("fuzz.ply", (SourcePlace){0}, (const char *)data, size, &mesh, &error))
        ply_destroy(&mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size >= 3 && memcmp(data, "ply", 3) == 0) {
        ply_try(data, size);
        return 0;
    }
    /* The first byte selects --lenient and whether to continue after errors, so that all paths through the reader are
     * tried. */
    ImportOptions options = {.lenient = size > 0 && (data[0] & 1), .all_errors = size > 0 && (data[0] & 2)};
    Scene scene;
    Error error = {{0}, {0}};
    log_sink_set(fuzz_log_drop, NULL);
    scene_init(&scene);
    if (pbrt_import_text((const char *)data, size, "fuzz.pbrt", "/nonexistent", &options, &scene, &error) &&
        scene.primitives.count < 100000)
        scene_finish(&scene, &error);
    scene_destroy(&scene);
    return 0;
}
