/* Files that are whole or not there: written under another name in the same folder (base/temporary_file.h), brought to
 * disk and renamed at the end. Until then an old file of the name stays. */
#ifndef TWINLIGHT_BASE_OUTPUT_FILE_H
#define TWINLIGHT_BASE_OUTPUT_FILE_H

#include "base/error.h"

#include <limits.h>

typedef struct OutputFile {
    int descriptor; /* open for writing, -1 when not */
    char path[PATH_MAX]; /* where it ends up; symbolic links followed (path_target) */
    char temporary[PATH_MAX]; /* "" when written in place (a device or pipe) */
} OutputFile;

/* Opens the temporary file. Fails, naming `path`, when the folder is missing or not writable. */
bool output_file_begin(OutputFile *file, const char *path, Error *error);

/* Writes through to the disk, renames and closes; on failure the temporary file is removed. */
bool output_file_commit(OutputFile *file, Error *error);

/* Closes and removes the temporary file. Safe after either of the above, and on {.descriptor = -1}. */
void output_file_cancel(OutputFile *file);

/* Writes bytes at the end; false with errno. */
bool output_file_bytes(OutputFile *file, const void *bytes, size_t size);

/* A stream to the file, which output_file_stream_commit closes; NULL with an error, and the file is cancelled. */
FILE *output_file_stream(OutputFile *file, Error *error);
bool output_file_stream_commit(OutputFile *file, FILE *stream, Error *error);

/* A whole file of these bytes. */
bool output_file_write(const char *path, const void *bytes, size_t size, Error *error);

#endif
