/* Files that are only read, and whole ones into memory. */
#ifndef TWINLIGHT_BASE_FILE_READ_H
#define TWINLIGHT_BASE_FILE_READ_H

#include "base/error.h"

#include <stddef.h>
#include <sys/types.h>

typedef struct FileOpened {
    int descriptor; /* the caller closes it */
    size_t size;
    dev_t device; /* with inode: which file it is, whatever its name */
    ino_t inode;
} FileOpened;

typedef struct FileData {
    char *data; /* the caller frees it */
    size_t size;
} FileData;

/* Opens a regular file of at most `limit` bytes. Folders, devices and pipes are refused, so that reading ends. Errors
 * stand at `place` (a file of NULL: at none) and name the path. */
bool file_open(const char *path, size_t limit, SourcePlace place, FileOpened *file, Error *error);

/* The same, and reads it. */
bool file_read(const char *path, size_t limit, SourcePlace place, FileData *file, Error *error);

/* Reads a stream of at most `limit` bytes to its end: a pipe or a file. `name` is for errors. */
bool file_read_stream(int descriptor, const char *name, size_t limit, FileData *file, Error *error);

/* "cannot read PATH: ..." for an errno. Returns false. */
bool file_read_error(const char *path, int failure, SourcePlace place, Error *error);

#endif
