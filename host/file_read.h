/* Whole files into memory. */
#ifndef TWINLIGHT_FILE_READ_H
#define TWINLIGHT_FILE_READ_H

#include "error.h"

#include <stddef.h>
#include <sys/types.h>

typedef struct FileData {
    char *data; /* the caller frees it */
    size_t size;
    dev_t device; /* with inode: which file it is, whatever its name */
    ino_t inode;
} FileData;

/* Reads a regular file of at most `limit` bytes. Folders, devices and pipes are refused, so that reading ends. Errors
 * stand at `place` (a file of NULL: at none) and name the path. */
bool file_read(const char *path, size_t limit, SourcePlace place, FileData *file, Error *error);

#endif
