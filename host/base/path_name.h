/* Parts of path names, and the files that they lead to. */
#ifndef TWINLIGHT_BASE_PATH_NAME_H
#define TWINLIGHT_BASE_PATH_NAME_H

#include <limits.h>
#include <stdbool.h>

/* Whether the name ends in `ending` (".exr"), ignoring case, and has something before it. */
bool path_ends(const char *path, const char *ending);

/* The part after the last slash. */
const char *path_file_name(const char *path);

/* The part before the last slash: "/" for "/a", "." for "a". `path` must be shorter than PATH_MAX. */
void path_folder(const char *path, char folder[PATH_MAX]);

/* target = absolute path of the file that opening `path` for writing would create or change. Symbolic links are
 * followed, also to files that do not exist. A path whose folder does not exist is copied unchanged. False with errno
 * set if the path is too long or has too many links. */
bool path_target(const char *path, char target[PATH_MAX]);

/* Whether two names lead to the same regular file, or both to the same name of a file that does not exist yet. */
bool path_same(const char *a, const char *b);

#endif
