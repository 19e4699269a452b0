/* Commit, compiler and machine as text, for benchmark reports. */
#ifndef TWINLIGHT_BASE_BUILD_INFO_H
#define TWINLIGHT_BASE_BUILD_INFO_H

#include <stddef.h>

/* "3d7bc78", "3d7bc78-dirty", or "unknown" for a build outside a repository. */
const char *build_commit(void);

/* For example "GCC 12.2.0" or "Clang 14.0.6", and whether assertions are on. */
const char *build_compiler(void);

/* "Intel Xeon ..., 8 processors, 32 GiB, Linux 6.1". */
void build_machine(char *text, size_t size);

#endif
