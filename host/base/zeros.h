/* Large arrays of zeros. */
#ifndef TWINLIGHT_BASE_ZEROS_H
#define TWINLIGHT_BASE_ZEROS_H

#include <stddef.h>

/* Zeros that are written at once, by all threads, in large pages where the system has them, for arrays of which all
 * will be used; free() frees them. NULL when out of memory, or for no bytes. calloc's memory is one shared page until it
 * is written, and a page that was read before interrupts all threads when it is. */
void *zeros_alloc(size_t count, size_t size);

#endif
