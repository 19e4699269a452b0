#include "base/zeros.h"

#include "base/parallel.h"
#include "base/processors.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Bytes of a large page on x86-64 and most ARM systems. */
#define LARGE_PAGE ((size_t)2 << 20)

/* Writes the zeros of a large page. */
static void page_clear(void *zeros, size_t page)
{
    memset((char *)zeros + page * LARGE_PAGE, 0, LARGE_PAGE);
}

void *zeros_alloc(size_t count, size_t size)
{
    if (count == 0 || size == 0 || count > (SIZE_MAX - LARGE_PAGE) / size)
        return NULL;
    size_t bytes = count * size, whole = (bytes + LARGE_PAGE - 1) / LARGE_PAGE * LARGE_PAGE;
    if (bytes < LARGE_PAGE)
        return calloc(count, size);
    void *zeros = aligned_alloc(LARGE_PAGE, whole);
    if (!zeros)
        return NULL;
#ifdef MADV_HUGEPAGE
    (void)madvise(zeros, whole, MADV_HUGEPAGE); /* ordinary pages do as well */
#endif
    parallel_run(whole / LARGE_PAGE, processors_usable(), page_clear, zeros);
    return zeros;
}
