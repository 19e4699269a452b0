/* The kernels that find openings, in a translation unit of their own for the reason that kernels_bd.c gives. */
#include "kernel_loop.h"

#include "kernels/opening.cl"

KERNEL_LIST_OPENINGS(KERNEL_LOOP)
