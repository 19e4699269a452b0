/* Parts of file names, and where they lead. */
#ifndef TWINLIGHT_BASE_PATH_NAME_H
#define TWINLIGHT_BASE_PATH_NAME_H

#include <limits.h>
#include <stdbool.h>

/* Whether the name ends in `ending` (".exr"), in any case, and is more than that. */
bool path_ends(const char *path, const char *ending);

/* What follows the last slash. */
const char *path_file_name(const char *path);

/* What stands before it: "/" of "/a", "." of "a". `path` is shorter than PATH_MAX. */
void path_folder(const char *path, char folder[PATH_MAX]);

/* target = the file that opening `path` for writing would make or change: absolute, symbolic links followed, also one
 * to a file that is not there. As it is where its folder is not there. False with errno: too long, or too many
 * links. */
bool path_target(const char *path, char target[PATH_MAX]);

/* Whether two names lead to one regular file, or to one name at which there is no file yet. */
bool path_same(const char *a, const char *b);

#endif
