/* Path tracing of most scenes: everything is inlined into the loops, which takes the compiler a minute and makes them 5
 * % faster. */
#ifdef NDEBUG
#define PLATFORM_INLINE_ALL
#endif
#include "plain_kernels.h"

#include "kernel_loop.h"

#include "kernels/aov.cl"
#include "kernels/pt.cl"

KERNEL_LIST_PATHS(KERNEL_LOOP)
