/* A program that serves the page of its rendering, and requests to it. */
#ifndef TWINLIGHT_TESTS_SERVE_SERVED_H
#define TWINLIGHT_TESTS_SERVE_SERVED_H

#include "serve/request.h"

#include <stddef.h>
#include <sys/types.h>

/* A program that serves. */
typedef struct Served {
    bool ipv6; /* at ::1; otherwise at 127.0.0.1 */
    pid_t process;
    unsigned port;
    char token[TOKEN_DIGITS + 1];
    char exr[512];
} Served;

/* Starts the program in a new test folder, served->ipv6 being set, and reads the address that it prints. limit: the
 * option that says how long it renders. */
void served_begin(Served *served, const char *size, const char *limit);

/* Waits for the program's end; returns the seconds until then. */
double served_end(const Served *served);

/* Removes the test folder. */
void served_remove(void);

/* A connection whose reads fail after 5 seconds, or -1. */
int served_connect(const Served *served);

typedef struct Reply {
    int status; /* 0: none */
    char *head;
    unsigned char *body;
    size_t size; /* of the body */
} Reply;

/* Sends `request` as it is and reads until the connection is closed. Free `head`. */
Reply request_send(const Served *served, const char *request);

/* GET /TOKEN/path. */
Reply get(const Served *served, const char *path);
int get_status(const Served *served, const char *path);

/* The value of a header that is a whole number. */
long header(const Reply *reply, const char *name);

#endif
