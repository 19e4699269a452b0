/* Strict parsing of option values. Every function must consume all of `text`; otherwise it fails with an Error that
 * names the option, the value and what is accepted. `option` is the name without dashes. */
#ifndef TWINLIGHT_BASE_OPTION_VALUES_H
#define TWINLIGHT_BASE_OPTION_VALUES_H

#include "base/error.h"

#include <stdint.h>

/* A decimal integer, low <= value <= high. */
bool option_whole(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *value, Error *error);

/* A decimal number with optional fraction and exponent, low <= value <= high. */
bool option_number(const char *option, const char *text, double low, double high, double *value, Error *error);

/* A number as above, or in percent: 2% is 0.02. */
bool option_part(const char *option, const char *text, double low, double high, double *value, Error *error);

/* A positive duration of at most a year with its unit (30s, 10m, 2h, 1.5h), in seconds. */
bool option_seconds(const char *option, const char *text, double *seconds, Error *error);

/* WxH, each 1 ... OPTION_SIZE_MAX. */
bool option_resolution(const char *option, const char *text, int size[2], Error *error);

/* x0,y0,x1,y1 with x0 < x1 and y0 < y1, each 0 ... OPTION_SIZE_MAX. */
bool option_crop(const char *option, const char *text, int crop[4], Error *error);

/* Largest width and height: its square is below 2^32 - 1, so every pixel has a 32-bit index that is not NONE. */
#define OPTION_SIZE_MAX 65535

/* s,t of a bidirectional strategy: s >= 0 vertices from the light, t >= 1 from the camera, s + t >= 2. */
bool option_strategy(const char *option, const char *text, unsigned strategy[2], Error *error);

/* A place in a network: HOST:PORT, or [HOST]:PORT for addresses of IPv6. */
typedef struct OptionAddress {
    char host[256]; /* a name or a number; "": none is given */
    unsigned port;
} OptionAddress;

/* HOST:PORT, low <= port <= 65535. The host is not looked up. */
bool option_address(const char *option, const char *text, unsigned low, OptionAddress *address, Error *error);

/* Names with `separator` between them: name i of `names` sets bit i of *bits. On any other name returns false, with
 * *other pointing to it; the message is left to the caller. */
bool option_names(const char *text, char separator, const char *const *names, unsigned count, unsigned *bits,
                  const char **other);

#endif
