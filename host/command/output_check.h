/* Before work begins: can everything be written, and without overwriting what is read or another result? */
#ifndef TWINLIGHT_COMMAND_OUTPUT_CHECK_H
#define TWINLIGHT_COMMAND_OUTPUT_CHECK_H

#include "base/error.h"

typedef struct CommandFile {
    const char *what; /* "the PNG" */
    const char *path; /* NULL: there is none */
    bool written; /* else only read */
} CommandFile;

/* Fails when a file of this name could not be created: its folder is missing or not writable, or it is a folder. */
bool output_check(const char *path, Error *error);

/* Fails when one of the files that are written could not be created (output_check), or is the same file (path_same) as
 * another one of these, one that has been read (base/input_files.h), or one that standard input, output or error is
 * redirected to. `fix` is what to do about the same file. */
bool output_files_check(const CommandFile *files, size_t count, const char *fix, Error *error);

#endif
