#include "render/merge.h"

#include "base/log.h"
#include "base/path_name.h"

#include <stdlib.h>
#include <string.h>

/* ---- heads ------------------------------------------------------------------------------------------------------- */

#define ONE_PICTURE "merge parts of one picture only, rendered with the same scene and options"

static bool head_compare(const PartHead *first, const char *first_path, const PartHead *head, const char *path,
                         Error *error)
{
    const IdentityUse use = {path, first_path, ONE_PICTURE};
    const PartPicture *a = &first->picture, *b = &head->picture;
    if (head->shard.count != first->shard.count) {
        error_set(error, "%s is one of %u shards, and %s one of %u", path, head->shard.count, first_path,
                  first->shard.count);
        return error_fix(error, ONE_PICTURE);
    }
    if (!identity_compare(&head->identity, &first->identity, &use, error))
        return false;
    if (a->quantum_exponent != b->quantum_exponent) {
        error_set(error, "%s has sums in units of 2^%d, and %s of 2^%d: they were made by devices with different bits",
                  path, b->quantum_exponent, first_path, a->quantum_exponent);
        return error_fix(error, "render all shards on backends that twinlight devices says give the same bits");
    }
    if (a->scale == b->scale)
        return true;
    error_set(error, "%s is of another scene than %s: its Film has another iso or exposure", path, first_path);
    return error_fix(error, ONE_PICTURE);
}

static int part_order(const void *a, const void *b)
{
    const MergePart *left = a, *right = b;
    if (left->number != right->number)
        return left->number < right->number ? -1 : 1;
    return left->place < right->place ? -1 : left->place > right->place;
}

/* After sorting. */
static bool duplicates_check(const Merge *merge, Error *error)
{
    for (size_t i = 1; i < merge->count; ++i) {
        const MergePart *a = &merge->parts[i - 1], *b = &merge->parts[i];
        if (a->number != b->number)
            continue;
        if (path_same(a->path, b->path))
            error_set(error, "%s and %s are the same file", a->path, b->path);
        else
            error_set(error, "%s and %s are both shard %u of %u", a->path, b->path, a->number, merge->head.shard.count);
        return error_fix(error, "leave one of them out: the same samples must not count twice");
    }
    return true;
}

/* Reads the head of a part that is then closed again: any number of them may be merged. */
static bool part_look(MergePart *part, PartHead *head, Error *error)
{
    ArchiveReader reader;
    if (!part_open(&reader, part->path, head, error))
        return false;
    archive_reader_close(&reader);
    part->number = head->shard.number;
    part->done = head->totals.done;
    part->wanted = head->wanted;
    return true;
}

bool merge_begin(Merge *merge, char *const *paths, size_t count, Error *error)
{
    PartHead head;
    *merge = (Merge){.parts = calloc(count, sizeof *merge->parts), .count = count};
    if (!merge->parts)
        return error_memory(error, count * sizeof *merge->parts, "the list of parts");
    for (size_t i = 0; i < count; ++i) {
        MergePart *part = &merge->parts[i];
        *part = (MergePart){.path = paths[i], .place = i};
        if (!part_look(part, &head, error) ||
            (i > 0 && !head_compare(&merge->head, paths[0], &head, part->path, error)))
            return false;
        if (i == 0 || head.shard.number < merge->head.shard.number)
            merge->head = head;
    }
    qsort(merge->parts, count, sizeof *merge->parts, part_order);
    return duplicates_check(merge, error);
}

void merge_destroy(Merge *merge)
{
    free(merge->parts);
    *merge = (Merge){.count = 0};
}

/* ---- what is missing --------------------------------------------------------------------------------------------- */

/* Room for a range, and for what stands for those that have none. */
#define RANGE_BYTES 40u

/* Adds shards first ... last to a text. */
static void range_add(char *text, size_t size, unsigned first, unsigned last)
{
    size_t length = strlen(text);
    const char *before = length > 0 ? ", " : "";
    if (length + RANGE_BYTES > size)
        snprintf(text + length, size - length, "%s", text[length - 1] == '.' ? "" : ", ...");
    else if (last > first + 1)
        snprintf(text + length, size - length, "%s%u ... %u", before, first, last);
    else if (last > first)
        snprintf(text + length, size - length, "%s%u, %u", before, first, last);
    else
        snprintf(text + length, size - length, "%s%u", before, first);
}

