#include "plain_kernels.h"

#include "kernels_mlt.c"
