/* Path tracing of most scenes: everything is inlined into the loops, which takes the compiler a minute and makes them 5
 * % faster. */
#ifdef NDEBUG
#define PLATFORM_INLINE_ALL
#endif
#include "plain_kernels.h"

#include "kernels_pt.c"
