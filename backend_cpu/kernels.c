/* Before any shared header: everything is inlined into the loops of this file, those of path tracing and what starts like
 * it. */
#ifdef NDEBUG
#define PLATFORM_INLINE_ALL
#endif

#include "kernels.h"

#include "kernel_loop.h"

#include "aov.cl"
#include "pt.cl"

KERNEL_LIST_PATHS(KERNEL_LOOP)

#define KERNEL_ENTRY(name, n, ...) kernel_loop_##name,
static KernelLoop *const KERNEL_LOOPS[KERNEL_COUNT] = {KERNEL_LIST(KERNEL_ENTRY)};

void kernel_run(unsigned kernel, void *const *buffers, const uint *items, uint count)
{
    assert(kernel < KERNEL_COUNT);
    KERNEL_LOOPS[kernel](buffers, items, count);
}
