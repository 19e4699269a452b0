/* Kernels that the CPU backend runs for tests and benches alone: it has rays of its own, and counts them. */
#define KERNEL_ANY_STRIDE
#include "kernel_loop.h"

#include "count.cl"
#include "film_add.cl"
#include "trace.cl"
#include "walk.cl"

KERNEL_LIST_OTHERS(KERNEL_LOOP)
