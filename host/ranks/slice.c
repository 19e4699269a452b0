#include "ranks/slice.h"

#include "base/timing.h"

#include <time.h>

static void slice_run(Slice *slice)
{
    double begin = timing_now();
    slice->good = slice->backend.interface->run(slice->backend.backend, &slice->frame, slice->list, slice->sink,
                                                slice->stop, &slice->delivered, &slice->error);
    slice->seconds = timing_now() - begin;
}

static void *slice_main(void *argument)
{
    Slice *slice = argument;
    slice_run(slice);
    pthread_mutex_lock(&slice->mutex);
    slice->done = true;
    pthread_cond_signal(&slice->ended);
    pthread_mutex_unlock(&slice->mutex);
    return NULL;
}

void slice_start(Slice *slice)
{
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_mutex_init(&slice->mutex, NULL);
    pthread_cond_init(&slice->ended, &attributes);
    pthread_condattr_destroy(&attributes);
    slice->delivered = 0;
    slice->seconds = 0.0;
    slice->good = true;
    slice->error = (Error){0};
    const bool empty = slice->frame.pass.item_count == 0;
    slice->done = empty;
    slice->threaded = !empty && pthread_create(&slice->thread, NULL, slice_main, slice) == 0;
    if (empty || slice->threaded)
        return;
    slice_run(slice);
    slice->done = true;
}

bool slice_wait(Slice *slice, double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    long long nanoseconds = until.tv_nsec + (long long)(1e9 * seconds);
    until.tv_sec += (time_t)(nanoseconds / 1000000000);
    until.tv_nsec = (long)(nanoseconds % 1000000000);
    pthread_mutex_lock(&slice->mutex);
    int status = 0;
    while (!slice->done && status == 0)
        status = pthread_cond_timedwait(&slice->ended, &slice->mutex, &until);
    bool done = slice->done;
    pthread_mutex_unlock(&slice->mutex);
    return done;
}

void slice_join(Slice *slice)
{
    if (slice->threaded)
        pthread_join(slice->thread, NULL);
    pthread_cond_destroy(&slice->ended);
    pthread_mutex_destroy(&slice->mutex);
}
