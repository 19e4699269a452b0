#include "pbrt_lexer.h"

#include "text_number.h"

#include <string.h>

/* How much of a token an error message shows. */
#define TOKEN_SHOWN 40

bool lexer_init(Lexer *lexer, const char *text, size_t length, const char *file, Error *error)
{
    *lexer = (Lexer){.position = text, .end = text + length, .line_start = text, .file = file, .line = 1};
    const unsigned char *b = (const unsigned char *)text;
    SourcePlace place = {file, 1, 1};
    if (length >= 2 && ((b[0] == 0xfe && b[1] == 0xff) || (b[0] == 0xff && b[1] == 0xfe))) {
        error_at(error, place, "the file is UTF-16");
        return error_fix(error, "store it as UTF-8 or ASCII");
    }
    if (length >= 3 && b[0] == 0xef && b[1] == 0xbb && b[2] == 0xbf)
        lexer->position = lexer->line_start = text + 3;
    return true;
}

static void newline_count(Lexer *lexer, const char *after)
{
    ++lexer->line;
    lexer->line_start = after;
}

static void space_skip(Lexer *lexer)
{
    const char *p = lexer->position;
    for (; p < lexer->end; ++p) {
        if (*p == '\n') {
            newline_count(lexer, p + 1);
        } else if (*p == '#') {
            const char *newline = memchr(p, '\n', (size_t)(lexer->end - p));
            p = newline ? newline - 1 : lexer->end - 1;
        } else if (*p != ' ' && *p != '\t' && *p != '\r') {
            break;
        }
    }
    lexer->position = p;
}

/* From the opening quote on. */
static bool string_scan(Lexer *lexer, Token *token, Error *error)
{
    const char *p = lexer->position + 1;
    token->kind = TOKEN_STRING;
    token->text = p;
    for (; p < lexer->end && *p != '"'; ++p) {
        if (*p == '\\' && p + 1 < lexer->end)
            ++p;
        if (*p == '\n' || *p == '\0')
            break;
    }
    if (p >= lexer->end || *p != '"') {
        bool nul = p < lexer->end && *p == '\0';
        error_at(error, token->place, nul ? "a string holds a NUL byte" : "the string that begins here has no end");
        return error_fix(error, "close it with \" on the same line");
    }
    token->length = (size_t)(p - token->text);
    lexer->position = p + 1;
    return true;
}

static bool ends_word(char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '"' || c == '[' || c == ']';
}

bool lexer_next(Lexer *lexer, Token *token, Error *error)
{
    space_skip(lexer);
    const char *p = lexer->position;
    *token = (Token){.kind = TOKEN_END, .text = p};
    token->place = (SourcePlace){lexer->file, lexer->line, (int)(p - lexer->line_start) + 1};
    if (p == lexer->end)
        return true;
    if (*p == '"')
        return string_scan(lexer, token, error);
    token->kind = *p == '[' ? TOKEN_OPEN : *p == ']' ? TOKEN_CLOSE : TOKEN_WORD;
    do
        ++p;
    while (token->kind == TOKEN_WORD && p < lexer->end && !ends_word(*p));
    token->length = (size_t)(p - token->text);
    lexer->position = p;
    return true;
}

bool token_is(const Token *token, const char *word)
{
    size_t length = strlen(word);
    return token->kind == TOKEN_WORD && token->length == length && memcmp(token->text, word, length) == 0;
}

/* The character that backslash and `c` stand for, or 0. */
static char escape_decode(char c)
{
    static const char NAMES[] = "bfnrt\\'\"", VALUES[] = "\b\f\n\r\t\\'\"";
    const char *found = c ? strchr(NAMES, c) : NULL;
    return found ? VALUES[found - NAMES] : '\0';
}

const char *token_text(const Token *token, Arena *arena, Error *error)
{
    char *text = arena_alloc(arena, token->length + 1, error);
    if (!text)
        return NULL;
    size_t n = 0;
    for (size_t i = 0; i < token->length; ++i) {
        char c = token->text[i];
        if (c == '\\' && token->kind == TOKEN_STRING) {
            c = ++i < token->length ? escape_decode(token->text[i]) : '\0';
            if (!c) {
                error_at(error, token->place, "unknown escape \\%c in a string", token->text[i]);
                error_fix(error, "use \\b \\f \\n \\r \\t \\\\ \\' or \\\"");
                return NULL;
            }
        }
        text[n++] = c;
    }
    text[n] = '\0';
    return text;
}

bool token_unexpected(const Token *token, const char *wanted, Error *error)
{
    int shown = token->length < TOKEN_SHOWN ? (int)token->length : TOKEN_SHOWN;
    switch (token->kind) {
    case TOKEN_END:
        error_at(error, token->place, "expected %s, found the end of the file", wanted);
        return error_fix(error, "the file seems to be cut short: complete its last directive");
    case TOKEN_STRING:
        error_at(error, token->place, "expected %s, found the string \"%.*s\"", wanted, shown, token->text);
        return error_fix(error, "write %s in its place", wanted);
    default:
        error_at(error, token->place, "expected %s, found %.*s", wanted, shown, token->text);
        return error_fix(error, "write %s in its place", wanted);
    }
}

bool token_float(const Token *token, float *value, Error *error)
{
    NumberStatus status =
        token->kind == TOKEN_WORD ? number_float(token->text, token->length, value) : NUMBER_MALFORMED;
    if (status == NUMBER_OVERFLOW) {
        error_at(error, token->place, "%.*s is beyond the range of a float",
                 (int)(token->length < TOKEN_SHOWN ? token->length : TOKEN_SHOWN), token->text);
        return error_fix(error, "give a number from -3.4e38 to 3.4e38");
    }
    return status == NUMBER_OK || token_unexpected(token, "a number", error);
}

bool token_integer(const Token *token, int *value, Error *error)
{
    NumberStatus status =
        token->kind == TOKEN_WORD ? number_integer(token->text, token->length, value) : NUMBER_MALFORMED;
    if (status == NUMBER_OVERFLOW) {
        error_at(error, token->place, "%.*s is beyond the range of an integer",
                 (int)(token->length < TOKEN_SHOWN ? token->length : TOKEN_SHOWN), token->text);
        return error_fix(error, "give a whole number from -2147483648 to 2147483647");
    }
    return status == NUMBER_OK || token_unexpected(token, "an integer", error);
}
