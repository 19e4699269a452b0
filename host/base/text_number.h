/* Numbers from text: exact, fast, and the same in every locale. */
#ifndef TWINLIGHT_BASE_TEXT_NUMBER_H
#define TWINLIGHT_BASE_TEXT_NUMBER_H

#include <stddef.h>

typedef enum NumberStatus {
    NUMBER_OK,
    NUMBER_MALFORMED, /* something else than [+-] digits [. digits] [e [+-] digits], "nan" and "inf" among it */
    NUMBER_OVERFLOW /* finite as written, but beyond the type's range */
} NumberStatus;

/* All of text[0 .. length) as a float, correctly rounded. */
NumberStatus number_float(const char *text, size_t length, float *value);

/* All of text[0 .. length) as a 32-bit decimal integer. */
NumberStatus number_integer(const char *text, size_t length, int *value);

#endif
