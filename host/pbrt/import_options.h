/* Options of reading a scene. */
#ifndef TWINLIGHT_PBRT_IMPORT_OPTIONS_H
#define TWINLIGHT_PBRT_IMPORT_OPTIONS_H

#include <stdbool.h>

typedef struct ImportOptions {
    bool lenient; /* replace unsupported features, with a warning that names the substitute, instead of failing */
    bool all_errors; /* continue after errors, up to IMPORT_ERRORS_MAX, and print all but the last */
} ImportOptions;

#endif
