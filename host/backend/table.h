/* The backends of this build. */
#ifndef TWINLIGHT_BACKEND_TABLE_H
#define TWINLIGHT_BACKEND_TABLE_H

#include "backend/backend.h"

/* A backend missing from this build; an array of them ends with a NULL name. */
typedef struct BackendLeftOut {
    const char *name;
    const char *why;
    const char *fix;
} BackendLeftOut;

/* The backends of this build, the default first. Filled only by main.c. */
typedef struct BackendTable {
    const BackendInterface *const *backends;
    int count;
    const BackendLeftOut *left_out; /* NULL: none */
} BackendTable;

#endif
