/* The hierarchy that a device walks (shared/geometry/bvh_traverse.h says how it is laid out): four children a node,
 * split by Embree's builder, flattened into one buffer of words. */
#ifndef TWINLIGHT_BACKEND_BVH_H
#define TWINLIGHT_BACKEND_BVH_H

#include "backend/backend.h"

typedef struct Bvh {
    uint *words; /* BUFFER_BVH; aligned to 128 bytes */
    size_t word_count;
    uint max_depth; /* nodes on the longest way from the root, through an instance when there is one */
    uint stack; /* entries that a traversal needs at most; BVH_STACK or fewer */
    uint node_count;
    uint item_count; /* primitives and instances in leaves */
    double build_seconds;
} Bvh;

/* Builds with all processors. False when memory is short, when the buffer would have more than 2^32 words, or when the
 * hierarchy is too deep for the traversal's stack; *bvh is then empty. */
bool bvh_build(const BackendScene *scene, Bvh *bvh, Error *error);

/* The same for a traversal whose stack holds `stack` entries. */
bool bvh_build_bounded(const BackendScene *scene, uint stack, Bvh *bvh, Error *error);

/* Safe on zeroed memory and twice. */
void bvh_destroy(Bvh *bvh);

#endif
