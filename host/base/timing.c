#include "base/timing.h"

#include <sys/resource.h>
#include <time.h>

static double clock_seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double timing_now(void)
{
    return clock_seconds(CLOCK_MONOTONIC);
}

double timing_thread(void)
{
    return clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}

uint64_t timing_peak_memory(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0)
        return 0;
    return (uint64_t)usage.ru_maxrss * 1024u; /* Linux reports KiB */
}
