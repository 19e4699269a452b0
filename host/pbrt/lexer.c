#include "pbrt/lexer.h"

#include "base/text_number.h"

#include <string.h>

/* Characters of a token shown in an error message. */
#define TOKEN_SHOWN 40

bool lexer_init(Lexer *lexer, const TextWindow *window, const char *file, Error *error)
{
    *lexer = (Lexer){.window = *window, .file = file, .line = 1};
    text_window_reaches(&lexer->window, 2);
    const unsigned char *b = (const unsigned char *)lexer->window.position;
    size_t length = (size_t)(lexer->window.end - lexer->window.position);
    if (length >= 2 && ((b[0] == 0xfe && b[1] == 0xff) || (b[0] == 0xff && b[1] == 0xfe))) {
        error_at(error, (SourcePlace){file, 1, 1}, "the file is UTF-16");
        lexer_destroy(lexer);
        return error_fix(error, "store it as UTF-8 or ASCII");
    }
    if (length >= 3 && b[0] == 0xef && b[1] == 0xbb && b[2] == 0xbf) {
        lexer->window.position += 3;
        lexer->line_start = 3;
    }
    return true;
}

void lexer_destroy(Lexer *lexer)
{
    text_window_close(&lexer->window);
}

/* Skips to the next token, or to the end of the readable text. */
static void space_skip(Lexer *lexer)
{
    TextWindow *window = &lexer->window;
    bool comment = false;
    for (; text_window_reaches(window, 0); ++window->position) {
        char c = *window->position;
        if (c == '\n') {
            comment = false;
            ++lexer->line;
            lexer->line_start = text_window_offset(window) + 1;
        } else if (comment) {
            const char *newline = memchr(window->position, '\n', (size_t)(window->end - window->position));
            window->position = (newline ? newline : window->end) - 1;
        } else if (c == '#') {
            comment = true;
        } else if (c != ' ' && c != '\t' && c != '\r') {
            break;
        }
    }
}

static bool ends_word(char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '"' || c == '[' || c == ']';
}

/* Length of the word at the current position. */
static size_t word_length(Lexer *lexer)
{
    TextWindow *window = &lexer->window;
    size_t n = 1;
    while (n <= TOKEN_LENGTH_MAX && text_window_reaches(window, n) && !ends_word(window->position[n]))
        ++n;
    return n;
}

/* Length of the string at the current position, from the opening quote up to (not including) the closing quote, or up
 * to where one is missing. */
static size_t string_length(Lexer *lexer)
{
    TextWindow *window = &lexer->window;
    size_t n = 1;
    for (; n <= TOKEN_LENGTH_MAX + 1 && text_window_reaches(window, n) && window->position[n] != '"'; ++n) {
        if (window->position[n] == '\\' && text_window_reaches(window, n + 1))
            ++n;
        if (window->position[n] == '\n' || window->position[n] == '\0')
            break;
    }
    return n;
}

static bool string_end_check(Lexer *lexer, const Token *token, size_t length, Error *error)
{
    char end = text_window_reaches(&lexer->window, length) ? lexer->window.position[length] : '\n';
    if (end == '"')
        return true;
    error_at(error, token->place, end == '\0' ? "a string holds a NUL byte" : "the string that begins here has no end");
    return error_fix(error, "close it with \" on the same line");
}

/* Reports a read error that ended the text early. */
static bool failure_report(const Lexer *lexer, SourcePlace place, Error *error)
{
    int failure = lexer->window.failure;
    if (failure == 0)
        return true;
    error_at(error, place, "cannot read on: %s", strerror(failure));
    return error_fix_errno(error, failure);
}

bool lexer_next(Lexer *lexer, Token *token, Error *error)
{
    TextWindow *window = &lexer->window;
    space_skip(lexer);
    *token = (Token){.kind = TOKEN_END, .text = window->position};
    token->place = (SourcePlace){lexer->file, lexer->line, (int)(text_window_offset(window) - lexer->line_start) + 1};
    if (!text_window_reaches(window, 0))
        return failure_report(lexer, token->place, error);
    char c = *window->position;
    bool string = c == '"';
    token->kind = string ? TOKEN_STRING : c == '[' ? TOKEN_OPEN : c == ']' ? TOKEN_CLOSE : TOKEN_WORD;
    size_t length = string ? string_length(lexer) : token->kind == TOKEN_WORD ? word_length(lexer) : 1;
    if (length - string > TOKEN_LENGTH_MAX) {
        error_at(error, token->place, "%s of more than %d characters", string ? "a string" : "a word",
                 TOKEN_LENGTH_MAX);
        return error_fix(error, string ? "shorten it, or close it with \"" : "put spaces between its parts");
    }
    if (!failure_report(lexer, token->place, error) || (string && !string_end_check(lexer, token, length, error)))
        return false;
    token->text = window->position + string;
    token->length = length - string;
    window->position += length + string;
    return true;
}

bool token_is(const Token *token, const char *word)
{
    size_t length = strlen(word);
    return token->kind == TOKEN_WORD && token->length == length && memcmp(token->text, word, length) == 0;
}

/* The character for backslash `c`, or 0 if there is no such escape. */
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
