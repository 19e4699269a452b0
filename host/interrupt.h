/* SIGINT and SIGTERM: the first asks the program to finish what is begun, the second ends it at once. */
#ifndef TWINLIGHT_INTERRUPT_H
#define TWINLIGHT_INTERRUPT_H

#include "error.h"

#include <stdatomic.h>

/* Installs the handlers. */
bool interrupt_install(Error *error);

/* Points to 0, and to 1 after a signal. */
const atomic_int *interrupt_flag(void);

#endif
