#include "serve/tev.h"

#include "base/log.h"
#include "base/timing.h"
#include "serve/quiet_thread.h"
#include "serve/tev_packet.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define SEND_SECONDS 1.0 /* least time between two snapshots */
#define RETRY_SECONDS 3.0 /* between attempts to connect */
#define CONNECT_SECONDS 2.0 /* most time that an attempt takes */
#define STALL_SECONDS 10.0 /* a viewer that takes nothing this long is given up */
#define TICK_MILLISECONDS 50
#define PACKET_VALUES ((size_t)1 << 17) /* about so many floats in a packet */

/* ---- the connection ---------------------------------------------------------------------------------------------- */

static bool ending(const Tev *tev)
{
    return isfinite(atomic_load(&tev->end));
}

/* Says once, until there is a connection, that there is none. */
static void viewer_missing(Tev *tev, const char *why)
{
    if (ending(tev))
        log_message(LOG_INFO, "tev at %s has not taken the last picture: %s", tev->address, why);
    else if (!tev->told)
        log_message(LOG_INFO, "no tev takes the picture at %s: %s; trying again every %g seconds", tev->address, why,
                    RETRY_SECONDS);
    tev->told = true;
}

static void disconnect(Tev *tev)
{
    close(tev->socket);
    tev->socket = -1;
    tev->next_try = timing_now() + RETRY_SECONDS;
}

/* Waits until the socket can be written to, at most until `until` and the end; sets errno otherwise. */
static bool writable_wait(const Tev *tev, int descriptor, double until)
{
    struct pollfd poller = {.fd = descriptor, .events = POLLOUT};
    for (;;) {
        if (poll(&poller, 1, TICK_MILLISECONDS) > 0)
            return true;
        if (timing_now() > fmin(until, atomic_load(&tev->end))) {
            errno = ETIMEDOUT;
            return false;
        }
    }
}

/* Connects to one of the viewer's addresses; returns the socket, or -1 with errno. */
static int address_connect(const Tev *tev, const struct addrinfo *address)
{
    int made = socket(address->ai_family, address->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address->ai_protocol);
    if (made < 0)
        return -1;
    bool connected = connect(made, address->ai_addr, address->ai_addrlen) == 0;
    if (!connected && errno == EINPROGRESS && writable_wait(tev, made, timing_now() + CONNECT_SECONDS)) {
        int failure = 0;
        socklen_t size = sizeof failure;
        getsockopt(made, SOL_SOCKET, SO_ERROR, &failure, &size);
        connected = failure == 0;
        errno = failure;
    }
    if (connected)
        return made;
    int failure = errno;
    close(made);
    errno = failure;
    return -1;
}

static bool bytes_send(const Tev *tev, size_t size)
{
    size_t sent = 0;
    while (sent < size) {
        if (!writable_wait(tev, tev->socket, timing_now() + STALL_SECONDS))
            return false;
        ssize_t now = send(tev->socket, tev->packet + sent, size - sent, MSG_NOSIGNAL);
        if (now < 0 && errno != EAGAIN && errno != EINTR)
            return false;
        sent += now > 0 ? (size_t)now : 0;
    }
    return true;
}

static void connect_try(Tev *tev)
{
    const Snapshot *snapshot = tev->snapshot;
    for (const struct addrinfo *address = tev->addresses; address && tev->socket < 0; address = address->ai_next)
        tev->socket = address_connect(tev, address);
    tev->next_try = timing_now() + RETRY_SECONDS;
    if (tev->socket < 0 ||
        !bytes_send(tev, tev_packet_create(tev->packet, tev->image, snapshot->width, snapshot->height))) {
        viewer_missing(tev, strerror(errno));
        if (tev->socket >= 0)
            disconnect(tev);
        return;
    }
    tev->told = false;
    tev->version = 0;
    tev->last_send = -(double)INFINITY;
    log_message(LOG_INFO, "sending the picture to tev at %s", tev->address);
}

/* ---- the thread -------------------------------------------------------------------------------------------------- */

