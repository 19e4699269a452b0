/* The scene reader, and for bytes that begin with "ply" the PLY reader, against arbitrary bytes. With clang it is a
 * libFuzzer target (make fuzz); with -DREPLAY, or another compiler, a program that replays the files it is given. */
#include "log.h"
#include "pbrt_import.h"
#include "ply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void log_drop(const char *line, void *context)
{
    (void)line;
    (void)context;
}

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
    /* The first byte's lowest bit chooses --lenient, so that both ways through the reader are tried. */
    ImportOptions options = {.lenient = size > 0 && (data[0] & 1)};
    Scene scene;
    Error error = {{0}, {0}};
    log_sink_set(log_drop, NULL);
    scene_init(&scene);
    if (pbrt_import_text((const char *)data, size, "fuzz.pbrt", "/nonexistent", &options, &scene, &error) &&
        scene.primitives.count < 100000)
        scene_finish(&scene, &error);
    scene_destroy(&scene);
    return 0;
}

#ifdef REPLAY
static int file_replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return 1;
    }
    char *data = NULL;
    size_t size = 0;
    for (;;) {
        char *larger = realloc(data, size + 65536);
        if (!larger)
            abort();
        data = larger;
        size_t got = fread(data + size, 1, 65536, file);
        size += got;
        if (got == 0)
            break;
    }
    fclose(file);
    char *exact = realloc(data, size > 0 ? size : 1);
    LLVMFuzzerTestOneInput((const uint8_t *)exact, size);
    free(exact);
    return 0;
}

int main(int count, char **paths)
{
    int failed = 0;
    for (int i = 1; i < count; ++i)
        failed |= file_replay(paths[i]);
    printf("%d files replayed\n", count - 1);
    return failed;
}
#endif
