/* Arena allocator: many small blocks that are freed all at once. */
#ifndef TWINLIGHT_BASE_ARENA_H
#define TWINLIGHT_BASE_ARENA_H

#include "base/error.h"

#include <stddef.h>

typedef struct ArenaChunk ArenaChunk;

typedef struct Arena {
    ArenaChunk *chunks; /* newest first */
    size_t bytes; /* handed out so far */
} Arena;

/* Returns `size` bytes, aligned for any plain type and not cleared; NULL with `error` filled when out of memory. */
void *arena_alloc(Arena *arena, size_t size, Error *error);

/* Returns a NUL-terminated copy of `length` characters; NULL with `error` filled when out of memory. */
const char *arena_text(Arena *arena, const char *text, size_t length, Error *error);

/* Frees all blocks; the arena is then empty and can be used again. Safe on {0} and twice. */
void arena_destroy(Arena *arena);

#endif
