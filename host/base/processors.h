/* How many threads this process should start to keep its processors busy. */
#ifndef TWINLIGHT_BASE_PROCESSORS_H
#define TWINLIGHT_BASE_PROCESSORS_H

/* Number of processors that this process may use, its share of them if it shares them; at least 1. Fewer than the
 * machine has if the process is bound to some (taskset, mpirun, a queueing system). */
int processors_usable(void);

/* Says that this process shares its processors with others that compute as well: `processes` in all. */
void processors_share(int processes);

#endif
