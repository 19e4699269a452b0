/* Parsing of numbers: correctly rounded, fast, and independent of the locale. */
#ifndef TWINLIGHT_BASE_TEXT_NUMBER_H
#define TWINLIGHT_BASE_TEXT_NUMBER_H

#include <stddef.h>

typedef enum NumberStatus {
    NUMBER_OK,
    NUMBER_MALFORMED, /* not [+-] digits [. digits] [e [+-] digits]; includes "nan" and "inf" */
    NUMBER_OVERFLOW /* well-formed and finite, but beyond the type's range */
} NumberStatus;

/* Converts all of text[0 .. length) to a float, correctly rounded. */
NumberStatus number_float(const char *text, size_t length, float *value);

/* Converts all of text[0 .. length) to a 32-bit integer. */
NumberStatus number_integer(const char *text, size_t length, int *value);

#endif
