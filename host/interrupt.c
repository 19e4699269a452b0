#include "interrupt.h"

#include "command.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

/* Atomic, for worker threads poll it; a handler may touch it because it is lock-free. */
static atomic_int interrupt_seen;
_Static_assert(ATOMIC_INT_LOCK_FREE == 2, "a signal handler may only touch lock-free atomics");

static void interrupt_handle(int signal_number)
{
    (void)signal_number;
    if (atomic_exchange(&interrupt_seen, 1))
        _exit(EXIT_STOPPED);
}

bool interrupt_install(Error *error)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = interrupt_handle;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    if (sigaction(SIGINT, &action, NULL) != 0 || sigaction(SIGTERM, &action, NULL) != 0)
        return error_errno(error, "install", "signal handlers");
    return true;
}

const atomic_int *interrupt_flag(void)
{
    return &interrupt_seen;
}
