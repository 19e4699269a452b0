/* A growable array of plain elements. */
#ifndef TWINLIGHT_BASE_ARRAY_H
#define TWINLIGHT_BASE_ARRAY_H

#include "base/error.h"

#include <stddef.h>

typedef struct Array {
    void *data;
    size_t count;
    size_t capacity;
    size_t element_size; /* bytes; set by array_init */
} Array;

void array_init(Array *array, size_t element_size);
void array_destroy(Array *array);

/* Appends `count` zeroed elements and returns the first of them; NULL with `error` filled when out of memory.
 * Invalidates pointers into the array. */
void *array_grow(Array *array, size_t count, Error *error);

/* Makes room for `count` elements in total; adds none. */
bool array_reserve(Array *array, size_t count, Error *error);

/* Element i as a T. */
#define ARRAY_AT(array, T, i) (((T *)(array)->data)[i])

#endif
