#include "base/largest_values.h"

/* Puts a value at the end and moves it up. */
static void heap_rise(double *heap, size_t place, double value)
{
    for (size_t parent; place > 0 && heap[parent = (place - 1) / 2] > value; place = parent)
        heap[place] = heap[parent];
    heap[place] = value;
}

/* Replaces the first value by a larger one and moves it down. */
static void heap_sink(double *heap, size_t count, double value)
{
    size_t place = 0;
    for (size_t child; (child = 2 * place + 1) < count; place = child) {
        child += child + 1 < count && heap[child + 1] < heap[child];
        if (heap[child] >= value)
            break;
        heap[place] = heap[child];
    }
    heap[place] = value;
}

void largest_values_add(LargestValues *largest, double value)
{
    if (largest->count < largest->wanted)
        heap_rise(largest->heap, largest->count++, value);
    else if (value > largest->heap[0])
        heap_sink(largest->heap, largest->count, value);
}
