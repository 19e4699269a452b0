#include "serve/served.h"

#include "serve/test_serve.h"
#include "support/test_files.h"
#include "support/test_util.h"

#include "base/timing.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdint.h>
#include <sys/socket.h>
#include <sys/wait.h>

/* Reads port and token; false if they have not been printed yet. */
static bool served_address(Served *served, const char *messages)
{
    const char *found = strstr(messages, served->ipv6 ? "http://[::1]:" : "http://127.0.0.1:");
    return found && sscanf(strrchr(found, ':'), ":%u/%32[0-9a-f]/", &served->port, served->token) == 2 &&
           strlen(served->token) == TOKEN_DIGITS;
}

void served_begin(Served *served, const char *size, const char *limit)
{
    char output[600], resolution[32], *messages;
    const char *path, *serve = served->ipv6 ? "--serve=[::1]:0" : "--serve";
    size_t bytes;
    test_folder_make();
    snprintf(served->exr, sizeof served->exr, "%s", test_path("a.exr"));
    snprintf(output, sizeof output, "--output=%s", served->exr);
    snprintf(resolution, sizeof resolution, "--resolution=%s", size);
    path = test_path("messages");
    served->process = program_start((const char *[]){output, limit, resolution, serve}, path);
    for (int i = 0; i < 200; ++i) {
        usleep(50000);
        if (access(path, R_OK) != 0)
            continue;
        messages = (char *)test_file_read(path, &bytes);
        messages[bytes] = '\0';
        bool printed = served_address(served, messages);
        free(messages);
        if (printed)
            return;
    }
    ck_abort_msg("no address is printed");
}

double served_end(const Served *served)
{
    int status;
    double begin = timing_now();
    ck_assert_int_eq(waitpid(served->process, &status, 0), served->process);
    ck_assert_msg(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 130), "%d", status);
    return timing_now() - begin;
}

void served_remove(void)
{
    test_folder_remove();
}

int served_connect(const Served *served)
{
    in_port_t port = htons((uint16_t)served->port);
    struct sockaddr_in v4 = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK), .sin_port = port};
    struct sockaddr_in6 v6 = {.sin6_family = AF_INET6, .sin6_addr = IN6ADDR_LOOPBACK_INIT, .sin6_port = port};
    const void *address = served->ipv6 ? (void *)&v6 : (void *)&v4;
    int made = socket(served->ipv6 ? AF_INET6 : AF_INET, SOCK_STREAM, 0);
    struct timeval limit = {.tv_sec = 5};
    setsockopt(made, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    if (connect(made, address, served->ipv6 ? sizeof v6 : sizeof v4) == 0)
        return made;
    close(made);
    return -1;
}

Reply request_send(const Served *served, const char *request)
{
    size_t capacity = 1 << 24, size = 0;
    unsigned char *bytes = calloc(1, capacity);
    int to = served_connect(served);
    ssize_t got = to >= 0 ? send(to, request, strlen(request), MSG_NOSIGNAL) : 0;
    while (got > 0 && (got = recv(to, bytes + size, capacity - 1 - size, 0)) > 0)
        size += (size_t)got;
    if (to >= 0)
        close(to);
    Reply reply = {.head = (char *)bytes};
    char *end = strstr(reply.head, "\r\n\r\n");
    if (!end || sscanf(reply.head, "HTTP/1.%*d %d", &reply.status) != 1)
        return reply;
    *end = '\0';
    reply.body = (unsigned char *)end + 4;
    reply.size = size - (size_t)(reply.body - bytes);
    return reply;
}

Reply get(const Served *served, const char *path)
{
    char request[512];
    snprintf(request, sizeof request, "GET /%s/%s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
             served->token, path);
    return request_send(served, request);
}

int get_status(const Served *served, const char *path)
{
    Reply reply = get(served, path);
    free(reply.head);
    return reply.status;
}

long header(const Reply *reply, const char *name)
{
    const char *at = strstr(reply->head, name);
    return at ? strtol(at + strlen(name) + 2, NULL, 10) : -1;
}
