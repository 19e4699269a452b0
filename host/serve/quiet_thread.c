#include "serve/quiet_thread.h"

void signals_block(sigset_t *before)
{
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, before);
}

void signals_unblock(const sigset_t *before)
{
    pthread_sigmask(SIG_SETMASK, before, NULL);
}

bool quiet_thread_start(pthread_t *thread, void *(*run)(void *), void *argument)
{
    sigset_t before;
    signals_block(&before);
    bool started = pthread_create(thread, NULL, run, argument) == 0;
    signals_unblock(&before);
    return started;
}
