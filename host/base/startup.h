/* What the program needs of its process before anything else. */
#ifndef TWINLIGHT_BASE_STARTUP_H
#define TWINLIGHT_BASE_STARTUP_H

#include "base/error.h"

/* Opens standard streams that are closed on /dev/null, so that no message lands in a file that is opened later and gets
 * their number; gives the stack, and those of threads that libraries start, room to grow. False when the system does
 * not let it. */
bool startup_prepare(Error *error);

#endif
