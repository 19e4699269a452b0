/* The file of --dump-bad. */
#ifndef TWINLIGHT_MMLT_BAD_CHAINS_H
#define TWINLIGHT_MMLT_BAD_CHAINS_H

#include "base/output_file.h"

#include <stdio.h>

typedef struct BadChains {
    OutputFile file;
    FILE *stream; /* RenderOptions.bad_chains; NULL: nobody wants them */
} BadChains;

/* path: NULL for none. */
bool bad_chains_begin(BadChains *bad, const char *path, Error *error);
bool bad_chains_end(BadChains *bad, Error *error);

/* Safe at any time: what is not ended is removed. */
void bad_chains_cancel(BadChains *bad);

#endif
