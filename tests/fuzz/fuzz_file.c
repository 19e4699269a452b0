#include "fuzz/fuzz_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zstd.h>

static char path[1024];

static void path_remove(void)
{
    unlink(path);
}

char *fuzz_file(void)
{
    const char *folder = getenv("TMPDIR");
    if (path[0])
        return path;
    snprintf(path, sizeof path, "%s/twinlight-fuzz-XXXXXX", folder ? folder : "/tmp");
    int descriptor = mkstemp(path);
    if (descriptor < 0) {
        perror(path);
        abort();
    }
    close(descriptor);
    atexit(path_remove);
    return path;
}

void fuzz_file_write(const void *data, size_t size)
{
    FILE *file = fopen(fuzz_file(), "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0)
        abort();
}

void fuzz_file_compress(const ArchiveMemory *head, const void *data, size_t size)
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
    fuzz_file_write(packed, written);
    free(all);
    free(packed);
}
