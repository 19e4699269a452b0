/* Output of `twinlight compare`. */
#ifndef TWINLIGHT_COMPARE_PRINT_H
#define TWINLIGHT_COMPARE_PRINT_H

#include "compare/display_error.h"
#include "compare/metrics.h"
#include "compare/z_test.h"

typedef struct Comparison {
    const char *image, *reference; /* paths */
    int width, height;
    Metrics metrics;
    DisplaySettings display;
    DisplayError display_error;
    bool tested; /* both renderings have half-images */
    ZTest test; /* valid if `tested` */
} Comparison;

/* Print to standard output. */
void comparison_print_text(const Comparison *comparison);
void comparison_print_json(const Comparison *comparison);

#endif
