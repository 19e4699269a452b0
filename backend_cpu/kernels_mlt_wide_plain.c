#define KERNEL_LOOP_NAME(name) kernel_wide_plain_##name
#include "plain_kernels.h"

#include "kernels_mlt.c"
