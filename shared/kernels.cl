/* All kernels, as one translation unit. */
#ifndef TWINLIGHT_KERNELS_CL
#define TWINLIGHT_KERNELS_CL

#include "kernels/aov.cl"
#include "kernels/bd_connect.cl"
#include "kernels/bd_walk.cl"
#include "kernels/caustic.cl"
#include "kernels/count.cl"
#include "kernels/film_add.cl"
#include "kernels/ibpt.cl"
#include "kernels/mlt.cl"
#include "kernels/opening.cl"
#include "kernels/photon.cl"
#include "kernels/pt.cl"
#include "kernels/trace.cl"

#endif
