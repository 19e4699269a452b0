/* Sorting by numbers. */
#ifndef TWINLIGHT_BASE_KEY_SORT_H
#define TWINLIGHT_BASE_KEY_SORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct KeyedItem {
    uint64_t key;
    void *item;
} KeyedItem;

/* Sorts by ascending keys; items of equal keys stay in order. Returns false, and leaves the order as it is, if there is
 * no memory for a second array. */
bool key_sort(KeyedItem *items, size_t count);

#endif
