/* Clients of the page that hang, send or read slowly, or send too much: they keep neither the rendering nor other
 * clients waiting. */
#include "serve/served.h"
#include "serve/test_serve.h"

#include "support/test_files.h"
#include "support/test_util.h"

#include "base/timing.h"
#include "serve/connections.h"
#include "serve/server.h"

#include <errno.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/socket.h>

#define SECONDS_ANSWER 4.0 /* an answer to a request takes less, also on a busy machine */

/* ---- which connections are closed -------------------------------------------------------------------------------- */

/* The far ends of connections number 0 to CONNECTIONS_WITH_CLOSING - 1, made at the times 0, 1, ... */
typedef struct Ends {
    Connections connections;
    Connection *entries[CONNECTIONS_WITH_CLOSING];
    int near[CONNECTIONS_WITH_CLOSING], far[CONNECTIONS_WITH_CLOSING];
} Ends;

static void ends_add(Ends *ends, unsigned i)
{
    int pair[2];
    ck_assert_int_eq(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
    ends->near[i] = pair[0];
    ends->far[i] = pair[1];
    ends->entries[i] = connection_add(&ends->connections, pair[0], (double)i);
    ck_assert_ptr_nonnull(ends->entries[i]);
}

/* Whether connection i has been shut down. */
static bool is_shut(const Ends *ends, unsigned i)
{
    char byte;
    return recv(ends->far[i], &byte, 1, MSG_DONTWAIT) == 0;
}

START_TEST(longest_without_a_request_is_closed)
{
    Ends ends = {0};
    for (unsigned i = 0; i < CONNECTIONS_MAX; ++i)
        ends_add(&ends, i);
    for (unsigned i = 0; i < CONNECTIONS_MAX; ++i)
        ck_assert(!is_shut(&ends, i));
    ends.entries[0]->requested = 100.0;
    connection_remove(ends.entries[2]);
    ends_add(&ends, CONNECTIONS_MAX); /* takes the place of number 2 */
    ck_assert(!is_shut(&ends, 1));
    for (unsigned more = 1; more < CONNECTIONS_MAX; ++more) {
        ends_add(&ends, CONNECTIONS_MAX + more);
        for (unsigned i = 0; i <= CONNECTIONS_MAX + more; ++i) { /* numbers 1, 3, 4, ... are closed, one at a time */
            bool early = i != 0 && i != 2 && i <= (more == 1 ? 1 : more + 1);
            ck_assert_msg(is_shut(&ends, i) == early, "%u after %u", i, more);
        }
    }
    connection_remove(ends.entries[1]);
    ck_assert_ptr_nonnull(connection_add(&ends.connections, ends.near[1], 101.0));
    ck_assert_ptr_nonnull(connection_add(&ends.connections, ends.near[1], 102.0)); /* the 64th */
    ck_assert_ptr_null(connection_add(&ends.connections, ends.near[1], 103.0));
    connection_remove(NULL);
    for (unsigned i = 0; i < CONNECTIONS_WITH_CLOSING; ++i) {
        close(ends.near[i]);
        close(ends.far[i]);
    }
}
END_TEST

/* ---- a crowd of bad clients -------------------------------------------------------------------------------------- */

/* What a client does, forever. */
typedef enum Behaviour {
    NOTHING,
    SENDS_SLOWLY, /* a byte of a request's head at a time */
    READS_SLOWLY, /* asks for the picture, then takes a byte at a time */
    SENDS_HEADERS, /* a megabyte of them */
    BEHAVIOURS
} Behaviour;

enum { CROWD = 200, HEADER_BYTES = 1 << 20 };

typedef struct Client {
    Behaviour behaviour;
    int socket; /* -1: the connection is closed */
    size_t sent;
} Client;

/* The thread of all of them. */
typedef struct Crowd {
    Client clients[CROWD];
    char *head; /* of a request, without an end */
    atomic_bool leaves;
    pthread_t thread;
} Crowd;

/* False if the connection has been closed. */
static bool client_act(const Crowd *crowd, Client *client)
{
    char byte;
    ssize_t done;
    size_t left = HEADER_BYTES - client->sent;
    bool sends = client->behaviour == SENDS_SLOWLY || client->behaviour == SENDS_HEADERS;
    if (!sends || left == 0)
        done = recv(client->socket, &byte, 1, MSG_DONTWAIT);
    else {
        done = send(client->socket, crowd->head + client->sent, client->behaviour == SENDS_SLOWLY ? 1 : left,
                    MSG_NOSIGNAL | MSG_DONTWAIT);
        client->sent += done > 0 ? (size_t)done : 0;
    }
    return done > 0 || (done < 0 && (errno == EAGAIN || errno == EWOULDBLOCK));
}

static void *crowd_run(void *argument)
{
    Crowd *crowd = argument;
    while (!atomic_load(&crowd->leaves)) {
        for (int i = 0; i < CROWD; ++i) {
            Client *client = &crowd->clients[i];
            if (client->socket < 0 || client_act(crowd, client))
                continue;
            close(client->socket);
            client->socket = -1;
        }
        usleep(20000);
    }
    return NULL;
}

/* All connect, one kind after the other in turn, or all of `only` if that is not BEHAVIOURS. */
static void crowd_begin(Crowd *crowd, const Served *served, Behaviour only)
{
    char request[256];
    memset(crowd, 0, sizeof *crowd);
    crowd->head = malloc(HEADER_BYTES + 256);
    int start = sprintf(crowd->head, "GET /%s/ HTTP/1.1\r\nHost: localhost\r\n", served->token);
    for (size_t i = (size_t)start; i < HEADER_BYTES; ++i)
        crowd->head[i] = "A: bcd\r\n"[(i - (size_t)start) % 8];
    int size = sprintf(request, "GET /%s/picture?format=float HTTP/1.1\r\nHost: localhost\r\n\r\n", served->token);
    for (int i = 0; i < CROWD; ++i) {
        Client *client = &crowd->clients[i];
        client->behaviour = only != BEHAVIOURS ? only : (Behaviour)(i % BEHAVIOURS);
        client->socket = served_connect(served);
        ck_assert_int_ge(client->socket, 0);
        if (client->behaviour == READS_SLOWLY)
            send(client->socket, request, (size_t)size, MSG_NOSIGNAL);
    }
    ck_assert_int_eq(pthread_create(&crowd->thread, NULL, crowd_run, crowd), 0);
}

/* All leave; returns how many connections were open until then. */
static unsigned crowd_end(Crowd *crowd)
{
    unsigned open = 0;
    atomic_store(&crowd->leaves, true);
    pthread_join(crowd->thread, NULL);
    for (int i = 0; i < CROWD; ++i)
        if (crowd->clients[i].socket >= 0) {
            close(crowd->clients[i].socket);
            ++open;
        }
    free(crowd->head);
    return open;
}

/* ---- what they do to others -------------------------------------------------------------------------------------- */

/* While bad clients hold all connections that there may be, a good one gets its answers at once. */
START_TEST(good_client_gets_its_picture)
{
    const Behaviour behaviour = (Behaviour)_i;
    Served served = {0};
    Crowd crowd;
    served_begin(&served, "320x240", "--time=60s");
    crowd_begin(&crowd, &served, behaviour);
    int pictures = 0;
    for (int i = 0; i < 40 && pictures < 2; ++i) {
        double begin = timing_now();
        ck_assert_int_eq(get_status(&served, "status.json"), 200);
        pictures += get_status(&served, "picture") == 200;
        ck_assert_msg(timing_now() - begin < SECONDS_ANSWER, "%g s", timing_now() - begin);
        usleep(250000);
    }
    ck_assert_int_eq(pictures, 2);
    unsigned open = crowd_end(&crowd);
    /* Clients that take what has been sent byte by byte do not see the end of their connection yet. */
    ck_assert_uint_le(open, behaviour < READS_SLOWLY ? CONNECTIONS_MAX : CROWD);
    kill(served.process, SIGINT);
    served_end(&served);
    served_remove();
}
END_TEST

/* A connection that asks again and again stays while two hundred others come. */
START_TEST(connection_in_use_stays)
{
    Served served = {0};
    char request[256], answer[4096];
    int others[CROWD];
    served_begin(&served, "64x48", "--time=60s");
    int own = served_connect(&served);
    int size = sprintf(request, "GET /%s/nothing HTTP/1.1\r\nHost: localhost\r\n\r\n", served.token);
    for (int i = 0; i < CROWD; ++i) {
        others[i] = served_connect(&served);
        ck_assert_int_ge(others[i], 0);
        if (i % 8 != 0)
            continue;
        ck_assert_int_eq(send(own, request, (size_t)size, MSG_NOSIGNAL), size);
        ssize_t got = recv(own, answer, sizeof answer - 1, 0);
        ck_assert_msg(got > 12 && memcmp(answer, "HTTP/1.1 404", 12) == 0, "after %d connections", i + 1);
    }
    for (int i = 0; i < CROWD; ++i)
        close(others[i]);
    close(own);
    kill(served.process, SIGINT);
    served_end(&served);
    served_remove();
}
END_TEST

/* Renders with a number of samples; returns its file, and the seconds that it took. */
static unsigned char *rendering(bool crowded, size_t *size, double *seconds)
{
    Served served = {0};
    Crowd crowd;
    double begin = timing_now();
    served_begin(&served, "160x120", "--samples=96");
    if (crowded)
        crowd_begin(&crowd, &served, BEHAVIOURS);
    served_end(&served);
    *seconds = timing_now() - begin;
    if (crowded)
        crowd_end(&crowd);
    unsigned char *file = test_file_read(served.exr, size);
    served_remove();
    return file;
}

/* The file has the same bytes, in about the same time. */
START_TEST(rendering_is_the_same)
{
    size_t sizes[2];
    double seconds[2];
    unsigned char *alone = rendering(false, &sizes[0], &seconds[0]);
    unsigned char *crowded = rendering(true, &sizes[1], &seconds[1]);
    ck_assert_uint_eq(sizes[0], sizes[1]);
    ck_assert_int_eq(memcmp(alone, crowded, sizes[0]), 0);
    ck_assert_msg(seconds[1] < 2.0 * seconds[0] + SECONDS_ANSWER, "%g s, with clients %g s", seconds[0], seconds[1]);
    free(alone);
    free(crowded);
}
END_TEST

/* A request whose head is too large is refused, and the next is answered. */
START_TEST(large_headers)
{
    Served served = {0};
    char *request = malloc(HEADER_BYTES + 8);
    served_begin(&served, "64x48", "--time=60s");
    int size = sprintf(request, "GET /%s/ HTTP/1.1\r\nHost: localhost\r\nA: ", served.token);
    memset(request + size, 'a', (size_t)(HEADER_BYTES - size));
    memcpy(request + HEADER_BYTES, "\r\n\r\n", 5);
    Reply reply = request_send(&served, request); /* 431, or closed */
    ck_assert_int_ne(reply.status, 200);
    free(reply.head);
    free(request);
    ck_assert_int_eq(get_status(&served, "status.json"), 200);
    kill(served.process, SIGINT);
    served_end(&served);
    served_remove();
}
END_TEST

static bool ipv6_exists(void)
{
    const struct sockaddr_in6 address = {.sin6_family = AF_INET6, .sin6_addr = IN6ADDR_LOOPBACK_INIT};
    int made = socket(AF_INET6, SOCK_STREAM, 0);
    bool bound = made >= 0 && bind(made, (const struct sockaddr *)&address, sizeof address) == 0;
    if (made >= 0)
        close(made);
    return bound;
}

START_TEST(ipv6)
{
    Served served = {.ipv6 = true};
    if (!ipv6_exists()) {
        fprintf(stderr, "skipped: this machine has no address ::1\n");
        return;
    }
    served_begin(&served, "64x48", "--time=60s");
    char request[256];
    sprintf(request, "GET /%s/status.json HTTP/1.1\r\nHost: [::1]:%u\r\nConnection: close\r\n\r\n", served.token,
            served.port);
    Reply reply = request_send(&served, request);
    ck_assert_int_eq(reply.status, 200);
    free(reply.head);
    ck_assert_int_eq(get_status(&served, ""), 200);
    kill(served.process, SIGINT);
    served_end(&served);
    served_remove();
}
END_TEST

TCase *clients_case(void)
{
    Error error;
    TCase *tests = tcase_create("clients");
    tcase_set_timeout(tests, 120.0);
    tcase_add_test(tests, longest_without_a_request_is_closed);
    if (!server_available(&error))
        return tests;
    tcase_add_loop_test(tests, good_client_gets_its_picture, NOTHING, BEHAVIOURS + 1);
    tcase_add_test(tests, connection_in_use_stays);
    tcase_add_test(tests, rendering_is_the_same);
    tcase_add_test(tests, large_headers);
    tcase_add_test(tests, ipv6);
    return tests;
}
