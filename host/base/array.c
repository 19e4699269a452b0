#include "base/array.h"

#include <assert.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void array_init(Array *array, size_t element_size)
{
    *array = (Array){.element_size = element_size};
}

void array_destroy(Array *array)
{
    free(array->data);
    *array = (Array){.element_size = array->element_size};
}

bool array_reserve(Array *array, size_t count, Error *error)
{
    assert(array->element_size > 0);
    if (count <= array->capacity)
        return true;
    if (count > SIZE_MAX / 2 / array->element_size)
        return error_memory(error, SIZE_MAX, "an array");
    void *data = realloc(array->data, count * array->element_size);
    if (!data)
        return error_memory(error, count * array->element_size, "an array");
    array->data = data;
    array->capacity = count;
    return true;
}

void *array_grow(Array *array, size_t count, Error *error)
{
    if (count > SIZE_MAX / 4 - array->count) {
        error_memory(error, SIZE_MAX, "an array");
        return NULL;
    }
    size_t needed = array->count + count;
    /* Allocates even for zero elements: NULL means failure. */
    if (needed > array->capacity || !array->data) {
        size_t larger = array->capacity + array->capacity / 2 + 1;
        if (!array_reserve(array, needed > larger ? needed : larger, error))
            return NULL;
    }
    assert(array->data);
    char *first = (char *)array->data + array->count * array->element_size;
    if (count > 0)
        memset(first, 0, count * array->element_size);
    array->count = needed;
    return first;
}
