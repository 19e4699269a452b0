#include "serve/server.h"

#include "base/timing.h"
#include "render/halves_error.h"
#include "serve/connections.h"
#include "serve/pixels.h"
#include "serve/quiet_thread.h"
#include "serve/request.h"

#include <errno.h>
#include <microhttpd.h>
#include <netdb.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define IDLE_SECONDS 10u /* a connection on which nothing moves is closed */
#define REQUEST_BYTES_MAX ((size_t)16 << 10) /* of a request's head */
#define END_SECONDS 2.0 /* see server_end */
#define PRESENT_SECONDS 3.0 /* a client that has asked for something so recently is there */

static const unsigned char PAGE[] = {
#if __has_include("serve_page.h") /* tools read this file before the build makes that */
#include "serve_page.h"
#else
    0
#endif
};

struct Server {
    Snapshot *snapshot;
    const RenderFacts *facts;
    char token[TOKEN_DIGITS + 1];
    char host[256]; /* as given */
    struct MHD_Daemon *daemon;
    Connections connections; /* of its thread */
    ErrorCurve curve; /* with the snapshot's lock */
    double counted; /* of its thread: snapshot_reader_count */
    _Atomic double last_request; /* with the token, in timing_now */
    atomic_bool last_sent; /* the picture of the end has been sent to somebody */
};

/* What the context of a request points to: it is known; and its answer is the picture of the end. */
static char begun, last;

/* ---- answers ----------------------------------------------------------------------------------------------------- */

static enum MHD_Result answer(struct MHD_Connection *connection, unsigned status, struct MHD_Response *response)
{
    static const char *const HEADERS[][2] = {
        {"Content-Security-Policy",
         "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
         "connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
        {"Cache-Control", "no-store"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Resource-Policy", "same-origin"}};
    if (!response)
        return MHD_NO;
    for (size_t i = 0; i < sizeof HEADERS / sizeof HEADERS[0]; ++i)
        MHD_add_response_header(response, HEADERS[i][0], HEADERS[i][1]);
    enum MHD_Result queued = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return queued;
}

static enum MHD_Result answer_text(struct MHD_Connection *connection, unsigned status, const char *text)
{
    struct MHD_Response *response =
        MHD_create_response_from_buffer(strlen(text), (void *)(uintptr_t)text, MHD_RESPMEM_PERSISTENT);
    if (response)
        MHD_add_response_header(response, "Content-Type", "text/plain; charset=utf-8");
    return answer(connection, status, response);
}

static enum MHD_Result page_answer(struct MHD_Connection *connection)
{
    struct MHD_Response *response =
        MHD_create_response_from_buffer(sizeof PAGE, (void *)(uintptr_t)PAGE, MHD_RESPMEM_PERSISTENT);
    if (response)
        MHD_add_response_header(response, "Content-Type", "text/html; charset=utf-8");
    return answer(connection, MHD_HTTP_OK, response);
}

/* ---- the status -------------------------------------------------------------------------------------------------- */

/* Adds a point to the curve of errors if the halves are there, or asks for them, if it is time for one. */
static void curve_renew(Server *server)
{
    Snapshot *snapshot = server->snapshot;
    SnapshotLayer *a = snapshot_find(snapshot, "halfA"), *b = snapshot_find(snapshot, "halfB");
    double seconds = snapshot->status.progress.elapsed;
    if (!a || !b || !error_curve_due(&server->curve, seconds))
        return;
    if (a->version == snapshot->version && b->version == snapshot->version) {
        const ErrorGoal blocks = {.blocks = true};
        const float *const halves[2] = {a->rgb, b->rgb};
        HalvesError found;
        Error error = {0};
        if (halves_error_of_images(halves, snapshot->width, snapshot->height, &blocks, &found, &error) &&
            found.value > 0.0)
            error_curve_add(&server->curve, seconds, found.value);
    } else
        a->once = b->once = true;
}

static enum MHD_Result status_answer(Server *server, struct MHD_Connection *connection)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return MHD_NO;
    pthread_mutex_lock(&server->snapshot->lock);
    snapshot_reader_count(server->snapshot, &server->counted);
    snapshot_watch(server->snapshot);
    curve_renew(server);
    status_json_write(stream, server->snapshot, server->facts, &server->curve);
    pthread_mutex_unlock(&server->snapshot->lock);
    if (fclose(stream) != 0) {
        free(text);
        return MHD_NO;
    }
    struct MHD_Response *response = MHD_create_response_from_buffer(size, text, MHD_RESPMEM_MUST_FREE);
    if (response)
        MHD_add_response_header(response, "Content-Type", "application/json");
    return answer(connection, MHD_HTTP_OK, response);
}

/* ---- the picture ------------------------------------------------------------------------------------------------- */

/* The value of a whole number in the query; `otherwise` if it is not given, -1 if it is not such a number. */
static long long query_whole(struct MHD_Connection *connection, const char *key, long long otherwise)
{
    const char *text = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, key);
    char *end;
    if (!text)
        return otherwise;
    long long value = strtoll(text, &end, 10);
    return end == text || *end || value < 0 ? -1 : value;
}

/* A picture that is asked for. */
typedef struct Wanted {
    SnapshotLayer *layer, *other; /* other: is subtracted, or NULL */
    long long level, after; /* after: the version that the client has */
    bool half;
} Wanted;

/* Finds the layers. The caller holds the lock. */
static bool wanted_read(Server *server, struct MHD_Connection *connection, Wanted *wanted)
{
    const char *name = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "layer");
    const char *format = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "format");
    bool difference = name && strcmp(name, LAYER_DIFFERENCE) == 0;
    *wanted = (Wanted){.level = query_whole(connection, "level", 0),
                       .after = query_whole(connection, "after", 0),
                       .half = !format || strcmp(format, "half") == 0};
    wanted->layer = snapshot_find(server->snapshot, difference ? "halfA" : name ? name : SNAPSHOT_PICTURE);
    wanted->other = difference ? snapshot_find(server->snapshot, "halfB") : NULL;
    return wanted->layer && (!difference || wanted->other) && wanted->level >= 0 && wanted->level <= PIXELS_LEVEL_MAX &&
           wanted->after >= 0 && (wanted->half || strcmp(format, "float") == 0);
}

