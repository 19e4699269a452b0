/* All kernels, as one translation unit. */
#ifndef TWINLIGHT_KERNELS_CL
#define TWINLIGHT_KERNELS_CL

#include "pt.cl"
#include "trace.cl"
#include "walk.cl"

#endif
