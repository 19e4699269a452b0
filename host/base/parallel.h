/* A loop on several threads. */
#ifndef TWINLIGHT_BASE_PARALLEL_H
#define TWINLIGHT_BASE_PARALLEL_H

#include <stddef.h>

/* Fewest pixels of an image whose sums take longer than it takes to start threads. */
#define PARALLEL_PIXELS 65536u

typedef void ParallelPart(void *context, size_t index);

/* Calls part(context, index) once for every index below `count`, on this thread and up to threads - 1 others, and
 * returns when all are done. Parts may run at the same time and in any order: each must write to places of its own.
 * Threads are started for each loop; if one cannot be started, the others do its work. */
void parallel_run(size_t count, int threads, ParallelPart *part, void *context);

#endif
