#include "base/processors.h"

#include <errno.h>
#include <sched.h>
#include <stdbool.h>
#include <unistd.h>

/* Processors that a set is made for at first, and at most. */
#define SET_FIRST ((size_t)1024)
#define SET_MOST ((size_t)1 << 20)

static int sharing = 1;

/* Number of processors that the process is bound to; 0 if it cannot be found. */
static int processors_bound(void)
{
    for (size_t size = SET_FIRST; size <= SET_MOST; size *= 2) {
        cpu_set_t *set = CPU_ALLOC(size);
        if (!set)
            return 0;
        size_t bytes = CPU_ALLOC_SIZE(size);
        bool found = sched_getaffinity(0, bytes, set) == 0;
        int count = found ? CPU_COUNT_S(bytes, set) : 0;
        bool larger = !found && errno == EINVAL; /* the machine has more */
        CPU_FREE(set);
        if (!larger)
            return count;
    }
    return 0;
}

int processors_usable(void)
{
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    int bound = processors_bound(), count = bound > 0 ? bound : (int)online;
    count /= sharing;
    return count < 1 ? 1 : count;
}

void processors_share(int processes)
{
    sharing = processes < 1 ? 1 : processes;
}
