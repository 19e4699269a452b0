/* The kernels' text, as one string: kernels.cl with every file that it includes in its place. One text is what a driver
 * without a file system of ours can build, and what a cache can be keyed by; #line lines keep the compiler's messages
 * at our files and lines. */
#ifndef TWINLIGHT_PROGRAM_SOURCE_H
#define TWINLIGHT_PROGRAM_SOURCE_H

#include "base/error.h"

/* The folder of the kernels' sources: $TWINLIGHT_KERNELS, or where they were installed, or the sources that the program
 * was built from. */
const char *program_source_folder(void);

/* The text of `name` and all it includes, each file once; to be freed. NULL when a file cannot be read. */
char *program_source_read(const char *folder, const char *name, Error *error);

#endif
