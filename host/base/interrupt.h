/* Signals that end a rendering: SIGINT, SIGTERM, SIGHUP, SIGXFSZ (a file has come to the limit of its size) and SIGPIPE
 * (whoever read the messages is gone). The first asks the program to write what it has and end. One of the first three
 * a second later or more ends it at once, without temporary files; sooner it is taken for the same request, for
 * `timeout` and terminals signal a process and its group. Signals that are ignored when the program begins stay ignored
 * (nohup, and jobs in the background of a script). */
#ifndef TWINLIGHT_BASE_INTERRUPT_H
#define TWINLIGHT_BASE_INTERRUPT_H

#include "base/error.h"

#include <stdatomic.h>

/* Installs the handlers. */
bool interrupt_install(Error *error);

/* Points to 0, and to 1 after a signal. */
const atomic_int *interrupt_flag(void);

#endif
