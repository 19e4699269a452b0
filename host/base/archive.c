#include "base/archive.h"

#include <math.h>
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

static void range_check(Archive *archive, double number, NumberRange range, const char *what)
{
    char text[32] = "NaN";
    if (archive->saves || (number >= range.least && number <= range.most))
        return;
    if (!isnan(number))
        snprintf(text, sizeof text, "%.9g", number);
    archive_fail(archive, "%s: %s was saved, but there can be %.9g to %.9g", what, text, range.least, range.most);
}

void archive_doubles(Archive *archive, double *numbers, size_t count, NumberRange range, const char *what)
{
    archive_bytes(archive, numbers, count * sizeof *numbers);
    for (size_t i = 0; i < count && !archive->failed; ++i)
        range_check(archive, numbers[i], range, what);
}

void archive_floats(Archive *archive, float *numbers, size_t count, NumberRange range, const char *what)
{
    archive_bytes(archive, numbers, count * sizeof *numbers);
    for (size_t i = 0; i < count && !archive->failed; ++i)
        range_check(archive, (double)numbers[i], range, what);
}

void archive_flags(Archive *archive, bool *flags, size_t count, const char *what)
{
    for (size_t i = 0; i < count && !archive->failed; ++i) {
        unsigned char byte = flags[i];
        archive_bytes(archive, &byte, 1);
        if (byte > 1)
            archive_fail(archive, "%s: %d was saved, but there can be 0 or 1", what, byte);
        flags[i] = byte == 1;
    }
}

/* ---- the kind of a file ------------------------------------------------------------------------------------------ */

#define PROGRAM "Twinlight "

void archive_head(Archive *archive, const char *kind, bool *other)
{
    char name[32] = PROGRAM, saved[32];
    uint64_t mark = BYTE_ORDER_MARK;
    strncat(name, kind, sizeof name - sizeof PROGRAM);
    memcpy(saved, name, sizeof saved);
    ARCHIVE_FIELD(archive, saved);
    *other = !archive->failed && memcmp(saved, PROGRAM, strlen(PROGRAM)) == 0 && memcmp(saved, name, sizeof name) != 0;
    if (*other) {
        saved[sizeof saved - 1] = '\0';
        text_make_printable(saved);
        archive_fail(archive, "it is a %s of " PROGRAM "and no %s", saved + strlen(PROGRAM), kind);
    } else if (memcmp(saved, name, sizeof name) != 0) {
        archive_fail(archive, "it is no %s of Twinlight", kind);
    }
    ARCHIVE_FIELD(archive, mark);
    if (mark != BYTE_ORDER_MARK)
        archive_fail(archive, "it was written by a machine of another byte order");
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
