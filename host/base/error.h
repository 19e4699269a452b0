/* Error messages: what went wrong, where, and how to fix it. Every function that can fail for a reason outside the
 * program returns false (or NULL) and fills the caller's Error; only main prints an Error and exits. */
#ifndef TWINLIGHT_BASE_ERROR_H
#define TWINLIGHT_BASE_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A position in a text file. `file` is borrowed and may be NULL; line and column count from 1, 0 if unknown. */
typedef struct SourcePlace {
    const char *file;
    int line;
    int column;
} SourcePlace;

typedef struct Error {
    char message[768]; /* "room.pbrt:12:7: error: unknown material "glas""; empty if nothing failed */
    char fix[512]; /* "use diffuse, conductor, dielectric ..."; may be empty */
} Error;

/* Replaces control characters by '?', so that text from a file can neither steer the terminal nor split a message. */
void text_make_printable(char *text);

/* Writes "file:line:column: ", leaving out what is unknown; "" without a file. */
void place_print(char *out, size_t size, SourcePlace place);

/* Sets the message to "error: MESSAGE", without a place. Returns false, so that callers can `return error_set(...)`. */
bool error_set(Error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Like error_set, with "file:line:column: " in front. */
bool error_at(Error *error, SourcePlace place, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* The message without its place and the word "error". */
const char *error_text(const Error *error);

/* Prepends "FILE: " to a message that has no place yet. Returns false. */
bool error_in(Error *error, const char *file);

/* Sets the fix. Returns false. */
bool error_fix(Error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the message and, on a second line, the fix. */
void error_print(const Error *error, FILE *stream);

/* Whether error_memory set this error. */
bool error_is_memory(const Error *error);

/* "error: out of memory: N bytes for WHAT". Returns false. */
bool error_memory(Error *error, unsigned long long bytes, const char *what);

/* Sets the fix for a failed read or write from its errno. Returns false. */
bool error_fix_errno(Error *error, int number);

/* "error: cannot VERB PATH: strerror(errno)", with a fix. Returns false. */
bool error_errno(Error *error, const char *verb, const char *path);

#endif
