#include "pbrt/parser.h"

#include "base/file_read.h"
#include "base/gzip.h"
#include "scene/format.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Recognises other file formats by their first bytes, and by the name unless it is NULL. */
static bool format_check(TextWindow *window, const char *name, Error *error)
{
    const char *fix, *other;
    text_window_reaches(window, 64);
    other = scene_format_other(window->position, (size_t)(window->end - window->position), &fix);
    if (!other && name)
        other = scene_format_named(name, &fix);
    if (!other)
        return true;
    error_at(error, (SourcePlace){.file = name}, "this is not a pbrt-v4 scene, but %s", other);
    return error_fix(error, "%s", fix);
}

bool parser_open_text(PbrtImport *im, TextWindow *window, const char *name)
{
    SourceFile *file = &im->files[im->file_count];
    if (im->file_count == 0 && !format_check(window, name, im->error)) {
        text_window_close(window);
        return false;
    }
    *file = (SourceFile){.nesting = im->saved.count};
    if (!lexer_init(&file->lexer, window, name, im->error))
        return false;
    ++im->file_count;
    return true;
}

static bool include_cyclic(const PbrtImport *im, const FileOpened *opened)
{
    for (int i = 0; i < im->file_count; ++i)
        if (im->files[i].is_file && im->files[i].device == opened->device && im->files[i].inode == opened->inode)
            return true;
    return false;
}

static bool include_counted(PbrtImport *im, SourcePlace place)
{
    if (im->file_count >= IMPORT_INCLUDE_MAX) {
        error_at(im->error, place, "files include each other more than %d deep", IMPORT_INCLUDE_MAX);
        return error_fix(im->error, "put what they share into one file");
    }
    if (++im->files_opened > IMPORT_FILES_MAX) {
        error_at(im->error, place, "the scene includes more than %d files", IMPORT_FILES_MAX);
        return error_fix(im->error, "join some of them");
    }
    return true;
}

/* Decompresses the file to the window, which is the whole file now. */
static bool gzip_open(const FileOpened *opened, const char *path, SourcePlace place, TextWindow *window, Error *error)
{
    FileData packed;
    Array text;
    Error reason = {{0}, {0}};
    if (!file_read_stream(opened->descriptor, path, IMPORT_FILE_BYTES_MAX, &packed, error))
        return false;
    array_init(&text, 1);
    bool good = gzip_inflate(packed.data, packed.size, IMPORT_FILE_BYTES_MAX, &text, &reason);
    free(packed.data);
    if (good) {
        text_window_close(window);
        text_window_from_owned(window, text.data, text.count);
        return true;
    }
    array_destroy(&text);
    if (error_is_memory(&reason)) {
        *error = reason;
        return false;
    }
    error_at(error, place, "cannot read %s: %s", path, error_text(&reason));
    return error_fix(error, "%s", reason.fix);
}

/* Opens the window on a file, decompressed if it is compressed by gzip. */
static bool window_open(const FileOpened *opened, const char *path, SourcePlace place, TextWindow *window, Error *error)
{
    if (!text_window_from_file(window, opened->descriptor, IMPORT_FILE_BYTES_MAX)) {
        file_read_error(path, window->failure, place, error);
        text_window_close(window);
        return false;
    }
    if (!gzip_is(window->position, (size_t)(window->end - window->position)))
        return true;
    if (lseek(opened->descriptor, 0, SEEK_SET) == 0 && gzip_open(opened, path, place, window, error))
        return true;
    text_window_close(window);
    return false;
}

