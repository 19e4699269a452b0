/* Wall-clock time and the memory of this process. */
#ifndef TWINLIGHT_BASE_TIMING_H
#define TWINLIGHT_BASE_TIMING_H

#include <stdint.h>

/* Seconds since some fixed moment; never runs backwards. */
double timing_now(void);

/* Largest resident memory of this process so far, bytes. */
uint64_t timing_peak_memory(void);

#endif
