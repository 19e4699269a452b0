/* Tokens of pbrt-v4's text format, with their places. */
#ifndef TWINLIGHT_PBRT_LEXER_H
#define TWINLIGHT_PBRT_LEXER_H

#include "arena.h"

typedef enum TokenKind {
    TOKEN_END,
    TOKEN_WORD, /* a directive, a number, true, false */
    TOKEN_STRING, /* text without its quotes, escapes not yet decoded */
    TOKEN_OPEN, /* [ */
    TOKEN_CLOSE /* ] */
} TokenKind;

typedef struct Token {
    TokenKind kind;
    const char *text; /* borrowed from the file's text */
    size_t length;
    SourcePlace place;
} Token;

typedef struct Lexer {
    const char *position, *end;
    const char *line_start;
    const char *file;
    int line;
} Lexer;

/* `text` and `file` are borrowed for as long as the lexer and its tokens are used. Fails on UTF-16. */
bool lexer_init(Lexer *lexer, const char *text, size_t length, const char *file, Error *error);

/* Reads the next token; comments (# to the end of the line) are skipped. */
bool lexer_next(Lexer *lexer, Token *token, Error *error);

/* Is this the word `word`? */
bool token_is(const Token *token, const char *word);

/* The token's text, NUL-terminated in `arena`; escapes (\b \f \n \r \t \\ \' \") of a string decoded. NULL on error. */
const char *token_text(const Token *token, Arena *arena, Error *error);

/* "error: expected WANTED, found TOKEN" at the token. Returns false. */
bool token_unexpected(const Token *token, const char *wanted, Error *error);

/* The token as a number, an error at its place when it is none. */
bool token_float(const Token *token, float *value, Error *error);
bool token_integer(const Token *token, int *value, Error *error);

#endif
