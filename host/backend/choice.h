/* What --backend and --device mean: one backend, or several that share the work. */
#ifndef TWINLIGHT_BACKEND_CHOICE_H
#define TWINLIGHT_BACKEND_CHOICE_H

#include "backend/group.h"
#include "backend/table.h"

typedef struct BackendChoice {
    const BackendInterface *interface;
    char device[128]; /* what BackendOptions.device gets; "": the first */
} BackendChoice;

typedef struct BackendChoices {
    BackendChoice items[BACKEND_GROUP_MAX];
    size_t count;
    char name[64]; /* "cpu", "opencl", "cpu + opencl" */
} BackendChoices;

/* `backend`: a backend's name, or "all" for every device that promises the same image; NULL: the table's first.
 * `devices`: numbers and parts of names with commas between; NULL: the first of the backend, with "all" all of them. */
bool backend_choices_make(BackendChoices *choices, const BackendTable *table, const char *backend, const char *devices,
                          Error *error);

/* Whether one of them is a backend with a choice of devices. */
bool backend_choices_have_devices(const BackendChoices *choices);

/* Opens them on the scene; several become a group. To be closed through opened->interface. */
bool backend_choices_open(const BackendChoices *choices, const BackendScene *scene, const BackendOptions *options,
                          BackendMember *opened, Error *error);

#endif
