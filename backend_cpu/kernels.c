/* Which loop runs for a kernel. A file of its own, so that a test can define kernel_run with kernels of its own instead
 * (tests/geometry/test_geometry_backend.c). */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "kernels.h"

#include "kernel_loop.h"

#define LOOP(name, n, ...) [KERNEL_##name] = kernel_loop_##name,
#define LOOP_PLAIN(name, n, ...) [KERNEL_##name] = kernel_plain_##name,
#define LOOP_WIDE(name, n, ...) [KERNEL_##name] = kernel_wide_##name,
#define LOOP_WIDE_PLAIN(name, n, ...) [KERNEL_##name] = kernel_wide_plain_##name,

/* Kernels compiled in one way. */
typedef struct KernelVariant {
    bool plain; /* for scenes that have no features but FEATURES_PLAIN */
    bool wide; /* for processors with the instruction sets of WIDE_CFLAGS in configure.ac */
    KernelLoop *loops[KERNEL_COUNT]; /* NULL: not compiled in this way */
} KernelVariant;

/* The best first. */
static const KernelVariant VARIANTS[] = {
#if defined HAVE_PLAIN_KERNELS && defined HAVE_WIDE_KERNELS
    {true, true, {KERNEL_LIST_CHAINS(LOOP_WIDE_PLAIN)}},
#endif
#ifdef HAVE_PLAIN_KERNELS
    {true,
     false,
     {KERNEL_LIST_PATHS(LOOP_PLAIN) KERNEL_LIST_BIDIRECTIONAL(LOOP_PLAIN) KERNEL_LIST_IBPT(LOOP_PLAIN)
          KERNEL_LIST_CHAINS(LOOP_PLAIN)}},
#endif
#ifdef HAVE_WIDE_KERNELS
    {false, true, {KERNEL_LIST_CHAINS(LOOP_WIDE)}},
#endif
    {false, false, {KERNEL_LIST(LOOP)}},
};

static bool processor_wide(void)
{
#ifdef HAVE_WIDE_KERNELS
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
#else
    return false;
#endif
}

void kernel_run(unsigned kernel, void *const *buffers, const uint *items, uint count)
{
    assert(kernel < KERNEL_COUNT);
    bool plain = (frame_features(buffers[BUFFER_FRAME]) & ~FEATURES_PLAIN) == 0u, wide = processor_wide();
    const KernelVariant *variant = VARIANTS;
    while (!variant->loops[kernel] || (variant->plain && !plain) || (variant->wide && !wide))
        ++variant;
    variant->loops[kernel](buffers, items, count);
}
