/* Signals that end a rendering: SIGINT, SIGTERM, SIGHUP, SIGXFSZ (file size limit reached) and SIGPIPE (the reader of
 * the messages is gone). The first one asks the program to write what it has and end. A later SIGINT, SIGTERM or SIGHUP
 * ends it at once and removes its temporary files, if more than a second has passed; sooner it counts as the same
 * request, because `timeout` and terminals signal both a process and its group. Signals that are ignored at startup
 * stay ignored (nohup, background jobs of a script). */
#ifndef TWINLIGHT_BASE_INTERRUPT_H
#define TWINLIGHT_BASE_INTERRUPT_H

#include "base/error.h"

#include <stdatomic.h>

/* Installs the handlers. */
bool interrupt_install(Error *error);

/* Catches SIGUSR1 and SIGUSR2, too: the only ones that mpirun hands on to its processes without ending them soon
 * after. */
bool interrupt_install_user(Error *error);

/* Points to a flag that is 0, and 1 after a signal. */
const atomic_int *interrupt_flag(void);

#endif
