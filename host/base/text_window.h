/* Text that is read through a window of fixed size, so that a file of any length takes little memory, or that lies in
 * memory as a whole. */
#ifndef TWINLIGHT_BASE_TEXT_WINDOW_H
#define TWINLIGHT_BASE_TEXT_WINDOW_H

#include <stdbool.h>
#include <stddef.h>

/* How much of a file is in memory at a time. At least half of it can be looked at from any position. */
#define TEXT_WINDOW_BYTES (1u << 18)

typedef struct TextWindow {
    const char *position; /* the reader's; it moves on as it likes up to `end` */
    const char *end; /* of what is in memory */
    const char *start; /* likewise */
    size_t before; /* bytes of the text before `start` */
    size_t limit; /* bytes that the text may have */
    char *buffer; /* owned; NULL for text in memory */
    int descriptor; /* owned; -1 for text in memory */
    int failure; /* 0, or the errno of what ended reading */
} TextWindow;

/* `text` is borrowed. */
void text_window_from_memory(TextWindow *window, const char *text, size_t length);

/* Takes the descriptor, which is closed by text_window_close even when this fails: no memory, or what reading says.
 * Text beyond `limit` bytes is the failure EFBIG. */
bool text_window_from_file(TextWindow *window, int descriptor, size_t limit);
void text_window_close(TextWindow *window);

/* Reads on, keeping what lies behind `position`, which moves with its text. False when nothing was added: the end of
 * the text, a failure, or a window full of text that is still wanted. */
bool text_window_read(TextWindow *window);

/* Is there a byte position[n]? Brings it in where it must; position moves then. */
static inline bool text_window_reaches(TextWindow *window, size_t n)
{
    return n < (size_t)(window->end - window->position) ||
           (n <= TEXT_WINDOW_BYTES / 2 && text_window_read(window) && n < (size_t)(window->end - window->position));
}

/* Where in the text `position` is. */
static inline size_t text_window_offset(const TextWindow *window)
{
    return window->before + (size_t)(window->position - window->start);
}

#endif
