/* All kernels, as one translation unit. */
#ifndef TWINLIGHT_KERNELS_CL
#define TWINLIGHT_KERNELS_CL

#include "aov.cl"
#include "bd_connect.cl"
#include "bd_walk.cl"
#include "count.cl"
#include "film_add.cl"
#include "ibpt.cl"
#include "mlt.cl"
#include "pt.cl"
#include "trace.cl"
#include "walk.cl"

#endif
