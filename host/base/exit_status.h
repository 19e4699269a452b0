/* How the program ends. */
#ifndef TWINLIGHT_BASE_EXIT_STATUS_H
#define TWINLIGHT_BASE_EXIT_STATUS_H

#define EXIT_OK 0
#define EXIT_FAILED 1 /* something outside the program was not as it should be */
#define EXIT_USAGE 2 /* the command line was not understood */
#define EXIT_STOPPED 130 /* ended early by a signal (base/interrupt.h), output written */

#endif
