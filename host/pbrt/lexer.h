/* Lexer of pbrt-v4's text format. */
#ifndef TWINLIGHT_PBRT_LEXER_H
#define TWINLIGHT_PBRT_LEXER_H

#include "base/arena.h"
#include "base/text_window.h"

/* Maximum length of a word or string, which bounds the memory of a token; no known scene comes near it. */
#define TOKEN_LENGTH_MAX 65536

typedef enum TokenKind {
    TOKEN_END,
    TOKEN_WORD, /* a directive, a number, true, false */
    TOKEN_STRING, /* text without quotes, escapes not yet decoded */
    TOKEN_OPEN, /* [ */
    TOKEN_CLOSE /* ] */
} TokenKind;

typedef struct Token {
    TokenKind kind;
    const char *text; /* borrowed from the lexer until the next token; for a text in memory, as long as that exists */
    size_t length;
    SourcePlace place;
} Token;

typedef struct Lexer {
    TextWindow window;
    size_t line_start; /* offset in the text, bytes */
    const char *file;
    int line;
} Lexer;

/* Takes ownership of the window (fewer than INT_MAX bytes). Fails, and closes it, if the text is UTF-16. `file`, a name
 * for messages, must outlive the lexer and its tokens. */
bool lexer_init(Lexer *lexer, const TextWindow *window, const char *file, Error *error);
void lexer_destroy(Lexer *lexer);

/* Reads the next token, skipping comments (# to the end of the line). */
bool lexer_next(Lexer *lexer, Token *token, Error *error);

/* Whether the token is the word `word`. */
bool token_is(const Token *token, const char *word);

/* The token's text, NUL-terminated in `arena`, with the escapes of a string (\b \f \n \r \t \\ \' \") decoded. NULL
 * with `error` filled on failure. */
const char *token_text(const Token *token, Arena *arena, Error *error);

/* "error: expected WANTED, found TOKEN" at the token's place. Returns false. */
bool token_unexpected(const Token *token, const char *wanted, Error *error);

/* The token as a number, or an error at its place. */
bool token_float(const Token *token, float *value, Error *error);
bool token_integer(const Token *token, int *value, Error *error);

#endif
