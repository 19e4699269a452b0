/* Opens files for reading, and reads whole files into memory. */
#ifndef TWINLIGHT_BASE_FILE_READ_H
#define TWINLIGHT_BASE_FILE_READ_H

#include "base/error.h"

#include <stddef.h>
#include <sys/types.h>

typedef struct FileOpened {
    int descriptor; /* the caller closes it */
    size_t size;
    dev_t device; /* with `inode`, identifies the file whatever its name */
    ino_t inode;
} FileOpened;

typedef struct FileData {
    char *data; /* the caller frees it */
    size_t size;
} FileData;

/* Opens a regular file of at most `limit` bytes. Folders, devices and pipes are refused, because reading them may never
 * end. Errors name the path and are reported at `place` (place.file may be NULL). */
bool file_open(const char *path, size_t limit, SourcePlace place, FileOpened *file, Error *error);

/* Opens the file as above, reads all of it and closes it. */
bool file_read(const char *path, size_t limit, SourcePlace place, FileData *file, Error *error);

/* Reads a stream (pipe or file) of at most `limit` bytes to its end. `name` is used in errors. */
bool file_read_stream(int descriptor, const char *name, size_t limit, FileData *file, Error *error);

/* Sets "cannot read PATH: ..." for the errno `failure`. Returns false. */
bool file_read_error(const char *path, int failure, SourcePlace place, Error *error);

#endif
