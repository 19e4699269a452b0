#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>

#define OTHERS_MOST 63

typedef struct Loop {
    ParallelPart *part;
    void *context;
    size_t count;
    atomic_size_t next;
} Loop;

static void *parts_run(void *argument)
{
    Loop *loop = argument;
    for (size_t index; (index = atomic_fetch_add(&loop->next, 1)) < loop->count;)
        loop->part(loop->context, index);
    return NULL;
}

void parallel_run(size_t count, int threads, ParallelPart *part, void *context)
{
    Loop loop = {.part = part, .context = context, .count = count};
    pthread_t others[OTHERS_MOST];
    int started = 0;
    while (started < OTHERS_MOST && started + 1 < threads && (size_t)started + 1 < count &&
           pthread_create(&others[started], NULL, parts_run, &loop) == 0)
        ++started;
    parts_run(&loop);
    for (int i = 0; i < started; ++i)
        pthread_join(others[i], NULL);
}
