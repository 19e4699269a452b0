/* Bounding volume trees made by Embree's builder, before they are flattened. */
#ifndef TWINLIGHT_BACKEND_BVH_TREE_H
#define TWINLIGHT_BACKEND_BVH_TREE_H

#include "base/error.h"
#include "geometry/box.h"

#include <embree3/rtcore.h>

#define BVH_WIDTH 4
#define BVH_LEAF_ITEMS 4

/* What the tree is built over: `id` is a primitive or, if `instance` is 1, an instance. */
typedef struct BvhItem {
    uint instance;
    uint id;
} BvhItem;

/* An inner node, or a leaf when child_count is 0. */
typedef struct BvhTreeNode {
    uint child_count;
    uint item_count;
    struct BvhTreeNode *child[BVH_WIDTH];
    struct RTCBounds box[BVH_WIDTH]; /* boxes of the children */
    BvhItem item[BVH_LEAF_ITEMS];
} BvhTreeNode;

/* Input of the builder: `count` boxes, with the capacity given to bvh_boxes_create. */
typedef struct BvhBoxes {
    struct RTCBuildPrimitive *boxes;
    size_t count;
} BvhBoxes;

/* Allocates room for `capacity` boxes; fails when out of memory. */
bool bvh_boxes_create(BvhBoxes *boxes, size_t capacity, Error *error);
void bvh_boxes_add(BvhBoxes *boxes, Box box, BvhItem item);
void bvh_boxes_destroy(BvhBoxes *boxes);

/* Builds a tree of at most `max_depth` levels of inner nodes, close to the best by the surface area heuristic while
 * depth stays well below that limit. Memory belongs to `bvh`. Reorders the boxes. Returns NULL if Embree fails. */
BvhTreeNode *bvh_tree_build(RTCBVH bvh, BvhBoxes *boxes, uint max_depth);

/* Sizes of a tree. */
typedef struct BvhTreeSize {
    size_t nodes; /* inner */
    size_t items;
    uint depth; /* levels of inner nodes */
    uint stack; /* most siblings waiting on a traversal's stack at one time */
} BvhTreeSize;
BvhTreeSize bvh_tree_size(const BvhTreeNode *node);

#endif
