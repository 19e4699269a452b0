/* All kernels, as one translation unit. */
#include "pt.cl"
#include "walk.cl"
