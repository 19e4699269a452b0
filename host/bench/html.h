/* Pieces of HTML pages that are well-formed XML, too. */
#ifndef TWINLIGHT_BENCH_HTML_H
#define TWINLIGHT_BENCH_HTML_H

#include <stddef.h>
#include <stdio.h>

/* Text between tags or in an attribute's quotes: & < > " are escaped, control characters become blanks. */
void html_text(FILE *stream, const char *text);

/* "data:image/png;base64,..." */
void html_png(FILE *stream, const unsigned char *bytes, size_t size);

/* A number of `digits` significant digits in Unicode: a true minus sign, small and large ones as 1.2 x 10^-4 with
 * raised digits, a dash for what is not finite. `size` >= 48. */
void html_number_text(char *text, size_t size, double value, int digits);

/* The same into a page. */
void html_number(FILE *stream, double value, int digits);

#endif
