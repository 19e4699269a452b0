/* Kernels that the CPU backend runs for tests and benchmarks only: it has ray queries of its own, and counts rays
 * itself. */
#define KERNEL_ANY_STRIDE
#include "kernel_loop.h"

#include "kernels/count.cl"
#include "kernels/film_add.cl"
#include "kernels/trace.cl"

KERNEL_LIST_OTHERS(KERNEL_LOOP)
