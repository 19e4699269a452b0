/* The kernels of path tracing and of the AOVs, which start with the same kernels. */
#include "kernel_loop.h"

#include "kernels/aov.cl"
#include "kernels/pt.cl"

KERNEL_LIST_PATHS(KERNEL_LOOP)
