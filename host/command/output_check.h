/* Checks, before any work, that every output can be written without overwriting an input or another output. */
#ifndef TWINLIGHT_COMMAND_OUTPUT_CHECK_H
#define TWINLIGHT_COMMAND_OUTPUT_CHECK_H

#include "base/error.h"

typedef struct CommandFile {
    const char *what; /* "the PNG" */
    const char *path; /* NULL: no such file */
    bool written; /* otherwise only read */
} CommandFile;

/* Fails if a file of this name could not be created: the folder is missing or not writable, or the name is a
 * folder's. */
bool output_check(const char *path, Error *error);

/* Checks the files marked `written`. Fails if one cannot be created (output_check) or is the same file (path_same) as
 * another in `files`, as one already read (base/input_files.h), or as one to which standard input, output or error is
 * redirected. fix: advice to the user for the case of the same file. */
bool output_files_check(const CommandFile *files, size_t count, const char *fix, Error *error);

#endif
