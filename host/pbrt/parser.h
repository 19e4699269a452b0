/* The token stream over a scene's files, and the parts of directives that are common to all. */
#ifndef TWINLIGHT_PBRT_PARSER_H
#define TWINLIGHT_PBRT_PARSER_H

#include "pbrt/context.h"

/* Opens a text, of which `name` is the file in messages, as the innermost file. Takes the window. */
bool parser_open_text(PbrtImport *im, TextWindow *window, const char *name);

/* Opens `name`, named at `place` (a file of NULL: the main scene), below the scene's directory. */
bool parser_open_file(PbrtImport *im, const char *name, SourcePlace place, bool is_import);

/* Closes the innermost file, or all of them. */
void parser_close(PbrtImport *im);
void parser_close_all(PbrtImport *im);

/* The next token. At the end of an included file the stream goes on in the file that included it; the end of an
 * imported file or of the scene is TOKEN_END. */
bool parser_next(PbrtImport *im, Token *token);

/* Gives a token back; at most one. */
void parser_put_back(PbrtImport *im, const Token *token);

/* Reads what a directive needs. Strings are NUL-terminated in im->params.texts: gone with the next directive. */
bool parser_string(PbrtImport *im, const char *what, const char **text, SourcePlace *place);
bool parser_floats(PbrtImport *im, int count, double *values);

/* [ 16 numbers ], in the file's order: column by column. */
bool parser_matrix(PbrtImport *im, Matrix *matrix);

/* Reads parameters into im->params up to the next directive. */
bool parser_params(PbrtImport *im);

#endif
