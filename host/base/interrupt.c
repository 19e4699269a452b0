#include "base/interrupt.h"

#include "base/exit_status.h"
#include "base/temporary_file.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Signals within this time of the first count as repetitions of it. */
#define REPEAT_NANOSECONDS 1000000000ull

/* Atomic because worker threads poll it, lock-free because a signal handler sets it. */
static atomic_int interrupt_seen;
static atomic_ullong first_time; /* nanoseconds; 0: no signal yet */
_Static_assert(ATOMIC_INT_LOCK_FREE == 2 && ATOMIC_LLONG_LOCK_FREE == 2,
               "a signal handler may only touch lock-free atomics");

static unsigned long long now_nanoseconds(void)
{
    struct timespec now = {0};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (unsigned long long)now.tv_sec * 1000000000ull + (unsigned long long)now.tv_nsec;
}

/* After a failed write (file size limit, closed pipe) every later write raises the signal again, so these signals never
 * end the program at once. */
static bool is_of_writes(int signal_number)
{
    return signal_number == SIGPIPE || signal_number == SIGXFSZ;
}

static void interrupt_handle(int signal_number)
{
    int kept = errno;
    unsigned long long now = now_nanoseconds(), first = 0;
    if (atomic_compare_exchange_strong(&first_time, &first, now)) {
        atomic_store(&interrupt_seen, 1);
    } else if (!is_of_writes(signal_number) && now - first > REPEAT_NANOSECONDS) {
        temporary_files_unlink();
        _exit(EXIT_STOPPED);
    }
    errno = kept;
}

static bool signal_catch(int signal_number, const struct sigaction *action)
{
    struct sigaction old;
    return sigaction(signal_number, NULL, &old) == 0 &&
           (old.sa_handler == SIG_IGN || sigaction(signal_number, action, NULL) == 0);
}

static bool signals_catch(const int *signals, size_t count, Error *error)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = interrupt_handle;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < count; ++i)
        sigaddset(&action.sa_mask, signals[i]);
    for (size_t i = 0; i < count; ++i)
        if (!signal_catch(signals[i], &action))
            return error_errno(error, "install", "signal handlers");
    return true;
}

bool interrupt_install(Error *error)
{
    static const int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP, SIGXFSZ, SIGPIPE};
    return signals_catch(SIGNALS, sizeof SIGNALS / sizeof SIGNALS[0], error);
}

bool interrupt_install_user(Error *error)
{
    static const int SIGNALS[] = {SIGUSR1, SIGUSR2};
    return signals_catch(SIGNALS, sizeof SIGNALS / sizeof SIGNALS[0], error);
}

const atomic_int *interrupt_flag(void)
{
    return &interrupt_seen;
}
