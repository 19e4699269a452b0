/* The kernels of Markov chains, in a translation unit of their own for the reason that kernels_bd.c gives. */
#include "kernel_loop.h"

#include "kernels/mlt.cl"

KERNEL_LIST_CHAINS(KERNEL_LOOP)
