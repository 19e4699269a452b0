/* Parsing of numbers: correctly rounded and fast. Needs the C locale, which is in force because nothing calls
 * setlocale. */
#ifndef TWINLIGHT_BASE_TEXT_NUMBER_H
#define TWINLIGHT_BASE_TEXT_NUMBER_H

#include <stddef.h>

typedef enum NumberStatus {
    NUMBER_OK,
    NUMBER_MALFORMED, /* not [+-] digits [. digits] [e [+-] digits]; includes "nan" and "inf" */
    NUMBER_OVERFLOW /* well-formed and finite, but beyond the type's range */
} NumberStatus;

/* Converts all of text[0 .. length) to a float, correctly rounded. NUMBER_MALFORMED also when out of memory. */
NumberStatus number_float(const char *text, size_t length, float *value);

/* Converts all of text[0 .. length) to a 32-bit integer. */
NumberStatus number_integer(const char *text, size_t length, int *value);

#endif
