/* The bounding volume hierarchy for devices (layout: shared/geometry/bvh_traverse.h): four children per node, built
 * with Embree's builder, flattened into one buffer of words. */
#ifndef TWINLIGHT_BACKEND_BVH_H
#define TWINLIGHT_BACKEND_BVH_H

#include "backend/backend.h"

typedef struct Bvh {
    uint *words; /* BUFFER_BVH; aligned to 128 bytes */
    size_t word_count;
    uint max_depth; /* most nodes on a path from the root to a leaf, including the nodes above and inside an instance */
    uint stack; /* largest number of stack entries of a traversal, at most BVH_STACK */
    uint node_count;
    uint item_count; /* primitives and instances in leaves */
    double build_seconds;
} Bvh;

/* Builds with all processors. Fails when out of memory, if the buffer would exceed 2^32 words, or if the hierarchy is
 * too deep for the traversal's stack; *bvh is then empty. */
bool bvh_build(const BackendScene *scene, Bvh *bvh, Error *error);

/* The same for a traversal with a stack of `stack` entries. */
bool bvh_build_bounded(const BackendScene *scene, uint stack, Bvh *bvh, Error *error);

/* Safe on zeroed memory and twice. */
void bvh_destroy(Bvh *bvh);

#endif
