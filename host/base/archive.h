/* Saves and restores the state of a computation. One function per kind of object names its fields in order: an archive
 * that saves copies them, one that restores overwrites them. So what is saved is what is restored.
 *
 * A failure sticks: the archive keeps the first error, and later calls do nothing. Numbers have the size and byte order
 * of the machine. */
#ifndef TWINLIGHT_BASE_ARCHIVE_H
#define TWINLIGHT_BASE_ARCHIVE_H

#include "base/error.h"

#include <float.h>
#include <stdint.h>

typedef struct Archive {
    bool saves; /* otherwise it restores */
    bool failed;
    Error error; /* if failed */
    /* Takes or fills in `size` bytes. */
    bool (*transfer)(void *context, void *bytes, size_t size, Error *error);
    void *context;
} Archive;

/* The numbers from `least` to `most`. */
typedef struct NumberRange {
    double least, most;
} NumberRange;

#define RANGE_FLOATS ((NumberRange){-(double)FLT_MAX, (double)FLT_MAX}) /* all finite floats */
#define RANGE_FLOATS_POSITIVE ((NumberRange){0.0, (double)FLT_MAX}) /* and those without a sign */

/* Saves or restores `size` bytes. */
void archive_bytes(Archive *archive, void *bytes, size_t size);

/* The same for a variable or an array of known size, without pointers. */
#define ARCHIVE_FIELD(archive, field) archive_bytes(archive, &(field), sizeof(field))

/* For what is known when restoring: fails, naming `what`, unless the value is the saved one. */
void archive_same(Archive *archive, uint64_t value, const char *what);

/* For a count that decides what memory is taken or which entries are read. Restoring fails, naming `what`, and leaves
 * the count as it is unless least <= count <= most. */
void archive_count(Archive *archive, uint32_t *count, uint32_t least, uint32_t most, const char *what);

/* For numbers that must lie in a range. Restoring fails, naming `what`, unless least <= number <= most for all of them;
 * NaN never is. What was read is in them all the same. */
void archive_doubles(Archive *archive, double *numbers, size_t count, NumberRange range, const char *what);
void archive_floats(Archive *archive, float *numbers, size_t count, NumberRange range, const char *what);

/* For truth values, each saved as a byte. Restoring fails, naming `what`, for a byte that is neither 0 nor 1. */
void archive_flags(Archive *archive, bool *flags, size_t count, const char *what);

/* A number of which every byte differs: read in another byte order it is another one. */
#define BYTE_ORDER_MARK 0x0102030405060708u

/* The beginning of a file: its kind ("checkpoint"), and a mark of the byte order. Restoring fails for another kind,
 * other byte order or anything else; *other is then whether it is another kind of file of this program. */
void archive_head(Archive *archive, const char *kind, bool *other);

/* Fails with this message unless it has failed before. */
void archive_fail(Archive *archive, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A growing buffer, empty when zeroed. */
typedef struct ArchiveMemory {
    unsigned char *bytes;
    size_t size, capacity;
} ArchiveMemory;

/* An archive that appends to the buffer. */
Archive archive_to_memory(ArchiveMemory *memory);
void archive_memory_destroy(ArchiveMemory *memory);

#endif
