/* The kernels of shared/, compiled as C. */
#ifndef TWINLIGHT_KERNELS_H
#define TWINLIGHT_KERNELS_H

#include "math/platform.h"

/* Runs kernel `kernel` (KERNEL_* of layout/kernel_list.h) for items[0] ... items[count - 1], or, if `items` is NULL,
 * for items 0 ... count - 1. buffers: indexed by BufferId. */
void kernel_run(unsigned kernel, void *const *buffers, const uint *items, uint count);

#endif
