/* The token stream over the files of a scene, and the common parts of directives. */
#ifndef TWINLIGHT_PBRT_PARSER_H
#define TWINLIGHT_PBRT_PARSER_H

#include "pbrt/context.h"

/* Opens a text as the innermost file, with `name` as its file name in messages. Takes ownership of the window. */
bool parser_open_text(PbrtImport *im, TextWindow *window, const char *name);

/* Opens the file `name`, relative to the scene's folder, as named at `place` (place.file NULL: the main scene). */
bool parser_open_file(PbrtImport *im, const char *name, SourcePlace place, bool is_import);

/* Closes the innermost file, or all of them. */
void parser_close(PbrtImport *im);
void parser_close_all(PbrtImport *im);

/* The next token. At the end of an included file the stream continues in the including file; the end of an imported
 * file or of the scene is TOKEN_END. */
bool parser_next(PbrtImport *im, Token *token);

/* Puts a token back, at most one at a time. */
void parser_put_back(PbrtImport *im, const Token *token);

/* Read arguments of a directive. Strings are NUL-terminated in im->params.texts and valid until the next directive. */
bool parser_string(PbrtImport *im, const char *what, const char **text, SourcePlace *place);
bool parser_floats(PbrtImport *im, int count, double *values);

/* Reads [ 16 numbers ], in the file's order: column by column. */
bool parser_matrix(PbrtImport *im, Matrix *matrix);

/* Reads parameters into im->params up to the next directive. */
bool parser_params(PbrtImport *im);

#endif
