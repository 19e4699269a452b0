/* What a scene uses, and what of it is not supported: `twinlight info --needs`. Reading then records instead of
 * stopping, and leaves out meshes of files and images. */
#ifndef TWINLIGHT_PBRT_NEEDS_H
#define TWINLIGHT_PBRT_NEEDS_H

#include "base/array.h"
#include "base/arena.h"
#include "base/name_table.h"

#include <stdio.h>

typedef enum NeedStatus {
    NEED_SUPPORTED,
    NEED_APPROXIMATED, /* read with a warning */
    NEED_UNSUPPORTED,
    NEED_ERROR /* an error of the scene, or of a file that it names */
} NeedStatus;

typedef struct Need {
    const char *kind; /* a directive, "feature" or "error" */
    const char *name; /* the kind of shape, material ...; what is not supported; the message */
    const char *note; /* what --lenient replaces it by, or the advice; "" */
    char place[512]; /* FILE:LINE:COLUMN of the first that has the status */
    unsigned long count;
    NeedStatus status; /* the worst of them */
} Need;

typedef struct SceneNeeds {
    Array needs; /* Need, in the order of first use */
    NameTable table; /* by kind and name */
    Arena texts;
    size_t current; /* what the directive being read uses; NONE: nothing */
    unsigned long warnings; /* log_warning_count before that directive */
} SceneNeeds;

void needs_init(SceneNeeds *needs);
void needs_destroy(SceneNeeds *needs);

/* Whether all is supported, or approximated. */
bool needs_met(const SceneNeeds *needs);

/* Begins a directive, which uses nothing so far. */
void needs_directive(SceneNeeds *needs);

/* The directive uses the `name` of its kind. False when out of memory, as the others below. */
bool needs_use(SceneNeeds *needs, const char *kind, const char *name, SourcePlace place, Error *error);

/* Something is not supported: what the directive uses if `what` names that in quotes, else a feature. */
bool needs_unsupported(SceneNeeds *needs, const char *what, const char *note, SourcePlace place, Error *error);

/* The error of a directive, as needs_unsupported. */
bool needs_error(SceneNeeds *needs, const Error *found, Error *error);

/* After a directive: if it was read with a warning, what it uses is approximated. */
void needs_warned(SceneNeeds *needs, SourcePlace place);

/* path: of the scene. */
void needs_print(const SceneNeeds *needs, FILE *stream);
void needs_print_json(const SceneNeeds *needs, const char *path, FILE *stream);

#endif
