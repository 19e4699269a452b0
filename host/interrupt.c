#include "interrupt.h"

#include "command.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

/* An int and not sig_atomic_t because integrators poll it as one; on every system with POSIX threads both are. */
static volatile int interrupt_seen;

static void interrupt_handle(int signal_number)
{
    (void)signal_number;
    if (interrupt_seen)
        _exit(EXIT_STOPPED);
    interrupt_seen = 1;
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

const volatile int *interrupt_flag(void)
{
    return &interrupt_seen;
}
