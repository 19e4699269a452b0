#include "base/archive.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void archive_fail(Archive *archive, const char *format, ...)
{
    char text[512];
    va_list arguments;
    if (archive->failed)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    archive->failed = true;
    error_set(&archive->error, "%s", text);
}

void archive_bytes(Archive *archive, void *bytes, size_t size)
{
    if (!archive->failed && size > 0)
        archive->failed = !archive->transfer(archive->context, bytes, size, &archive->error);
}

void archive_same(Archive *archive, uint64_t value, const char *what)
{
    uint64_t saved = value;
    ARCHIVE_FIELD(archive, saved);
    if (saved != value)
        archive_fail(archive, "%s: %llu were saved, but there are %llu", what, (unsigned long long)saved,
                     (unsigned long long)value);
}

void archive_count(Archive *archive, uint32_t *count, uint32_t least, uint32_t most, const char *what)
{
    uint32_t saved = *count;
    ARCHIVE_FIELD(archive, saved);
    if (archive->failed || archive->saves)
        return;
    if (saved >= least && saved <= most)
        *count = saved;
    else
        archive_fail(archive, "%s: %lu were saved, but there can be %lu to %lu", what, (unsigned long)saved,
                     (unsigned long)least, (unsigned long)most);
}

/* ---- memory ------------------------------------------------------------------------------------------------------ */

static bool memory_append(void *context, void *bytes, size_t size, Error *error)
{
    ArchiveMemory *memory = context;
    if (size > memory->capacity - memory->size) {
        size_t capacity = memory->size + size + memory->capacity / 2;
        unsigned char *grown = realloc(memory->bytes, capacity);
        if (!grown)
            return error_memory(error, capacity, "a copy of the rendering's state");
        memory->bytes = grown;
        memory->capacity = capacity;
    }
    memcpy(memory->bytes + memory->size, bytes, size);
    memory->size += size;
    return true;
}

Archive archive_to_memory(ArchiveMemory *memory)
{
    return (Archive){.saves = true, .transfer = memory_append, .context = memory};
}

void archive_memory_destroy(ArchiveMemory *memory)
{
    free(memory->bytes);
    *memory = (ArchiveMemory){0};
}
