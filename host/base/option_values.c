#include "base/option_values.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Reads decimal digits at *text and advances past them. Values that do not fit become UINT64_MAX. */
static bool read_whole(const char **text, uint64_t *value)
{
    if (!is_digit(**text))
        return false;
    char *end;
    errno = 0;
    *value = strtoull(*text, &end, 10);
    *text = end;
    return true;
}

bool option_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *value, Error *error)
{
    const char *end = text;
    if (!read_whole(&end, value) || *end) {
        error_set(error, "--%s=%s: not a whole number", option, text);
        return error_fix(error, "give a whole number from %" PRIu64 " to %" PRIu64, low, high);
    }
    if (*value < low || *value > high || errno == ERANGE) {
        error_set(error, "--%s=%s: out of range", option, text);
        return error_fix(error, "give a whole number from %" PRIu64 " to %" PRIu64, low, high);
    }
    return true;
}

/* Reads a decimal number at *text and advances past it. Plain strtod would also accept blanks, hexadecimal, inf and
 * nan. */
static bool read_number(const char **text, double *value)
{
    const char *start = *text;
    if (*start == '-' || *start == '+')
        ++start;
    if (start[0] == '0' && (start[1] == 'x' || start[1] == 'X'))
        return false;
    if (!is_digit(start[0]) && !(start[0] == '.' && is_digit(start[1])))
        return false;
    char *end;
    *value = strtod(*text, &end);
    *text = end;
    return true;
}

bool option_number(const char *option, const char *text, double low, double high, double *value, Error *error)
{
    const char *end = text;
    if (!read_number(&end, value) || *end) {
        error_set(error, "--%s=%s: not a number", option, text);
        return error_fix(error, "give a number from %g to %g", low, high);
    }
    if (!(*value >= low && *value <= high)) {
        error_set(error, "--%s=%s: out of range", option, text);
        return error_fix(error, "give a number from %g to %g", low, high);
    }
    return true;
}

bool option_part(const char *option, const char *text, double low, double high, double *value, Error *error)
{
    const char *end = text;
    bool read = read_number(&end, value), percent = *end == '%';
    if (!read || end[percent ? 1 : 0]) {
        error_set(error, "--%s=%s: neither a number nor a percentage", option, text);
        return error_fix(error, "give one from %g to %g, or %g%% to %g%%", low, high, 100.0 * low, 100.0 * high);
    }
    *value = percent ? *value / 100.0 : *value;
    if (!(*value >= low && *value <= high)) {
        error_set(error, "--%s=%s: out of range", option, text);
        return error_fix(error, "give a number from %g to %g, or %g%% to %g%%", low, high, 100.0 * low, 100.0 * high);
    }
    return true;
}

bool option_seconds(const char *option, const char *text, double *seconds, Error *error)
{
    const double YEAR = 365.0 * 24.0 * 3600.0;
    const char *end = text;
    bool read = read_number(&end, seconds) && end[0] && !end[1] && strchr("smh", end[0]);
    if (!read) {
        error_set(error, "--%s=%s: not a time", option, text);
        return error_fix(error, "give a number and its unit, as in 30s, 10m or 2h");
    }
    *seconds *= end[0] == 's' ? 1.0 : end[0] == 'm' ? 60.0 : 3600.0;
    if (!(*seconds > 0.0 && *seconds <= YEAR)) {
        error_set(error, "--%s=%s: out of range", option, text);
        return error_fix(error, "give a time above zero and of at most a year (8760h)");
    }
    return true;
}

/* Reads `count` whole numbers separated by `separator`, with nothing around them. */
static bool read_list(const char *text, char separator, int count, int *values)
{
    for (int i = 0; i < count; ++i) {
        uint64_t value;
        if (!read_whole(&text, &value) || value > OPTION_SIZE_MAX)
            return false;
        values[i] = (int)value;
        if (*text != (i + 1 < count ? separator : '\0'))
            return false;
        ++text;
    }
    return true;
}

bool option_resolution(const char *option, const char *text, int size[2], Error *error)
{
    if (read_list(text, 'x', 2, size) && size[0] > 0 && size[1] > 0)
        return true;
    error_set(error, "--%s=%s: not a size in pixels", option, text);
    return error_fix(error, "give width and height, each from 1 to %d, as in 640x480", OPTION_SIZE_MAX);
}

bool option_crop(const char *option, const char *text, int crop[4], Error *error)
{
    if (!read_list(text, ',', 4, crop)) {
        error_set(error, "--%s=%s: not a rectangle in pixels", option, text);
        return error_fix(error, "give x0,y0,x1,y1 counted from the upper left corner, as in 0,0,320,240");
    }
    if (crop[0] >= crop[2] || crop[1] >= crop[3]) {
        error_set(error, "--%s=%s: the rectangle is empty", option, text);
        return error_fix(error, "x0 must be below x1 and y0 below y1; pixels x0 to x1 - 1 are rendered");
    }
    return true;
}

bool option_strategy(const char *option, const char *text, unsigned strategy[2], Error *error)
{
    int numbers[2];
    if (!read_list(text, ',', 2, numbers) || numbers[1] < 1 || numbers[0] + numbers[1] < 2) {
        error_set(error, "--%s=%s: not a strategy", option, text);
        return error_fix(error,
                         "give s,t: s vertices from the light, t >= 1 from the camera (the lens counts), as in 1,2");
    }
    strategy[0] = (unsigned)numbers[0];
    strategy[1] = (unsigned)numbers[1];
    return true;
}

/* Splits HOST:PORT or [HOST]:PORT at the last colon; returns the text of the port, or NULL. */
static const char *address_split(const char *text, char *host, size_t size)
{
    const char *colon = strrchr(text, ':');
    size_t length = colon ? (size_t)(colon - text) : 0;
    if (length >= 2 && text[0] == '[' && text[length - 1] == ']') {
        text += 1;
        length -= 2;
    } else if (memchr(text, ':', length))
        return NULL; /* of IPv6, without brackets */
    if (length == 0 || length >= size)
        return NULL;
    memcpy(host, text, length);
    host[length] = '\0';
    return colon + 1;
}

bool option_address(const char *option, const char *text, unsigned low, OptionAddress *address, Error *error)
{
    uint64_t port = 0;
    const char *end = address_split(text, address->host, sizeof address->host);
    if (end && read_whole(&end, &port) && !*end && port >= low && port <= 65535) {
        address->port = (unsigned)port;
        return true;
    }
    error_set(error, "--%s=%s: not an address and a port", option, text);
    return error_fix(error, "give HOST:PORT with a port from %u to 65535, as in localhost:14158 or [::1]:14158", low);
}

bool option_names(const char *text, char separator, const char *const *names, unsigned count, unsigned *bits,
                  const char **other)
{
    const char end[2] = {separator, '\0'};
    *bits = 0;
    for (const char *name = text;; ++name) {
        size_t length = strcspn(name, end);
        unsigned found = 0;
        for (unsigned i = 0; i < count; ++i)
            if (strlen(names[i]) == length && strncmp(names[i], name, length) == 0)
                found = 1u << i;
        *other = name;
        if (!found)
            return false;
        *bits |= found;
        name += length;
        if (*name == '\0')
            return true;
    }
}
