/* Files compressed by gzip. */
#ifndef TWINLIGHT_BASE_GZIP_H
#define TWINLIGHT_BASE_GZIP_H

#include "base/array.h"

/* Whether data that begin so are a gzip file. */
bool gzip_is(const char *data, size_t size);

/* Appends to `out`, an Array of char, what the members of a gzip file decompress to. Fails, without a place in the
 * error, if that is more than `limit` bytes or the file is damaged: deflate expands up to 1032-fold, so without a limit
 * a small file could take all memory. */
bool gzip_inflate(const char *data, size_t size, size_t limit, Array *out, Error *error);

/* The same for data in zlib's own format. */
bool zlib_inflate(const char *data, size_t size, size_t limit, Array *out, Error *error);

#endif