static bool picture_send(Tev *tev)
{
    const Snapshot *snapshot = tev->snapshot;
    for (int y = 0; y < snapshot->height; y += tev->packet_rows) {
        int rows = snapshot->height - y < tev->packet_rows ? snapshot->height - y : tev->packet_rows;
        const float *rgb = tev->rgb + 3 * (size_t)y * (size_t)snapshot->width;
        if (!bytes_send(tev, tev_packet_update(tev->packet, tev->image, y, snapshot->width, rows, rgb)))
            return false;
    }
    return true;
}

/* Asks for the picture, and sends it if it is newer than what the viewer has. */
static void viewer_update(Tev *tev, bool last)
{
    Snapshot *snapshot = tev->snapshot;
    pthread_mutex_lock(&snapshot->lock);
    snapshot_reader_count(snapshot, &tev->counted);
    snapshot_ask(snapshot_find(snapshot, SNAPSHOT_PICTURE));
    pthread_mutex_unlock(&snapshot->lock);
    if ((!last && timing_now() < tev->last_send + SEND_SECONDS) ||
        !snapshot_copy(snapshot, SNAPSHOT_PICTURE, &tev->version, tev->rgb))
        return;
    tev->last_send = timing_now();
    if (picture_send(tev))
        return;
    viewer_missing(tev, strerror(errno));
    disconnect(tev);
}

/* Whether it is time to connect: at the end at once, unless all time is spent on a viewer that hangs. */
static bool connect_due(const Tev *tev, bool last)
{
    double now = timing_now();
    return tev->socket < 0 && (last ? now < atomic_load(&tev->end) : now >= tev->next_try);
}

static void *tev_run(void *argument)
{
    Tev *tev = argument;
    bool last;
    do {
        last = ending(tev); /* what is published before tev_end is sent after this */
        if (connect_due(tev, last))
            connect_try(tev);
        if (tev->socket >= 0)
            viewer_update(tev, last);
        if (!last)
            poll(NULL, 0, TICK_MILLISECONDS);
    } while (!last);
    if (tev->socket >= 0)
        close(tev->socket);
    return NULL;
}

/* ---- begin and end ----------------------------------------------------------------------------------------------- */

static bool buffers_make(Tev *tev, Error *error)
{
    size_t width = (size_t)tev->snapshot->width, values = 3 * width * (size_t)tev->snapshot->height;
    tev->packet_rows = (int)(PACKET_VALUES / (3 * width)) + 1;
    size_t bytes = tev_packet_bytes(tev->image, 3 * width * (size_t)tev->packet_rows);
    tev->rgb = malloc(values * sizeof *tev->rgb);
    tev->packet = malloc(bytes);
    return (tev->rgb && tev->packet) || error_memory(error, values * sizeof *tev->rgb + bytes, "the pictures for tev");
}

bool tev_begin(Tev *tev, const OptionAddress *address, const char *image, Snapshot *snapshot, Error *error)
{
    const struct addrinfo wanted = {.ai_socktype = SOCK_STREAM};
    char port[16];
    *tev = (Tev){.snapshot = snapshot, .image = image, .socket = -1, .end = INFINITY};
    snprintf(port, sizeof port, "%u", address->port);
    snprintf(tev->address, sizeof tev->address, "%s:%s", address->host, port);
    int failure = getaddrinfo(address->host, port, &wanted, &tev->addresses);
    if (failure != 0) {
        tev->addresses = NULL;
        error_set(error, "--tev=%s: cannot look up the host: %s", tev->address, gai_strerror(failure));
        return error_fix(error, "give the name or address of the machine on which tev runs, as in localhost:14158");
    }
    if (!buffers_make(tev, error))
        return false;
    tev->running = quiet_thread_start(&tev->thread, tev_run, tev);
    if (tev->running)
        return true;
    error_set(error, "--tev: cannot start a thread");
    return error_fix(error, "raise the limit on threads (ulimit -u), or leave --tev out");
}

void tev_end(Tev *tev)
{
    atomic_store(&tev->end, timing_now() + TEV_END_SECONDS);
    if (tev->running)
        pthread_join(tev->thread, NULL);
    if (tev->addresses)
        freeaddrinfo(tev->addresses);
    free(tev->rgb);
    free(tev->packet);
    *tev = (Tev){.socket = -1};
}
