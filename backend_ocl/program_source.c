#include "program_source.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILES_MAX 128
#define DEPTH_MAX 32

/* A growable text. */
typedef struct Text {
    char *bytes;
    size_t length, capacity;
} Text;

typedef struct Reader {
    const char *folder;
    Text out;
    char *files[FILES_MAX]; /* files included so far */
    int file_count;
    int depth;
    Error *error;
} Reader;

/* Whether this process runs the installed program. */
static bool program_is_installed(void)
{
    char path[PATH_MAX], folder[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0 || !realpath(PROGRAM_FOLDER, folder))
        return false;
    path[length] = '\0';
    *strrchr(path, '/') = '\0';
    return strcmp(path, folder) == 0;
}

const char *program_source_folder(void)
{
    const char *folder = getenv("TWINLIGHT_KERNELS");
    if (folder && folder[0])
        return folder;
    /* Run from its build tree, the program must not use the installed sources of another version. */
    return !program_is_installed() && access(KERNELS_BUILD "/kernels.cl", R_OK) == 0 ? KERNELS_BUILD
                                                                                     : KERNELS_INSTALLED;
}

static bool text_add(Reader *reader, const char *bytes, size_t length)
{
    Text *text = &reader->out;
    if (text->length + length + 1 > text->capacity) {
        size_t capacity = 2 * (text->length + length) + 4096;
        char *grown = realloc(text->bytes, capacity);
        if (!grown)
            return error_memory(reader->error, capacity, "the kernels' text");
        text->bytes = grown;
        text->capacity = capacity;
    }
    memcpy(text->bytes + text->length, bytes, length);
    text->length += length;
    text->bytes[text->length] = '\0';
    return true;
}

static bool text_add_line(Reader *reader, int line, const char *name)
{
    char directive[300];
    int length = snprintf(directive, sizeof directive, "#line %d \"shared/%s\"\n", line, name);
    return text_add(reader, directive, (size_t)length);
}

/* The name in a line `#include "name"`; NULL for other lines. Includes in angle brackets are for C only, inside #if. */
static const char *included_name(const char *line, char *name, size_t size)
{
    line += strspn(line, " \t");
    if (*line != '#')
        return NULL;
    line += 1 + strspn(line + 1, " \t");
    if (strncmp(line, "include", 7) != 0)
        return NULL;
    line += 7 + strspn(line + 7, " \t");
    size_t length = *line == '"' ? strcspn(line + 1, "\"\n") : 0;
    if (length == 0 || length >= size || line[1 + length] != '"')
        return NULL;
    memcpy(name, line + 1, length);
    name[length] = '\0';
    return name;
}

static bool already_read(const Reader *reader, const char *name)
{
    for (int i = 0; i < reader->file_count; ++i)
        if (strcmp(reader->files[i], name) == 0)
            return true;
    return false;
}

static FILE *file_open(Reader *reader, const char *name)
{
    char path[PATH_MAX];
    FILE *file = NULL;
    if ((size_t)snprintf(path, sizeof path, "%s/%s", reader->folder, name) < sizeof path)
        file = fopen(path, "r");
    if (!file) {
        error_errno(reader->error, "read the kernels' source", path);
        error_fix(reader->error, "install Twinlight (make install), or set TWINLIGHT_KERNELS to the folder shared/ of "
                                 "its sources");
    }
    return file;
}

static bool file_add(Reader *reader, const char *name);

static bool lines_add(Reader *reader, FILE *file, const char *name)
{
    char *line = NULL, included[256];
    size_t capacity = 0;
    bool done = text_add_line(reader, 1, name);
    ssize_t length = 0;
    for (int number = 1; done && (length = getline(&line, &capacity, file)) > 0; ++number) {
        if (included_name(line, included, sizeof included))
            done = file_add(reader, included) && text_add_line(reader, number + 1, name);
        else
            done = text_add(reader, line, (size_t)length);
    }
    free(line);
    if (done && ferror(file))
        done = error_set(reader->error, "cannot read the kernels' source %s/%s", reader->folder, name);
    return done;
}

/* Every file of shared/ has an include guard, so including it once is enough. */
static bool file_add(Reader *reader, const char *name)
{
    if (already_read(reader, name))
        return true;
    if (reader->file_count >= FILES_MAX || reader->depth >= DEPTH_MAX)
        return error_set(reader->error, "the kernels' sources in %s include too many files", reader->folder);
    char *copy = strdup(name);
    if (!copy)
        return error_memory(reader->error, strlen(name) + 1, "a file name");
    reader->files[reader->file_count++] = copy;
    FILE *file = file_open(reader, name);
    if (!file)
        return false;
    ++reader->depth;
    bool done = lines_add(reader, file, name);
    --reader->depth;
    fclose(file);
    return done;
}

char *program_source_read(const char *folder, const char *name, Error *error)
{
    Reader reader = {.folder = folder, .error = error};
    bool done = file_add(&reader, name);
    for (int i = 0; i < reader.file_count; ++i)
        free(reader.files[i]);
    if (!done) {
        free(reader.out.bytes);
        return NULL;
    }
    return reader.out.bytes;
}
