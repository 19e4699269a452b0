/* Which backends this build has. */
#ifndef TWINLIGHT_BACKEND_TABLE_H
#define TWINLIGHT_BACKEND_TABLE_H

#include "backend/backend.h"

/* A backend that this build lacks; an array of them ends with name NULL. */
typedef struct BackendLeftOut {
    const char *name;
    const char *why;
    const char *fix;
} BackendLeftOut;

/* The backends of this build, the default one first. Only main.c fills it. */
typedef struct BackendTable {
    const BackendInterface *const *backends;
    int count;
    const BackendLeftOut *left_out; /* NULL: none */
} BackendTable;

#endif
