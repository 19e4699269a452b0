/* The backend of rank 0: divides each pass among all ranks (ranks/ranks.h). */
#ifndef TWINLIGHT_RANKS_RANKS_BACKEND_H
#define TWINLIGHT_RANKS_RANKS_BACKEND_H

#include "backend/group.h"
#include "ranks/messages.h"

/* Takes ownership of `local`, the open backend of rank 0; it is closed on failure (NULL), too. reports: those of ranks
 * 1 ... on their opening, copied; reports[0] is not used. tables: the scene's, borrowed. To be used through
 * ranks_backend_interface(). */
Backend *ranks_backend_create(BackendMember local, const RankReport *reports, const uint *tables, Error *error);

/* Its `open` is NULL. */
const BackendInterface *ranks_backend_interface(void);

#endif
