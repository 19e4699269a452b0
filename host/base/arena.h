/* Memory that lives and dies together: many small blocks, freed all at once. */
#ifndef TWINLIGHT_BASE_ARENA_H
#define TWINLIGHT_BASE_ARENA_H

#include "base/error.h"

#include <stddef.h>

typedef struct ArenaChunk ArenaChunk;

typedef struct Arena {
    ArenaChunk *chunks; /* newest first */
    size_t bytes; /* handed out so far */
} Arena;

/* `size` bytes aligned for any plain type, not cleared. NULL with `error` filled when memory is out. */
void *arena_alloc(Arena *arena, size_t size, Error *error);

/* A NUL-terminated copy of length characters. */
const char *arena_text(Arena *arena, const char *text, size_t length, Error *error);

/* Frees everything; the arena is empty and usable again. Safe on {0} and twice. */
void arena_destroy(Arena *arena);

#endif
