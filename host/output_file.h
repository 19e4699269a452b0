/* Files that are whole or not there: written under another name in the same folder and renamed at the end. */
#ifndef TWINLIGHT_OUTPUT_FILE_H
#define TWINLIGHT_OUTPUT_FILE_H

#include "error.h"

#include <limits.h>

typedef struct OutputFile {
    int descriptor; /* open for writing, -1 when not */
    char path[PATH_MAX]; /* where it ends up; symbolic links followed */
    char temporary[PATH_MAX]; /* "" when written in place (a device or pipe) */
} OutputFile;

/* Opens the temporary file. Fails, naming `path`, when the folder is missing or not writable. */
bool output_file_begin(OutputFile *file, const char *path, Error *error);

/* Closes and renames; on failure the temporary file is removed. */
bool output_file_commit(OutputFile *file, Error *error);

/* Closes and removes the temporary file. Safe after either of the above, and on {.descriptor = -1}. */
void output_file_cancel(OutputFile *file);

/* A whole file of these bytes. */
bool output_file_write(const char *path, const void *bytes, size_t size, Error *error);

#endif