static void header_whole(struct MHD_Response *response, const char *name, unsigned long long value)
{
    char text[32];
    snprintf(text, sizeof text, "%llu", value);
    MHD_add_response_header(response, name, text);
}

static struct MHD_Response *pixels_response(Pixels *pixels, uint64_t version)
{
    struct MHD_Response *response = MHD_create_response_from_buffer(pixels->size, pixels->bytes, MHD_RESPMEM_MUST_FREE);
    if (!response) {
        free(pixels->bytes);
        return NULL;
    }
    MHD_add_response_header(response, "Content-Type", "application/octet-stream");
    header_whole(response, "X-Width", (unsigned long long)pixels->width);
    header_whole(response, "X-Height", (unsigned long long)pixels->height);
    header_whole(response, "X-Version", version);
    return response;
}

/* *context becomes &last if the picture of the end is sent. */
static enum MHD_Result picture_answer(Server *server, struct MHD_Connection *connection, void **context)
{
    Snapshot *snapshot = server->snapshot;
    Wanted wanted;
    Pixels pixels = {0};
    pthread_mutex_lock(&snapshot->lock);
    snapshot_reader_count(snapshot, &server->counted);
    bool known = wanted_read(server, connection, &wanted), newer = false, ended = snapshot->status.ended;
    uint64_t version = known ? wanted.layer->version : 0;
    if (known) {
        snapshot_watch(snapshot);
        snapshot_ask(wanted.layer);
        if (wanted.other)
            snapshot_ask(wanted.other);
        newer = wanted.layer->rgb && (!wanted.other || wanted.other->rgb) && version > (uint64_t)wanted.after;
    }
    bool made = newer && pixels_make(&pixels, wanted.layer->rgb, wanted.other ? wanted.other->rgb : NULL,
                                     snapshot->width, snapshot->height, (int)wanted.level, wanted.half);
    pthread_mutex_unlock(&snapshot->lock);
    if (!known)
        return answer_text(connection, MHD_HTTP_NOT_FOUND, "no such picture\n");
    if (!newer)
        return answer(connection, MHD_HTTP_NO_CONTENT,
                      MHD_create_response_from_buffer(0, NULL, MHD_RESPMEM_PERSISTENT));
    if (!made)
        return answer_text(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "out of memory\n");
    *context = ended ? &last : *context;
    return answer(connection, MHD_HTTP_OK, pixels_response(&pixels, version));
}

/* ---- requests ---------------------------------------------------------------------------------------------------- */

/* The Connection of a connection is its socket context. */
static void connection_notify(void *argument, struct MHD_Connection *connection, void **context,
                              enum MHD_ConnectionNotificationCode code)
{
    Server *server = argument;
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    if (code == MHD_CONNECTION_NOTIFY_CLOSED)
        connection_remove(*context);
    else if (info)
        *context = connection_add(&server->connections, info->connect_fd, timing_now());
}

/* Notes a whole request. */
static void request_note(Server *server, struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    Connection *known = info ? info->socket_context : NULL;
    double now = timing_now();
    atomic_store(&server->last_request, now);
    if (known)
        known->requested = now;
}

