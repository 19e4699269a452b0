#include "render/integrator.h"

#include <stdio.h>
#include <string.h>

const Integrator *integrator_find(const char *name, Error *error)
{
#define MADE(name) integrator_##name(),
    const Integrator *const integrators[] = {INTEGRATOR_LIST(MADE)};
#undef MADE
    char names[256] = "";
    for (size_t i = 0; i < sizeof integrators / sizeof integrators[0]; ++i) {
        if (strcmp(integrators[i]->name, name) == 0)
            return integrators[i];
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s (%s)", i > 0 ? ", " : "", integrators[i]->name,
                 integrators[i]->summary);
    }
    error_set(error, "--integrator=%s: there is no such integrator", name);
    error_fix(error, "use one of: %s", names);
    return NULL;
}
