/* Several opened backends as one: each takes a share of every pass, by its measured speed. Items are independent and
 * the film is an integer sum, so the picture is the same for any members and any shares. */
#ifndef TWINLIGHT_BACKEND_GROUP_H
#define TWINLIGHT_BACKEND_GROUP_H

#include "backend/backend.h"

#define BACKEND_GROUP_MAX 16

typedef struct BackendMember {
    const BackendInterface *interface;
    Backend *backend;
} BackendMember;

/* Takes the members over: they are closed with the group, or at once on failure (NULL). 1 <= count <=
 * BACKEND_GROUP_MAX. The group is run by the functions of backend_group_interface(). */
Backend *backend_group_create(const BackendMember *members, size_t count, Error *error);

/* Its `open` is NULL: a group is made of opened backends. */
const BackendInterface *backend_group_interface(void);

/* The members when `of` is a group, else `of` itself. Returns how many; out has BACKEND_GROUP_MAX places. */
size_t backend_group_members(BackendMember of, BackendMember *out);

#endif
