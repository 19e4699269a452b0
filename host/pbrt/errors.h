/* Common errors of the readers, and recovery after an error, so that one run shows all errors of a scene. */
#ifndef TWINLIGHT_PBRT_ERRORS_H
#define TWINLIGHT_PBRT_ERRORS_H

#include "pbrt/context.h"

/* Reports something unsupported: an error that names it or, with --lenient, a counted warning that also names the
 * substitute. Returns whether to continue. `fix` may be NULL. */
bool import_unsupported(PbrtImport *im, SourcePlace place, const char *what, const char *substitute, const char *fix);

/* For `info --needs`: the directive uses the `name` of its kind. False when out of memory. */
bool import_use(PbrtImport *im, const char *kind, const char *name);

/* Reports that the scene is one for pbrt-v3, in which this kind of thing has this name; reading ends. Returns false. */
bool import_other_version(PbrtImport *im, SourcePlace place, const char *kind, const char *name);

/* "error: unknown KIND "name"", with the nearest of `known` or all of them as the fix. Returns false. */
bool import_unknown(PbrtImport *im, SourcePlace place, const char *kind, const char *name, const char *const *known,
                    size_t count);

/* Records the error of a directive. `defines`: the directive opens a scope or defines a name. Repeated errors are
 * dropped, and so are those that may follow from a failed definition (errors_missing). Errors are printed to standard
 * error in order, except the latest, which errors_end returns. False if reading must end: only the first error was
 * asked for, IMPORT_ERRORS_MAX is reached, the scene is pbrt-v3's, or memory is out. */
bool errors_note(PbrtImport *im, bool defines);

/* Marks the next error as a possible consequence of an earlier one: something is missing whose definition may have
 * failed. */
void errors_missing(PbrtImport *im);

/* Called at the end of reading. False if there were errors; the latest is then in im->error. */
bool errors_end(PbrtImport *im);

#endif
