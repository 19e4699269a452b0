/* Temporary files beside those they will replace, so that a rename puts them there. No end of the program leaves one
 * for long: signals unlink those of this process (base/interrupt.c), and whoever writes to the same name next unlinks
 * those of processes that were killed. */
#ifndef TWINLIGHT_BASE_TEMPORARY_FILE_H
#define TWINLIGHT_BASE_TEMPORARY_FILE_H

#include <limits.h>

/* Creates "PATH.PROCESS-NUMBER~", after removing files of that pattern whose process is dead. Returns its descriptor,
 * open for writing, and fills in the name; -1 with errno. The file counts as dead once the descriptor is closed. */
int temporary_file_create(const char *path, char name[PATH_MAX]);

/* For a name that has been renamed or unlinked: temporary_files_unlink leaves it alone. Keeps errno. */
void temporary_file_forget(const char *name);

/* Unlinks all of this process. Async-signal-safe; the process must end right after. */
void temporary_files_unlink(void);

#endif
