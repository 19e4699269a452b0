/* Output files that appear whole or not at all: written to a temporary file in the same folder (base/temporary_file.h),
 * synchronised to disk and renamed at the end. Until then an old file of that name stays. */
#ifndef TWINLIGHT_BASE_OUTPUT_FILE_H
#define TWINLIGHT_BASE_OUTPUT_FILE_H

#include "base/error.h"

#include <limits.h>

typedef struct OutputFile {
    int descriptor; /* open for writing; -1 if not */
    char path[PATH_MAX]; /* final path, symbolic links resolved (path_target) */
    char temporary[PATH_MAX]; /* "" if written in place (a device or pipe) */
} OutputFile;

/* Opens the temporary file. Fails, naming `path`, if the folder is missing or not writable. */
bool output_file_begin(OutputFile *file, const char *path, Error *error);

/* Synchronises to disk, renames and closes. On failure removes the temporary file. */
bool output_file_commit(OutputFile *file, Error *error);

/* Closes and removes the temporary file. Harmless after a failed begin, after a commit, and on {.descriptor = -1}. */
void output_file_cancel(OutputFile *file);

/* Appends bytes; false with errno set. */
bool output_file_bytes(OutputFile *file, const void *bytes, size_t size);

/* Opens a stream to the file, to be closed by output_file_stream_commit. On failure returns NULL with `error` filled,
 * and the file is cancelled. */
FILE *output_file_stream(OutputFile *file, Error *error);
bool output_file_stream_commit(OutputFile *file, FILE *stream, Error *error);

/* Writes a whole file with the given contents. */
bool output_file_write(const char *path, const void *bytes, size_t size, Error *error);

#endif
