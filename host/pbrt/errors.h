/* Errors that several readers have, and going on behind an error, so that one run shows what is wrong with a scene. */
#ifndef TWINLIGHT_PBRT_ERRORS_H
#define TWINLIGHT_PBRT_ERRORS_H

#include "pbrt/context.h"

/* What is not supported: an error that says what, or with --lenient a counted warning that states the substitute.
 * Returns whether to go on. `fix` may be NULL. */
bool import_unsupported(PbrtImport *im, SourcePlace place, const char *what, const char *substitute, const char *fix);

/* "error: unknown KIND "name"" with the nearest of `known` or all of them as the fix. Returns false. */
bool import_unknown(PbrtImport *im, SourcePlace place, const char *kind, const char *name, const char *const *known,
                    size_t count);

/* Takes note of the error of a directive; `defines`: one that opens a scope or gives something a name. Errors come to
 * standard error in their order, but for the latest, which errors_end returns. False when reading is to end: it is the
 * first error that is wanted, the last of IMPORT_ERRORS_MAX, or memory is out. */
bool errors_note(PbrtImport *im, bool defines);

/* Says that the error that follows may be due to an earlier one: something is missing that might have been defined. */
void errors_missing(PbrtImport *im);

/* At the end of reading: false when there were errors; the latest is then im->error. */
bool errors_end(PbrtImport *im);

#endif
