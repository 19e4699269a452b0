#include "base/text_window.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void text_window_from_memory(TextWindow *window, const char *text, size_t length)
{
    *window = (TextWindow){.position = text, .start = text, .end = text + length, .limit = length, .descriptor = -1};
}

void text_window_from_owned(TextWindow *window, char *text, size_t length)
{
    text_window_from_memory(window, text, length);
    window->buffer = text;
}

bool text_window_from_file(TextWindow *window, int descriptor, size_t limit)
{
    *window = (TextWindow){.limit = limit, .descriptor = descriptor, .buffer = malloc(TEXT_WINDOW_BYTES)};
    window->position = window->start = window->end = window->buffer;
    if (!window->buffer)
        window->failure = ENOMEM;
    else
        text_window_read(window);
    return window->failure == 0;
}

void text_window_close(TextWindow *window)
{
    if (window->descriptor >= 0)
        close(window->descriptor);
    free(window->buffer);
    *window = (TextWindow){.descriptor = -1};
}

/* Moves the unread text to the start of the buffer and returns its length. */
static size_t text_keep(TextWindow *window)
{
    size_t kept = (size_t)(window->end - window->position);
    window->before = text_window_offset(window);
    memmove(window->buffer, window->position, kept);
    window->position = window->start;
    window->end = window->start + kept;
    return kept;
}

bool text_window_read(TextWindow *window)
{
    if (window->descriptor < 0 || window->failure != 0)
        return false;
    size_t kept = text_keep(window);
    ssize_t got;
    do
        got = read(window->descriptor, window->buffer + kept, TEXT_WINDOW_BYTES - kept);
    while (got < 0 && errno == EINTR);
    if (got < 0) {
        window->failure = errno;
        return false;
    }
    window->end += got;
    if (window->before + kept + (size_t)got > window->limit)
        window->failure = EFBIG;
    return got > 0 && window->failure == 0;
}
