/* Temporary files next to the files that they will replace by a rename. They do not outlive the program for long:
 * signal handlers unlink those of this process (base/interrupt.c), and the next process that writes to the same name
 * unlinks those of killed ones. */
#ifndef TWINLIGHT_BASE_TEMPORARY_FILE_H
#define TWINLIGHT_BASE_TEMPORARY_FILE_H

#include <limits.h>

/* Creates "PATH.PROCESS-NUMBER~", after removing files of that pattern whose process has ended. Returns its descriptor,
 * open for writing, and fills in `name`; -1 with errno set on failure. Must stay open while the file is in use: closing
 * the descriptor releases the lock, and the file then counts as a stray. */
int temporary_file_create(const char *path, char name[PATH_MAX]);

/* Must be called once `name` has been renamed or unlinked: temporary_files_unlink then leaves it alone. Preserves
 * errno. */
void temporary_file_forget(const char *name);

/* Unlinks all temporary files of this process. Async-signal-safe; the process must end right after. */
void temporary_files_unlink(void);

#endif
