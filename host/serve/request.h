/* What a client may ask for: checks of the token and of the host, and the parts of an address. */
#ifndef TWINLIGHT_SERVE_REQUEST_H
#define TWINLIGHT_SERVE_REQUEST_H

#include "base/error.h"

/* Hexadecimal digits of a token: 128 random bits. */
#define TOKEN_DIGITS 32

/* Makes a token from the system's random numbers. */
bool token_make(char token[TOKEN_DIGITS + 1], Error *error);

typedef enum RequestKind {
    REQUEST_FORBIDDEN,
    REQUEST_UNKNOWN,
    REQUEST_PAGE,
    REQUEST_STATUS,
    REQUEST_PICTURE
} RequestKind;

/* What a path asks for: /TOKEN/, /TOKEN/status.json, /TOKEN/picture. Forbidden without the token; how many of its
 * digits are right does not show in the time that this takes. */
RequestKind request_kind(const char *path, const char *token);

/* Whether the value of a Host header is "localhost", an address of IPv4 or IPv6 in digits, or `own`, with or without a
 * port: a name that somebody else could let lead here is refused. NULL: there is no header. */
bool host_allowed(const char *host, const char *own);

#endif
