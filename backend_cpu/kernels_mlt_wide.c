/* The kernels of kernels_mlt.c for processors with AVX-512, whose 32 registers hold what other processors keep on the
 * stack. Products and sums are not contracted here either, so the bits are the same. */
#define KERNEL_LOOP_NAME(name) kernel_wide_##name
#include "kernel_loop.h"

#include "kernels/mlt.cl"

KERNEL_LIST_CHAINS(KERNEL_LOOP)
