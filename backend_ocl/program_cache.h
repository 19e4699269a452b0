/* Built programs kept between runs: files in $XDG_CACHE_HOME/twinlight (~/.cache/twinlight), named by a hash of all
 * that goes into a build. A cache that cannot be read or written costs time, nothing else. */
#ifndef TWINLIGHT_PROGRAM_CACHE_H
#define TWINLIGHT_PROGRAM_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct CacheKey {
    uint64_t hash[2];
} CacheKey;

/* Hash of `count` strings, whose bounds count too. */
CacheKey cache_key(const char *const *strings, int count);

/* The program of this key, to be freed; NULL when there is none or it is not what was written. */
unsigned char *cache_read(CacheKey key, size_t *size);

/* False when it could not be written; `path` (at least PATH_MAX) then says where, or is "" when no folder is known. */
bool cache_write(CacheKey key, const unsigned char *binary, size_t size, char *path);

#endif