unsigned merge_missing(const Merge *merge, char *text, size_t size)
{
    unsigned next = 1, missing = 0; /* next: the first shard that may be missing */
    text[0] = '\0';
    for (size_t i = 0; i <= merge->count; ++i) {
        unsigned number = i < merge->count ? merge->parts[i].number : merge->head.shard.count + 1;
        if (number > next) {
            range_add(text, size, next, number - 1);
            missing += number - next;
        }
        next = number + 1;
    }
    return missing;
}

void merge_warn(const Merge *merge)
{
    char text[256];
    unsigned missing = merge_missing(merge, text, sizeof text);
    if (missing > 0)
        log_message(LOG_WARNING, "shard%s %s of %u %s missing: the picture has %zu of %u parts", missing > 1 ? "s" : "",
                    text, merge->head.shard.count, missing > 1 ? "are" : "is", merge->count, merge->head.shard.count);
    size_t unfinished = 0;
    const MergePart *first = NULL;
    for (size_t i = 0; i < merge->count; ++i)
        if (merge->parts[i].done < merge->parts[i].wanted) {
            first = unfinished++ == 0 ? &merge->parts[i] : first;
        }
    if (first)
        log_message(LOG_WARNING, "%zu of %zu parts are of shards that were stopped early, the first %s, at %.3g %%",
                    unfinished, merge->count, first->path, 100.0 * (double)first->done / (double)first->wanted);
}

/* ---- sums -------------------------------------------------------------------------------------------------------- */

static void totals_add(RenderTotals *totals, const RenderTotals *more)
{
    totals->done += more->done;
    totals->seconds += more->seconds;
    totals->samples = more->samples;
    totals->photons = more->photons;
    totals->closest_rays += more->closest_rays;
    totals->shadow_rays += more->shadow_rays;
    for (int i = 0; i < DIAGNOSTIC_COUNT; ++i)
        totals->diagnostics[i] += more->diagnostics[i];
}

/* Where a part is read to before it is added. */
typedef struct PartSums {
    Film film;
    RenderLayers layers;
} PartSums;

/* Opens a part again, which may have been replaced meanwhile. */
static bool part_reopen(const Merge *merge, const MergePart *part, ArchiveReader *reader, PartHead *head, Error *error)
{
    if (!part_open(reader, part->path, head, error))
        return false;
    if (head->shard.number == part->number &&
        memcmp(&head->identity, &merge->head.identity, sizeof head->identity) == 0)
        return true;
    archive_reader_close(reader);
    error_set(error, "%s has been replaced by another part while it was merged", part->path);
    return error_fix(error, "merge again when nothing is written to it");
}

static bool part_merge(Merge *merge, const MergePart *part, PartSums *sums, Film *film, RenderLayers *layers,
                       Error *error)
{
    ArchiveReader reader;
    PartHead head;
    if (!part_reopen(merge, part, &reader, &head, error))
        return false;
    bool good = part_read(&reader, part->path, &sums->film, &sums->layers, error);
    archive_reader_close(&reader);
    if (!good)
        return false;
    if (!film_merge(film, &sums->film, error) || !render_layers_merge(layers, &sums->layers, error))
        return error_in(error, part->path);
    totals_add(&merge->totals, &head.totals);
    return true;
}

bool merge_run(Merge *merge, Film *film, RenderLayers *layers, const atomic_int *stop, Error *error)
{
    PartSums sums = {.film = {.width = 0}};
    bool good = part_film_init(&merge->head, film->threads, &sums.film, &sums.layers, error);
    for (size_t i = 0; good && i < merge->count && !*stop; ++i)
        good = part_merge(merge, &merge->parts[i], &sums, film, layers, error);
    film_destroy(&sums.film);
    render_layers_destroy(&sums.layers);
    return good;
}
