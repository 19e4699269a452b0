/* --dump-bad: chains that met a non-finite contribution, and the file for them. */
#ifndef TWINLIGHT_MMLT_BAD_CHAINS_H
#define TWINLIGHT_MMLT_BAD_CHAINS_H

#include "base/output_file.h"
#include "math/platform.h"

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

/* A finished pass of chains. */
typedef struct BadChainsPass {
    const uint *words; /* CHAIN_PASS_* (chain/chain.h), [fields][count] */
    const uint *begun; /* the same before the pass */
    uint count, fields;
    unsigned long long seed;
    uint generation, pool_sample, pool_pixel;
} BadChainsPass;

/* Writes what reproduces those of the pass, one JSON object per line. */
void bad_chains_write(FILE *out, const BadChainsPass *pass);

#endif
