/* How a scene is to be read. */
#ifndef TWINLIGHT_PBRT_IMPORT_OPTIONS_H
#define TWINLIGHT_PBRT_IMPORT_OPTIONS_H

#include <stdbool.h>

typedef struct ImportOptions {
    bool lenient; /* what is not supported is replaced, with a warning that says by what, instead of refused */
    bool all_errors; /* goes on behind errors, up to IMPORT_ERRORS_MAX, and prints all but the last */
} ImportOptions;

#endif
