/* What a rank tells rank 0 first: whether it is the same program, and whether it can take part. */
#ifndef TWINLIGHT_RANKS_GREETING_H
#define TWINLIGHT_RANKS_GREETING_H

#include "base/error.h"

#include <stdint.h>

typedef struct RankGreeting {
    uint64_t byte_order;
    uint64_t layout; /* hash of the sizes of what ranks send each other */
    char version[32], commit[64];
    char machine[256]; /* its host's name */
    int32_t status; /* exit status if it cannot take part, else 0 */
    Error error; /* why it cannot */
} RankGreeting;

/* That of this process, without status and error. */
void greeting_make(RankGreeting *greeting, const char *machine);

/* Whether the rank that sent `theirs` can take part in a rendering of the program that sent `ours`. */
bool greeting_check(const RankGreeting *ours, const RankGreeting *theirs, int rank, Error *error);

/* "rank 3 on HOST: MESSAGE", with the fix. Returns false. */
bool rank_error(Error *error, int rank, const char *machine, const Error *theirs);

#endif