/* Called once with the head of a request, whose context is NULL, and again with its body, if any, and at its end. */
static enum MHD_Result request_answer(void *argument, struct MHD_Connection *connection, const char *path,
                                      const char *method, const char *version, const char *data, size_t *data_size,
                                      void **context)
{
    Server *server = argument;
    (void)version;
    (void)data;
    RequestKind kind = request_kind(path, server->token);
    const char *host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Host");
    if (kind == REQUEST_FORBIDDEN || !host_allowed(host, server->host))
        return answer_text(connection, MHD_HTTP_FORBIDDEN, "open the address that twinlight has printed\n");
    if (strcmp(method, "GET") != 0)
        return answer_text(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "read only\n");
    if (!*context) { /* an answer to the head alone would close the connection */
        *context = &begun;
        return MHD_YES;
    }
    if (*data_size > 0)
        return MHD_NO;
    request_note(server, connection);
    switch (kind) {
    case REQUEST_PAGE:
        return page_answer(connection);
    case REQUEST_STATUS:
        return status_answer(server, connection);
    case REQUEST_PICTURE:
        return picture_answer(server, connection, context);
    default:
        return answer_text(connection, MHD_HTTP_NOT_FOUND, "there is no such page\n");
    }
}

static void request_end(void *argument, struct MHD_Connection *connection, void **context,
                        enum MHD_RequestTerminationCode code)
{
    Server *server = argument;
    (void)connection;
    if (*context == &last && code == MHD_REQUEST_TERMINATED_COMPLETED_OK)
        atomic_store(&server->last_sent, true);
}

/* ---- begin and end ----------------------------------------------------------------------------------------------- */

bool server_available(Error *error)
{
    (void)error;
    return true;
}

static bool daemon_start(Server *server, const OptionAddress *address, Error *error)
{
    const struct addrinfo wanted = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE};
    struct addrinfo *found = NULL;
    char port[16];
    sigset_t before;
    snprintf(port, sizeof port, "%u", address->port);
    if (getaddrinfo(address->host, port, &wanted, &found) != 0) {
        error_set(error, "--serve=%s:%s: there is no such address", address->host, port);
        return error_fix(error, "give an address of this machine, as in 127.0.0.1:8080, or --serve alone");
    }
    /* ITC: the thread is woken at the end even if no more connections are accepted. */
    unsigned flags = MHD_USE_AUTO_INTERNAL_THREAD | MHD_USE_ITC | (found->ai_family == AF_INET6 ? MHD_USE_IPv6 : 0);
    signals_block(&before); /* in the server's thread */
    errno = 0;
    server->daemon = MHD_start_daemon(flags, 0, NULL, NULL, request_answer, server, MHD_OPTION_SOCK_ADDR,
                                      found->ai_addr, MHD_OPTION_CONNECTION_LIMIT, CONNECTIONS_WITH_CLOSING,
                                      MHD_OPTION_CONNECTION_TIMEOUT, IDLE_SECONDS, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
                                      REQUEST_BYTES_MAX, MHD_OPTION_NOTIFY_COMPLETED, request_end, server,
                                      MHD_OPTION_NOTIFY_CONNECTION, connection_notify, server, MHD_OPTION_END);
    int failure = errno;
    signals_unblock(&before);
    freeaddrinfo(found);
    if (server->daemon)
        return true;
    error_set(error, "--serve=%s:%s: cannot listen there: %s", address->host, port, strerror(failure));
    return error_fix(error, "give an address of this machine and a port that is free, or --serve alone");
}

Server *server_begin(const OptionAddress *address, Snapshot *snapshot, const RenderFacts *facts, Error *error)
{
    Server *server = calloc(1, sizeof *server);
    if (!server) {
        error_memory(error, sizeof *server, "the page of the rendering");
        return NULL;
    }
    server->snapshot = snapshot;
    server->facts = facts;
    server->last_request = -PRESENT_SECONDS;
    snprintf(server->host, sizeof server->host, "%s", address->host);
    if (!token_make(server->token, error) || !daemon_start(server, address, error)) {
        free(server);
        return NULL;
    }
    const union MHD_DaemonInfo *info = MHD_get_daemon_info(server->daemon, MHD_DAEMON_INFO_BIND_PORT);
    bool brackets = strchr(address->host, ':') != NULL;
    fprintf(stderr, "watch the rendering at http://%s%s%s:%u/%s/\n", brackets ? "[" : "", address->host,
            brackets ? "]" : "", info ? info->port : address->port, server->token);
    return server;
}

/* Whether a client is there that has not got the last picture. Of several clients nothing more is known than that one
 * has it. */
static bool client_waits(const Server *server)
{
    const union MHD_DaemonInfo *info = MHD_get_daemon_info(server->daemon, MHD_DAEMON_INFO_CURRENT_CONNECTIONS);
    bool several = info && info->num_connections > 1;
    bool present = timing_now() - atomic_load(&server->last_request) < PRESENT_SECONDS;
    return present && (several || !atomic_load(&server->last_sent));
}

void server_end(Server *server)
{
    if (!server)
        return;
    double until = timing_now() + END_SECONDS;
    while (timing_now() < until && client_waits(server))
        poll(NULL, 0, 20);
    MHD_stop_daemon(server->daemon);
    free(server);
}
