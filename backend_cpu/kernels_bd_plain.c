#include "plain_kernels.h"

#include "kernels_bd.c"
