/* How many items a thread carries through a list of steps at a time, and how far apart their fields are. */
#ifndef TWINLIGHT_CHUNK_H
#define TWINLIGHT_CHUNK_H

/* Large enough that the two clock readings and the hand-out of a chunk vanish, small enough that its state (about 280
 * bytes an item) stays in the second-level cache. On the Cornell box 128 to 1024 differ by no more than the machine's
 * noise. */
#ifndef CHUNK_ITEMS
#define CHUNK_ITEMS 512u
#endif

/* Fields are one cache line more than a chunk apart. Were they a power of two apart, as CHUNK_ITEMS is, all fields of
 * an item would fall into the same two sets of the first-level cache and evict one another. */
#define CHUNK_STRIDE (CHUNK_ITEMS + 16u)

#endif
