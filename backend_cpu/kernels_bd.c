/* The kernels of bidirectional paths. They evaluate BSDFs in so many places that the compiler would need a gigabyte and
 * minutes to inline everything, as in kernels_pt_plain.c; options from configure make it inline more than it would by
 * itself. */
#include "kernel_loop.h"

#include "kernels/bd_connect.cl"
#include "kernels/bd_walk.cl"
#include "kernels/ibpt.cl"

KERNEL_LIST_BIDIRECTIONAL(KERNEL_LOOP)
KERNEL_LIST_IBPT(KERNEL_LOOP)
