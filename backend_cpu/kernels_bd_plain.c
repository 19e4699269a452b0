#include "plain_kernels.h"

#include "kernel_loop.h"

#include "kernels/bd_connect.cl"
#include "kernels/bd_walk.cl"
#include "kernels/ibpt.cl"

KERNEL_LIST_BIDIRECTIONAL(KERNEL_LOOP)
KERNEL_LIST_IBPT(KERNEL_LOOP)
