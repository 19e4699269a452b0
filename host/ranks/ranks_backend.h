/* The backend of rank 0: divides each pass among all ranks (ranks/ranks.h). */
#ifndef TWINLIGHT_RANKS_RANKS_BACKEND_H
#define TWINLIGHT_RANKS_RANKS_BACKEND_H

#include "backend/group.h"
#include "ranks/messages.h"

/* Takes ownership of `local`, the open backend of rank 0. reports: those of ranks 1 ... on their opening, copied;
 * reports[0] is not used. tables: the scene's, borrowed. On failure `local` is closed. */
bool ranks_backend_create(BackendMember local, const RankReport *reports, const uint *tables, BackendMember *made,
                          Error *error);

#endif
