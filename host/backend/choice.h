/* Resolves --backend and --device: one backend, or several that share the work. */
#ifndef TWINLIGHT_BACKEND_CHOICE_H
#define TWINLIGHT_BACKEND_CHOICE_H

#include "backend/group.h"
#include "backend/table.h"

typedef struct BackendChoice {
    const BackendInterface *interface;
    char device[128]; /* passed as BackendOptions.device; "": the first */
} BackendChoice;

typedef struct BackendChoices {
    BackendChoice items[BACKEND_GROUP_MAX];
    size_t count;
    char name[64]; /* "cpu", "opencl", "cpu + opencl" */
} BackendChoices;

/* `backend`: name of a backend, or "all" for every device expected to give the same image; NULL: the table's first.
 * `devices`: comma-separated device numbers or parts of names; NULL: the backend's first device or, with "all", all
 * devices. Fails for an unknown backend, a device given twice, or more than BACKEND_GROUP_MAX devices. */
bool backend_choices_make(BackendChoices *choices, const BackendTable *table, const char *backend, const char *devices,
                          Error *error);

/* Whether one of the choices is a backend with several devices. */
bool backend_choices_have_devices(const BackendChoices *choices);

/* Opens the choices on the scene; several form a group. *opened is to be closed by opened->interface->close. */
bool backend_choices_open(const BackendChoices *choices, const BackendScene *scene, const BackendOptions *options,
                          BackendMember *opened, Error *error);

#endif
