/* The kernels of photons and caustics, in a translation unit of their own for the reason that kernels_bd.c gives. */
#include "kernel_loop.h"

#include "kernels/caustic.cl"
#include "kernels/photon.cl"

KERNEL_LIST_CAUSTICS(KERNEL_LOOP)
