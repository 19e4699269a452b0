#include "base/frame_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS "0123456789"

/* Length of the placeholder that begins here, 0 if there is none. */
static size_t place_length(const char *text)
{
    if (text[0] != '%')
        return 0;
    size_t digits = strspn(text + 1, DIGITS);
    return digits <= 2 && text[1 + digits] == 'd' ? digits + 2 : 0;
}

bool frame_name_has(const char *name)
{
    for (; *name; ++name)
        if (place_length(name) > 0)
            return true;
    return false;
}

const char *frame_name_fill(Arena *arena, const char *name, int frame, Error *error)
{
    size_t places = 0, used = 0;
    for (const char *c = name; *c; ++c)
        places += place_length(c) > 0;
    size_t size = strlen(name) + 100 * places + 1; /* a width has two digits at most */
    char *filled = arena_alloc(arena, size, error);
    while (filled && *name) {
        size_t length = place_length(name);
        if (length == 0) {
            filled[used++] = *name++;
            continue;
        }
        int width = (int)strtol(name + 1, NULL, 10);
        used += (size_t)snprintf(filled + used, size - used, name[1] == '0' ? "%0*d" : "%*d", width, frame);
        name += length;
    }
    if (filled)
        filled[used] = '\0';
    return filled;
}
