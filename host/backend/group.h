/* Several open backends as one: each renders a share of every pass in proportion to its measured speed. Items are
 * independent and the film is an integer sum, so the image does not depend on members and shares. */
#ifndef TWINLIGHT_BACKEND_GROUP_H
#define TWINLIGHT_BACKEND_GROUP_H

#include "backend/backend.h"

#define BACKEND_GROUP_MAX 16

typedef struct BackendMember {
    const BackendInterface *interface;
    Backend *backend;
} BackendMember;

/* Takes ownership of the members: they are closed with the group, or at once on failure (NULL). 1 <= count <=
 * BACKEND_GROUP_MAX. The group is used through backend_group_interface(). */
Backend *backend_group_create(const BackendMember *members, size_t count, Error *error);

/* Its `open` is NULL: a group is made from open backends. */
const BackendInterface *backend_group_interface(void);

/* Adds the statistics of a member; "+" joins the names of devices. */
void backend_statistics_add(BackendStatistics *sum, const BackendStatistics *own);

/* The members if `of` is a group, else `of` itself. Returns their number; `out` has room for BACKEND_GROUP_MAX. */
size_t backend_group_members(BackendMember of, BackendMember *out);

#endif
