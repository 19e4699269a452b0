/* The number of items that a thread takes through a list of steps at a time, and the stride of their fields. */
#ifndef TWINLIGHT_CHUNK_H
#define TWINLIGHT_CHUNK_H

/* Large enough to make the cost of two clock readings and of handing out a chunk negligible, small enough that its
 * state (about 280 bytes per item) stays in the second-level cache. On the Cornell box 128 to 1024 differ by no more
 * than the machine's noise. */
#ifndef CHUNK_ITEMS
#define CHUNK_ITEMS 512u
#endif

/* The stride exceeds a chunk by one cache line. Were it a power of two, as CHUNK_ITEMS is, all fields of an item would
 * fall into the same two sets of the first-level cache and evict one another. */
#define CHUNK_STRIDE (CHUNK_ITEMS + 16u)

#endif
