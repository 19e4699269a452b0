/* Building blocks of HTML pages that are also well-formed XML. */
#ifndef TWINLIGHT_BENCH_HTML_H
#define TWINLIGHT_BENCH_HTML_H

#include <stddef.h>
#include <stdio.h>

/* Writes text for use between tags or in a quoted attribute: escapes & < > " and replaces control characters by
 * blanks. */
void html_text(FILE *stream, const char *text);

/* Writes a PNG as "data:image/png;base64,...". */
void html_png(FILE *stream, const unsigned char *bytes, size_t size);

/* Formats a number with `digits` significant digits in Unicode: a true minus sign; very small and large values as 1.2 x
 * 10^-4 with superscript digits; a dash if not finite. `size` >= 48. */
void html_number_text(char *text, size_t size, double value, int digits);

/* Writes html_number_text. */
void html_number(FILE *stream, double value, int digits);

#endif
