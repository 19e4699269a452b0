#define KERNEL_LOOP_NAME(name) kernel_wide_plain_##name
#include "plain_kernels.h"

#include "kernel_loop.h"

#include "kernels/mlt.cl"

KERNEL_LIST_CHAINS(KERNEL_LOOP)
