/* How the items of a pass are divided among several that run parts of it: in proportion to measured speed. */
#ifndef TWINLIGHT_BACKEND_SHARES_H
#define TWINLIGHT_BACKEND_SHARES_H

#include "math/platform.h"

#include <stddef.h>
#include <stdint.h>

/* Shares are multiples of this many items, but for the last that is not empty, to keep batches and chunks full. */
#define SHARE_GRAIN 512u

/* Member i runs the items starts[i] ... starts[i + 1] - 1 of a pass of `items`; `starts` has room for count + 1.
 * speeds: items per second; 0: not measured yet, which counts as the mean of the others. */
void shares_make(const double *speeds, size_t count, uint items, uint *starts);

/* Brings a member's speed up to date after a pass in which it delivered all its items. */
void shares_learn(double *speed, uint64_t items, double seconds);

#endif
