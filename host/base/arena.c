#include "base/arena.h"

#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK_BYTES 65536

struct ArenaChunk {
    ArenaChunk *next;
    size_t used, size;
    alignas(max_align_t) char data[];
};

static size_t size_aligned(size_t size)
{
    return (size + alignof(max_align_t) - 1) / alignof(max_align_t) * alignof(max_align_t);
}

void *arena_alloc(Arena *arena, size_t size, Error *error)
{
    size_t needed = size_aligned(size > 0 ? size : 1);
    ArenaChunk *chunk = arena->chunks;
    if (!chunk || chunk->size - chunk->used < needed) {
        size_t capacity = needed > CHUNK_BYTES / 4 ? needed : CHUNK_BYTES;
        ArenaChunk *fresh = malloc(sizeof *fresh + capacity);
        if (!fresh) {
            error_memory(error, capacity, "the scene's description");
            return NULL;
        }
        fresh->used = 0;
        fresh->size = capacity;
        /* A large block gets a chunk of its own, behind the first one, which still has room. */
        ArenaChunk **link = chunk && capacity == needed ? &chunk->next : &arena->chunks;
        fresh->next = *link;
        *link = fresh;
        chunk = fresh;
    }
    void *block = chunk->data + chunk->used;
    chunk->used += needed;
    arena->bytes += needed;
    return block;
}

const char *arena_text(Arena *arena, const char *text, size_t length, Error *error)
{
    char *copy = arena_alloc(arena, length + 1, error);
    if (!copy)
        return NULL;
    memcpy(copy, text, length);
    copy[length] = '\0';
    return copy;
}

void arena_destroy(Arena *arena)
{
    ArenaChunk *chunk = arena->chunks;
    while (chunk) {
        ArenaChunk *next = chunk->next;
        free(chunk);
        chunk = next;
    }
    *arena = (Arena){0};
}
