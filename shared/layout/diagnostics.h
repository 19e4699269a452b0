/* Events in kernels that should not happen, counted rather than hidden (BUFFER_DIAGNOSTICS: one 32-bit counter each,
 * which a backend adds to 64-bit sums before it can overflow). */
#ifndef TWINLIGHT_LAYOUT_DIAGNOSTICS_H
#define TWINLIGHT_LAYOUT_DIAGNOSTICS_H

#include "math/platform.h"

/* X(constant, name in reports) */
#define DIAGNOSTIC_LIST(X)                                                                                             \
    X(DIAGNOSTIC_NOT_FINITE, "not_finite") /* contributions that were NaN or infinite and counted as zero */           \
    X(DIAGNOSTIC_ZERO_DIRECTION, "zero_direction") /* rays without direction, which were not traced */                 \
    X(DIAGNOSTIC_RAY_RANGE, "ray_range") /* rays that were not finite or out of range, whose paths were ended */       \
    X(DIAGNOSTIC_LOST_CHAIN, "lost_chain") /* chains whose first path contributes nothing when it is replayed */       \
    X(DIAGNOSTIC_CROSSINGS, "crossings") /* rays through more interfaces than they may cross, which were blocked */    \
    X(DIAGNOSTIC_REPLAY, "replay") /* chains of an earlier pass whose replayed path has another luminance */

#define DIAGNOSTIC_ENUMERATE(constant, name) constant,
enum { DIAGNOSTIC_LIST(DIAGNOSTIC_ENUMERATE) DIAGNOSTIC_COUNT };
#undef DIAGNOSTIC_ENUMERATE

/* Increments the counter `which`. */
SHARED_FUNCTION void diagnostic_count(__global uint *diagnostics, uint which)
{
    counter_increment(diagnostics + which);
}

#endif
