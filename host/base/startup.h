/* Prepares the process before anything else runs. */
#ifndef TWINLIGHT_BASE_STARTUP_H
#define TWINLIGHT_BASE_STARTUP_H

#include "base/error.h"

/* Opens closed standard streams on /dev/null, so that no file opened later gets their descriptors and, with them, the
 * messages. Raises the stack limit, also for threads started by libraries. False if the system does not permit this. */
bool startup_prepare(Error *error);

#endif
