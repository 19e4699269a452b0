/* Wall-clock time and the memory of this process. */
#ifndef TWINLIGHT_BASE_TIMING_H
#define TWINLIGHT_BASE_TIMING_H

#include <stdint.h>

/* Monotonic time in seconds from an arbitrary origin. */
double timing_now(void);

/* Processor time that the calling thread has used, in seconds. */
double timing_thread(void);

/* Peak resident memory of this process, bytes. */
uint64_t timing_peak_memory(void);

#endif
