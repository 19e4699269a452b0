/* A text that is read through a window of fixed size, so that a file of any length needs little memory, or that is in
 * memory as a whole. */
#ifndef TWINLIGHT_BASE_TEXT_WINDOW_H
#define TWINLIGHT_BASE_TEXT_WINDOW_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes of a file in memory at a time. At least half of them can be read ahead of any position. */
#define TEXT_WINDOW_BYTES (1u << 18)

typedef struct TextWindow {
    const char *position; /* read position, advanced by the caller up to `end` */
    const char *end; /* end of the text in memory */
    const char *start; /* start of the text in memory */
    size_t before; /* bytes of the text before `start` */
    size_t limit; /* largest allowed length of the text, bytes */
    char *buffer; /* owned; NULL for text in memory that is not */
    int descriptor; /* owned; -1 for text in memory */
    int failure; /* errno of the error that ended reading; 0: none */
} TextWindow;

/* `text` is borrowed. */
void text_window_from_memory(TextWindow *window, const char *text, size_t length);

/* Takes ownership of `text`, which text_window_close frees. */
void text_window_from_owned(TextWindow *window, char *text, size_t length);

/* Takes ownership of the descriptor: text_window_close closes it even if this function fails. Fails when out of memory
 * or on a read error; text longer than `limit` bytes fails with EFBIG. */
bool text_window_from_file(TextWindow *window, int descriptor, size_t limit);
void text_window_close(TextWindow *window);

/* Reads more, keeping the unread text from `position` on; `position` moves along with it. False if nothing was added:
 * at the end of the text, on failure, or if the window is full of unread text. */
bool text_window_read(TextWindow *window);

/* Whether position[n] exists; reads more if necessary, which may move `position`. */
static inline bool text_window_reaches(TextWindow *window, size_t n)
{
    return n < (size_t)(window->end - window->position) ||
           (n <= TEXT_WINDOW_BYTES / 2 && text_window_read(window) && n < (size_t)(window->end - window->position));
}

/* Offset of `position` in the text, bytes. */
static inline size_t text_window_offset(const TextWindow *window)
{
    return window->before + (size_t)(window->position - window->start);
}

#endif
