/* Which loop runs for a kernel. A file of its own, so that a test can define kernel_run with kernels of its own instead
 * (tests/geometry/test_geometry_backend.c). */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "kernels.h"

#include "kernel_loop.h"

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
