/* Which files have been read, so that none is overwritten (command/output_check.h). Thread-safe. */
#ifndef TWINLIGHT_BASE_INPUT_FILES_H
#define TWINLIGHT_BASE_INPUT_FILES_H

#include <stdbool.h>
#include <sys/stat.h>

/* To be called for every file that a scene or a texture comes from. */
void input_file_note(int descriptor);

bool input_file_noted(const struct stat *status);

#endif
