/* What went wrong, where, and what to do about it. Every function that can fail for a reason outside the program
 * returns false (or NULL) and fills the caller's Error; only main prints one and exits. */
#ifndef TWINLIGHT_BASE_ERROR_H
#define TWINLIGHT_BASE_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A place in a text file. `file` is borrowed and may be NULL; line and column count from 1, 0 when unknown. */
typedef struct SourcePlace {
    const char *file;
    int line;
    int column;
} SourcePlace;

typedef struct Error {
    char message[768]; /* "room.pbrt:12:7: error: unknown material "glas"", empty when nothing failed */
    char fix[512]; /* "use diffuse, conductor, dielectric ...", may be empty */
} Error;

/* Replaces control characters by '?': what a file holds must not steer the terminal, nor break a message in two. */
void text_make_printable(char *text);

/* "file:line:column: ", without what is unknown; "" without a file. */
void place_print(char *out, size_t size, SourcePlace place);

/* Fills `error` with "error: MESSAGE" without a place. Returns false, so that callers can `return error_set(...)`. */
bool error_set(Error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same behind "file:line:column: ". */
bool error_at(Error *error, SourcePlace place, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* The message behind its place and the word "error". */
const char *error_text(const Error *error);

/* Puts "FILE: " before a message that has no place yet. Returns false. */
bool error_in(Error *error, const char *file);

/* Adds what to do. Returns false. */
bool error_fix(Error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The message, and what to do in a second line. */
void error_print(const Error *error, FILE *stream);

bool error_is_memory(const Error *error);

/* "error: out of memory: N bytes for WHAT". Returns false. */
bool error_memory(Error *error, unsigned long long bytes, const char *what);

/* Adds what to do about a failure to read or write a file. Returns false. */
bool error_fix_errno(Error *error, int number);

/* "error: cannot VERB PATH: strerror(errno)" with its fix. Returns false. */
bool error_errno(Error *error, const char *verb, const char *path);

#endif
