#include "serve/request.h"

#include <arpa/inet.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

bool token_make(char token[TOKEN_DIGITS + 1], Error *error)
{
    unsigned char bytes[TOKEN_DIGITS / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return error_errno(error, "get random numbers for", "--serve");
    for (size_t i = 0; i < sizeof bytes; ++i)
        snprintf(token + 2 * i, 3, "%02x", bytes[i]);
    return true;
}

/* Compares all digits, whatever the first that differs. */
static bool token_right(const char *digits, const char *token)
{
    unsigned different = 0;
    if (strnlen(digits, TOKEN_DIGITS) < TOKEN_DIGITS)
        return false;
    for (size_t i = 0; i < TOKEN_DIGITS; ++i)
        different |= (unsigned char)digits[i] ^ (unsigned char)token[i];
    return different == 0;
}

RequestKind request_kind(const char *path, const char *token)
{
    if (path[0] != '/' || !token_right(path + 1, token) || path[1 + TOKEN_DIGITS] != '/')
        return REQUEST_FORBIDDEN;
    const char *name = path + 1 + TOKEN_DIGITS + 1;
    return name[0] == '\0'                    ? REQUEST_PAGE
           : strcmp(name, "status.json") == 0 ? REQUEST_STATUS
           : strcmp(name, "picture") == 0     ? REQUEST_PICTURE
                                              : REQUEST_UNKNOWN;
}

bool host_allowed(const char *host, const char *own)
{
    char name[256];
    struct in6_addr address;
    if (!host)
        return false;
    bool brackets = host[0] == '[';
    const char *start = host + brackets;
    size_t length = strcspn(start, brackets ? "]" : ":");
    const char *rest = start + length + (brackets && start[length] == ']');
    if (length == 0 || length >= sizeof name || rest[strspn(rest, ":0123456789")] != '\0')
        return false;
    memcpy(name, start, length);
    name[length] = '\0';
    if (brackets)
        return inet_pton(AF_INET6, name, &address) == 1;
    return strcasecmp(name, "localhost") == 0 || strcasecmp(name, own) == 0 || inet_pton(AF_INET, name, &address) == 1;
}
