/* Records which files have been read, so that no output overwrites one (command/output_check.h). Thread-safe. */
#ifndef TWINLIGHT_BASE_INPUT_FILES_H
#define TWINLIGHT_BASE_INPUT_FILES_H

#include <stdbool.h>
#include <sys/stat.h>

/* Must be called for every file that is part of the scene, textures included. */
void input_file_note(int descriptor);

/* Whether a file of this device and inode has been recorded. */
bool input_file_noted(const struct stat *status);

#endif
