#include "base/startup.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

/* Bytes of stack: requested, and the least that rendering a scene needs. */
#define STACK_WANTED ((rlim_t)8 << 20)
#define STACK_LEAST ((rlim_t)1 << 20)

static bool streams_open(Error *error)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (fcntl(stream, F_GETFD) < 0 && errno == EBADF && open("/dev/null", O_RDWR) < 0)
            return error_errno(error, "open", "/dev/null");
    return true;
}

static bool stack_raise(Error *error)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= STACK_WANTED) /* RLIM_INFINITY is the largest */
        return true;
    limit.rlim_cur = limit.rlim_max < STACK_WANTED ? limit.rlim_max : STACK_WANTED;
    if (setrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur >= STACK_LEAST) {
        pthread_attr_t attributes;
        pthread_attr_init(&attributes);
        pthread_attr_setstacksize(&attributes, (size_t)limit.rlim_cur);
        pthread_setattr_default_np(&attributes);
        pthread_attr_destroy(&attributes);
        return true;
    }
    error_set(error, "the stack is limited to %llu KiB", (unsigned long long)limit.rlim_cur / 1024u);
    return error_fix(error, "raise the limit to at least %llu KiB: ulimit -s 8192",
                     (unsigned long long)STACK_LEAST / 1024u);
}

bool startup_prepare(Error *error)
{
    return streams_open(error) && stack_raise(error);
}
