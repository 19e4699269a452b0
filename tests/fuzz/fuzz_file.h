/* The file that a fuzzer's inputs are written to, for readers that need one. */
#ifndef TWINLIGHT_TESTS_FUZZ_FUZZ_FILE_H
#define TWINLIGHT_TESTS_FUZZ_FUZZ_FILE_H

#include "base/archive.h"

/* Its path, in TMPDIR or /tmp. The file is made at the first call, and removed when the process exits. */
char *fuzz_file(void);

/* Replaces its contents by these bytes, or by one frame of Zstandard that holds the head (which may be empty) and the
 * bytes. */
void fuzz_file_write(const void *data, size_t size);
void fuzz_file_compress(const ArchiveMemory *head, const void *data, size_t size);

#endif