bool parser_open_file(PbrtImport *im, const char *name, SourcePlace place, bool is_import)
{
    const char *path = place.file ? import_path(im, name) : name;
    const char *shown = path ? arena_text(&im->arena, path, strlen(path), im->error) : NULL;
    if (!shown || !include_counted(im, place))
        return false;
    FileOpened opened;
    TextWindow window;
    if (!file_open(path, IMPORT_FILE_BYTES_MAX, place, &opened, im->error))
        return false;
    if (include_cyclic(im, &opened)) {
        close(opened.descriptor);
        error_at(im->error, place, "%s includes itself", path);
        return error_fix(im->error, "delete this line");
    }
    if (!window_open(&opened, path, place, &window, im->error))
        return false;
    if (!parser_open_text(im, &window, shown))
        return false;
    SourceFile *file = &im->files[im->file_count - 1];
    file->is_file = true;
    file->device = opened.device;
    file->inode = opened.inode;
    file->is_import = is_import;
    return true;
}

void parser_close(PbrtImport *im)
{
    lexer_destroy(&im->files[--im->file_count].lexer);
}

void parser_close_all(PbrtImport *im)
{
    while (im->file_count > 0)
        parser_close(im);
}

bool parser_next(PbrtImport *im, Token *token)
{
    if (im->has_pending) {
        *token = im->pending;
        im->has_pending = false;
        return true;
    }
    for (;;) {
        SourceFile *file = &im->files[im->file_count - 1];
        if (!lexer_next(&file->lexer, token, im->error))
            return false;
        if (token->kind != TOKEN_END || file->is_import || im->file_count == 1)
            return true;
        parser_close(im);
    }
}

void parser_put_back(PbrtImport *im, const Token *token)
{
    im->pending = *token;
    im->has_pending = true;
}

bool parser_string(PbrtImport *im, const char *what, const char **text, SourcePlace *place)
{
    Token token;
    if (!parser_next(im, &token))
        return false;
    if (token.kind != TOKEN_STRING)
        return token_unexpected(&token, what, im->error);
    if (place)
        *place = token.place;
    *text = token_text(&token, &im->params.texts, im->error);
    return *text != NULL;
}

bool parser_floats(PbrtImport *im, int count, double *values)
{
    for (int i = 0; i < count; ++i) {
        Token token;
        float value;
        if (!parser_next(im, &token) || !token_float(&token, &value, im->error))
            return false;
        values[i] = (double)value;
    }
    return true;
}

static bool bracket_read(PbrtImport *im, TokenKind kind, const char *wanted)
{
    Token token;
    return parser_next(im, &token) && (token.kind == kind || token_unexpected(&token, wanted, im->error));
}

bool parser_matrix(PbrtImport *im, Matrix *matrix)
{
    double v[16];
    if (!bracket_read(im, TOKEN_OPEN, "[ and 16 numbers") || !parser_floats(im, 16, v) ||
        !bracket_read(im, TOKEN_CLOSE, "] after 16 numbers"))
        return false;
    if (v[15] == 0.0) {
        error_at(im->error, im->place, "the 16th number of the transform is 0");
        return error_fix(im->error, "the 4th, 8th and 12th number must be 0, the 16th 1");
    }
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            matrix->m[4 * i + j] = v[4 * j + i] / v[15];
    return true;
}

static bool values_read(PbrtImport *im)
{
    Token token;
    if (!parser_next(im, &token))
        return false;
    if (token.kind == TOKEN_END || token.kind == TOKEN_CLOSE)
        return token_unexpected(&token, "a value", im->error);
    if (token.kind != TOKEN_OPEN)
        return param_value_add(&im->params, &token, im->error);
    for (;;) {
        if (!parser_next(im, &token))
            return false;
        if (token.kind == TOKEN_CLOSE)
            return true;
        if (token.kind == TOKEN_END || token.kind == TOKEN_OPEN)
            return token_unexpected(&token, "a value or ]", im->error);
        if (!param_value_add(&im->params, &token, im->error))
            return false;
    }
}

bool parser_params(PbrtImport *im)
{
    for (;;) {
        Token token;
        if (!parser_next(im, &token))
            return false;
        if (token.kind != TOKEN_STRING) {
            parser_put_back(im, &token);
            break;
        }
        if (!param_declare(&im->params, &token, im->error) || !values_read(im) || !param_end(&im->params, im->error))
            return false;
    }
    param_buffer_seal(&im->params);
    return true;
}
