/* Before any shared header: everything is inlined into the loops of this file. */
#ifdef NDEBUG
#define PLATFORM_INLINE_ALL
#endif

#include "kernels.h"

#include "backend.h"
#include "kernel_list.h"

#include "kernels.cl"

#include <assert.h>

#define ARGUMENTS_3(a, b, c) buffers[a], buffers[b], buffers[c]
#define ARGUMENTS_4(a, b, c, d) ARGUMENTS_3(a, b, c), buffers[d]
#define ARGUMENTS_5(a, b, c, d, e) ARGUMENTS_4(a, b, c, d), buffers[e]
#define ARGUMENTS_6(a, b, c, d, e, f) ARGUMENTS_5(a, b, c, d, e), buffers[f]
#define ARGUMENTS_7(a, b, c, d, e, f, g) ARGUMENTS_6(a, b, c, d, e, f), buffers[g]
#define ARGUMENTS_8(a, b, c, d, e, f, g, h) ARGUMENTS_7(a, b, c, d, e, f, g), buffers[h]
#define ARGUMENTS_9(a, b, c, d, e, f, g, h, i) ARGUMENTS_8(a, b, c, d, e, f, g, h), buffers[i]
#define ARGUMENTS_10(a, b, c, d, e, f, g, h, i, j) ARGUMENTS_9(a, b, c, d, e, f, g, h, i), buffers[j]

/* One loop a kernel, with the kernel and all it calls inlined into it, so that the scene's pointers are made once. */
#define KERNEL_LOOP(name, n, ...)                                                                                      \
    static void run_##name(void *const *buffers, const uint *items, uint count)                                        \
    {                                                                                                                  \
        for (uint i = 0; i < count; ++i) {                                                                             \
            platform_item = items ? items[i] : i;                                                                      \
            name(ARGUMENTS_##n(__VA_ARGS__));                                                                          \
        }                                                                                                              \
    }
KERNEL_LIST(KERNEL_LOOP)

typedef void (*KernelLoop)(void *const *buffers, const uint *items, uint count);

#define KERNEL_ENTRY(name, n, ...) run_##name,
static const KernelLoop KERNEL_LOOPS[KERNEL_COUNT] = {KERNEL_LIST(KERNEL_ENTRY)};

void kernel_run(unsigned kernel, void *const *buffers, const uint *items, uint count)
{
    assert(kernel < KERNEL_COUNT);
    KERNEL_LOOPS[kernel](buffers, items, count);
}
