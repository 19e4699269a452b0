/* The kernels of bidirectional paths. They evaluate BSDFs in so many places that the compiler would need a gigabyte and
 * minutes to inline everything, as kernels.c does; configure tells it to inline more than it would choose itself. */
#include "kernel_loop.h"

#include "kernels/bd_connect.cl"
#include "kernels/bd_walk.cl"
#include "kernels/ibpt.cl"

KERNEL_LIST_BIDIRECTIONAL(KERNEL_LOOP)
