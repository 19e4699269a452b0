/* Arbitrary bytes as a part for twinlight merge. The first byte says of what: of the file, of what it holds once
 * decompressed, or (0) of what follows the version in that, so that inputs outlive a change of the version. */
#include "fuzz/fuzz.h"
#include "fuzz/fuzz_file.h"

#include "base/log.h"
#include "render/merge.h"

/* A larger film would take the time of thousands of others. */
#define PIXELS_MAX 4096

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
    char *const paths[1] = {fuzz_file()};
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
    if (size == 0)
        return 0;
    log_sink_set(fuzz_log_drop, NULL);
    if (data[0] == 0)
        head_make(&head);
    if (data[0] == 1)
        fuzz_file_write(data + 1, size - 1);
    else
        fuzz_file_compress(&head, data + 1, size - 1);
    archive_memory_destroy(&head);
    part_merge_try();
    return 0;
}
