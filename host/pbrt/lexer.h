/* Tokens of pbrt-v4's text format, with their places. */
#ifndef TWINLIGHT_PBRT_LEXER_H
#define TWINLIGHT_PBRT_LEXER_H

#include "base/arena.h"
#include "base/text_window.h"

/* Characters of a word or of a string: no scene met so far comes near, and memory for a token is bounded. */
#define TOKEN_LENGTH_MAX 65536

typedef enum TokenKind {
    TOKEN_END,
    TOKEN_WORD, /* a directive, a number, true, false */
    TOKEN_STRING, /* text without its quotes, escapes not yet decoded */
    TOKEN_OPEN, /* [ */
    TOKEN_CLOSE /* ] */
} TokenKind;

typedef struct Token {
    TokenKind kind;
    const char *text; /* borrowed from the lexer until its next token; the text's own when that lies in memory */
    size_t length;
    SourcePlace place;
} Token;

typedef struct Lexer {
    TextWindow window;
    size_t line_start; /* offset in the text */
    const char *file;
    int line;
} Lexer;

/* The lexer takes the window, of fewer than INT_MAX bytes, and closes it when it fails: on UTF-16. `file`, a name for
 * messages, is borrowed for as long as the lexer and its tokens are used. */
bool lexer_init(Lexer *lexer, const TextWindow *window, const char *file, Error *error);
void lexer_destroy(Lexer *lexer);

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
