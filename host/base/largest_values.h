/* The largest of many values, found in one pass over them: a heap of those kept, the least of them first. */
#ifndef TWINLIGHT_BASE_LARGEST_VALUES_H
#define TWINLIGHT_BASE_LARGEST_VALUES_H

#include <stddef.h>

typedef struct LargestValues {
    double *heap; /* room for `wanted` values, the caller's */
    size_t wanted; /* at least 1 */
    size_t count; /* kept so far; 0 at first */
} LargestValues;

/* Keeps a value if it is one of the `wanted` largest so far. Not NaN. */
void largest_values_add(LargestValues *largest, double value);

/* The least value that is kept, which is the `wanted`-th largest once as many have been added. At least one must be
 * kept. */
static inline double largest_values_least(const LargestValues *largest)
{
    return largest->heap[0];
}

#endif
