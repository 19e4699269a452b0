/* Threads that receive no signals, which are the rendering thread's (base/interrupt.h). */
#ifndef TWINLIGHT_SERVE_QUIET_THREAD_H
#define TWINLIGHT_SERVE_QUIET_THREAD_H

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>

/* Blocks all signals for this thread, and for threads that it starts meanwhile; `before`: for signals_unblock. */
void signals_block(sigset_t *before);
void signals_unblock(const sigset_t *before);

bool quiet_thread_start(pthread_t *thread, void *(*run)(void *), void *argument);

#endif
