/* Arbitrary bytes as a part for twinlight merge. The first byte says of what: of the file, of what it holds once decompressed, or
 * (0) of what follows the version in that, so that inputs outlive a change of the version. */
#include "fuzz/fuzz.h"

#include "base/log.h"
#include "render/merge.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zstd.h>

/* A larger film would take the time of thousands of others. */
#define PIXELS_MAX 4096

static char path[1024];

static void path_remove(void)
{
    unlink(path);
}

static void path_make(void)
{
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/twinlight-fuzz-part-XXXXXX", folder ? folder : "/tmp");
    int descriptor = mkstemp(path);
    if (descriptor < 0) {
        perror(path);
        abort();
    }
    close(descriptor);
    atexit(path_remove);
    log_sink_set(fuzz_log_drop, NULL);
}

static void file_write(const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0)
        abort();
}

/* Writes a file of the head, if there is one, and the data. */
static void file_compress(const ArchiveMemory *head, const void *data, size_t size)
{
    size_t bound = ZSTD_compressBound(head->size + size);
    unsigned char *all = malloc(head->size + size + 1), *packed = malloc(bound);
    if (!all || !packed)
        abort();
    if (head->size > 0)
        memcpy(all, head->bytes, head->size);
    if (size > 0)
        memcpy(all + head->size, data, size);
    size_t written = ZSTD_compress(packed, bound, all, head->size + size, 1);
    if (ZSTD_isError(written))
        abort();
    file_write(packed, written);
    free(all);
    free(packed);
}

static void head_make(ArchiveMemory *head)
{
    Archive archive = archive_to_memory(head);
    Identity identity;
    bool other;
    identity_begin(&identity);
    archive_head(&archive, "part", &other);
    ARCHIVE_FIELD(&archive, identity);
}

static void part_merge_try(void)
{
    char *const paths[1] = {path};
    const atomic_int stop = 0;
    Film film = {0};
    RenderLayers layers = {0};
    Merge merge = {.count = 0};
    Error error = {0};
    if (merge_begin(&merge, paths, 1, &error)) {
        const PartPicture *picture = &merge.head.picture;
        char missing[64];
        merge_missing(&merge, missing, sizeof missing);
        if ((int64_t)picture->width * picture->height <= PIXELS_MAX &&
            part_film_init(&merge.head, 1, &film, &layers, &error))
            merge_run(&merge, &film, &layers, &stop, &error);
    }
    film_destroy(&film);
    render_layers_destroy(&layers);
    merge_destroy(&merge);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ArchiveMemory head = {.size = 0};
    if (!path[0])
        path_make();
    if (size == 0)
        return 0;
    if (data[0] == 0)
        head_make(&head);
    if (data[0] == 1)
        file_write(data + 1, size - 1);
    else
        file_compress(&head, data + 1, size - 1);
    archive_memory_destroy(&head);
    part_merge_try();
    return 0;
}
