#include "gltf/memory_files.h"

#include <stdlib.h>
#include <string.h>

/* A file in memory, followed by zeros up to `size`. */
typedef struct MemoryFile {
    struct aiFile file;
    const unsigned char *data;
    size_t data_size, size, position;
} MemoryFile;

static MemoryFile *memory_file(struct aiFile *file)
{
    return (MemoryFile *)(void *)file->UserData;
}

static size_t memory_read(struct aiFile *file, char *out, size_t size, size_t count)
{
    MemoryFile *memory = memory_file(file);
    size_t left = memory->size - memory->position, whole = size > 0 ? left / size : 0;
    count = count < whole ? count : whole;
    size_t bytes = size * count;
    size_t real = memory->position < memory->data_size ? memory->data_size - memory->position : 0;
    real = real < bytes ? real : bytes;
    if (real > 0)
        memcpy(out, memory->data + memory->position, real);
    memset(out + real, 0, bytes - real);
    memory->position += bytes;
    return count;
}

static size_t memory_write(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file;
    (void)data;
    (void)size;
    (void)count;
    return 0;
}

static size_t memory_tell(struct aiFile *file)
{
    return memory_file(file)->position;
}

static size_t memory_size(struct aiFile *file)
{
    return memory_file(file)->size;
}

static enum aiReturn memory_seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    MemoryFile *memory = memory_file(file);
    size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? memory->position : memory->size;
    if (offset > memory->size - base)
        return aiReturn_FAILURE;
    memory->position = base + offset;
    return aiReturn_SUCCESS;
}

static void memory_flush(struct aiFile *file)
{
    (void)file;
}

/* The document, or buffer N by the name N.bin. */
static struct aiFile *memory_open(struct aiFileIO *io, const char *name, const char *mode)
{
    const MemoryFiles *files = (const MemoryFiles *)(void *)io->UserData;
    const char *last = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
    char *end;
    (void)mode;
    MemoryFile *memory = calloc(1, sizeof *memory);
    if (!memory)
        return NULL;
    size_t index = strtoul(last, &end, 10);
    if (strcmp(last, DOCUMENT_NAME) == 0) {
        memory->data = (const unsigned char *)files->document;
        memory->data_size = memory->size = strlen(files->document);
    } else if (strcmp(end, ".bin") == 0 && end != last && index < files->buffer_count) {
        memory->data = files->buffers[index].data;
        memory->data_size = files->buffers[index].size;
        memory->size = memory->data_size + BUFFER_PADDING;
    } else {
        free(memory);
        return NULL;
    }
    memory->file = (struct aiFile){
        memory_read, memory_write, memory_tell, memory_size, memory_seek, memory_flush, (aiUserData)(void *)memory};
    return &memory->file;
}

static void memory_close(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    free(memory_file(file));
}

struct aiFileIO memory_files_io(MemoryFiles *files)
{
    return (struct aiFileIO){memory_open, memory_close, (aiUserData)(void *)files};
}
