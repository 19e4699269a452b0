/* The kernels of bidirectional paths. They evaluate BSDFs in so many places that the compiler would need a gigabyte and
 * minutes to inline everything, as kernels.c does; what it chooses itself costs less than a tenth of the speed. */
#include "kernel_loop.h"

#include "bd_connect.cl"
#include "bd_walk.cl"
#include "ibpt.cl"

KERNEL_LIST_BIDIRECTIONAL(KERNEL_LOOP)
