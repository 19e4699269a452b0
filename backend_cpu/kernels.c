#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

/* Before any shared header: inlines everything into the loops of this file, those of path tracing and of the AOVs,
 * which start with the same kernels. */
#ifdef NDEBUG
#define PLATFORM_INLINE_ALL
#endif

#include "kernels.h"

#include "kernel_loop.h"

#include "kernels/aov.cl"
#include "kernels/pt.cl"

KERNEL_LIST_PATHS(KERNEL_LOOP)

#define KERNEL_ENTRY(name, n, ...) kernel_loop_##name,
static KernelLoop *const KERNEL_LOOPS[KERNEL_COUNT] = {KERNEL_LIST(KERNEL_ENTRY)};

#ifdef HAVE_WIDE_KERNELS
#define KERNEL_WIDE(name, n, ...) [KERNEL_##name] = kernel_wide_##name,
static KernelLoop *const WIDE_LOOPS[KERNEL_COUNT] = {KERNEL_LIST_CHAINS(KERNEL_WIDE)};

/* The instruction sets of WIDE_CFLAGS in configure.ac. */
static bool processor_wide(void)
{
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}
#endif

void kernel_run(unsigned kernel, void *const *buffers, const uint *items, uint count)
{
    assert(kernel < KERNEL_COUNT);
    KernelLoop *loop = KERNEL_LOOPS[kernel];
#ifdef HAVE_WIDE_KERNELS
    if (WIDE_LOOPS[kernel] && processor_wide())
        loop = WIDE_LOOPS[kernel];
#endif
    loop(buffers, items, count);
}
