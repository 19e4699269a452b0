/* Cache of built programs between runs: files in $XDG_CACHE_HOME/twinlight (~/.cache/twinlight), named by a hash of
 * everything that goes into a build. A cache that cannot be read or written only costs time. */
#ifndef TWINLIGHT_PROGRAM_CACHE_H
#define TWINLIGHT_PROGRAM_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct CacheKey {
    uint64_t hash[2];
} CacheKey;

/* Hash of `count` strings, including where each one ends. */
CacheKey cache_key(const char *const *strings, int count);

/* The stored bytes for this key, to be freed by the caller; NULL if there are none or they are damaged. */
unsigned char *cache_read(CacheKey key, size_t *size);

/* False if the entry could not be written; `path` (at least PATH_MAX) then has its path, or "" if no folder is
 * known. */
bool cache_write(CacheKey key, const unsigned char *binary, size_t size, char *path);

#endif
