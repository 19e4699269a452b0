#include "base/error.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>

void text_make_printable(char *text)
{
    for (; *text; ++text)
        if ((unsigned char)*text < 0x20 || *text == 0x7f)
            *text = '?';
}

void place_print(char *out, size_t size, SourcePlace place)
{
    if (!place.file)
        out[0] = '\0';
    else if (place.line <= 0)
        snprintf(out, size, "%s: ", place.file);
    else if (place.column <= 0)
        snprintf(out, size, "%s:%d: ", place.file, place.line);
    else
        snprintf(out, size, "%s:%d:%d: ", place.file, place.line, place.column);
}

static bool error_fill(Error *error, SourcePlace place, const char *format, va_list arguments)
{
    char where[512];
    place_print(where, sizeof where, place);
    int used = snprintf(error->message, sizeof error->message, "%serror: ", where);
    if (used >= 0 && (size_t)used < sizeof error->message)
        vsnprintf(error->message + used, sizeof error->message - (size_t)used, format, arguments);
    text_make_printable(error->message);
    error->fix[0] = '\0';
    return false;
}

bool error_set(Error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    error_fill(error, (SourcePlace){0}, format, arguments);
    va_end(arguments);
    return false;
}

bool error_at(Error *error, SourcePlace place, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    error_fill(error, place, format, arguments);
    va_end(arguments);
    return false;
}

const char *error_text(const Error *error)
{
    const char *word = strstr(error->message, "error: ");
    return word ? word + strlen("error: ") : error->message;
}

bool error_in(Error *error, const char *file)
{
    char text[sizeof error->message];
    if (strncmp(error->message, "error: ", strlen("error: ")) != 0)
        return false;
    memcpy(text, error->message, sizeof text);
    int used = snprintf(error->message, sizeof error->message, "%.400s: ", file);
    int room = (int)sizeof error->message - used - 1;
    snprintf(error->message + used, (size_t)room + 1, "%.*s", room, text);
    return false;
}

bool error_fix(Error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->fix, sizeof error->fix, format, arguments);
    va_end(arguments);
    text_make_printable(error->fix);
    return false;
}

void error_print(const Error *error, FILE *stream)
{
    fprintf(stream, "%s\n", error->message);
    if (error->fix[0])
        fprintf(stream, "  fix: %s\n", error->fix);
}

#define OUT_OF_MEMORY "out of memory: "

bool error_is_memory(const Error *error)
{
    return strncmp(error_text(error), OUT_OF_MEMORY, strlen(OUT_OF_MEMORY)) == 0;
}

bool error_memory(Error *error, unsigned long long bytes, const char *what)
{
    error_set(error, OUT_OF_MEMORY "%llu bytes for %s", bytes, what);
    return error_fix(error, "use a smaller scene, fewer threads, or a machine with more memory");
}

bool error_fix_errno(Error *error, int number)
{
    switch (number) {
    case ENOENT:
    case ENOTDIR:
    case ENAMETOOLONG:
        return error_fix(error, "check the name and its folder");
    case EACCES:
    case EPERM:
    case EROFS:
        return error_fix(error, "check the permissions, or use another folder");
    case ENOSPC:
    case EDQUOT:
        return error_fix(error, "free some space, or use another disk");
    case EFBIG:
        return error_fix(error, "use a smaller file");
    case EISDIR:
    case ENOTSUP:
        return error_fix(error, "give the name of an ordinary file");
    default:
        return error_fix(error, "try again, or use another file");
    }
}

bool error_errno(Error *error, const char *verb, const char *path)
{
    int number = errno;
    error_set(error, "cannot %s %s: %s", verb, path, strerror(number));
    return error_fix_errno(error, number);
}
