/* The kernels' source as one string: kernels.cl with all its includes expanded. Drivers need not read our files, and
 * the cache can hash the text. #line directives keep compiler messages at the original files and lines. */
#ifndef TWINLIGHT_PROGRAM_SOURCE_H
#define TWINLIGHT_PROGRAM_SOURCE_H

#include "base/error.h"

/* The folder of the kernel sources: $TWINLIGHT_KERNELS; else, for a program that is not installed, the source tree that
 * it was built from, if it exists; else the installation folder. */
const char *program_source_folder(void);

/* The text of `name` with its includes, each file once, to be freed by the caller. NULL if a file cannot be read. */
char *program_source_read(const char *folder, const char *name, Error *error);

#endif
