/* Parts of file names. */
#ifndef TWINLIGHT_PATH_NAME_H
#define TWINLIGHT_PATH_NAME_H

#include <stdbool.h>

/* Whether the name ends in `ending` (".exr"), in any case, and is more than that. */
bool path_ends(const char *path, const char *ending);

/* What follows the last slash. */
const char *path_file_name(const char *path);

#endif
