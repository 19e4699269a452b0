/* Exit statuses of the program. */
#ifndef TWINLIGHT_BASE_EXIT_STATUS_H
#define TWINLIGHT_BASE_EXIT_STATUS_H

#define EXIT_OK 0
#define EXIT_FAILED 1 /* failed for a reason outside the program (base/error.h) */
#define EXIT_USAGE 2 /* invalid command line */
#define EXIT_STOPPED 130 /* stopped early by a signal (base/interrupt.h); output was written */

#endif
