/* Kernels of random walks that need ray queries and nothing else: the bits of hits can be compared across threads,
 * backends and devices without a light or material in play. A walk leaves each hit in a uniform direction, on either
 * side, and casts a shadow ray to its previous point. */
#ifndef TWINLIGHT_TESTS_SUPPORT_WALK_KERNELS_H
#define TWINLIGHT_TESTS_SUPPORT_WALK_KERNELS_H

#include "math/platform.h"

/* Words of BUFFER_PATHS. */
#define WALK_STEP 0u
#define WALK_HASH 1u /* of every hit so far */
#define WALK_POINT 2u /* of the last hit, 3 */
#define WALK_NG 5u /* 3; zero before the first hit */
#define WALK_WORDS 8u

/* Run a kernel, with the parameters of kernel_run (backend_cpu/kernels.h). */
void kernel_loop_walk_start(void *const *buffers, const uint *items, uint count);
void kernel_loop_walk_extend(void *const *buffers, const uint *items, uint count);
void kernel_loop_walk_splat(void *const *buffers, const uint *items, uint count);

#endif
