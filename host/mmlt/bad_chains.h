/* The output file of --dump-bad. */
#ifndef TWINLIGHT_MMLT_BAD_CHAINS_H
#define TWINLIGHT_MMLT_BAD_CHAINS_H

#include "base/output_file.h"

#include <stdio.h>

typedef struct BadChains {
    OutputFile file;
    FILE *stream; /* for RenderOptions.bad_chains; NULL without --dump-bad */
} BadChains;

/* Opens a temporary file for `path`; NULL: does nothing and succeeds. bad_chains_end moves the file to its name. */
bool bad_chains_begin(BadChains *bad, const char *path, Error *error);
bool bad_chains_end(BadChains *bad, Error *error);

/* Discards a file that has not been ended; safe at any time after bad_chains_begin, and on zeroed memory. */
void bad_chains_cancel(BadChains *bad);

#endif
